import type { ColliderState, Echinus, ExactMap, FlagBuffer, PointBuffer, Simulation } from 'echinus';
import { intoFrameOf } from './collider_frame';

/** Finds the particles inside the model by the exact map, even for a cloth that uses the paper's map. */
export class Judge {
    readonly #map: ExactMap;
    readonly #points: PointBuffer;
    readonly #inside: FlagBuffer;

    constructor(echinus: Echinus, map: ExactMap, particleCount: number) {
        this.#map = map;
        this.#points = echinus.makePoints(particleCount);
        this.#inside = echinus.makeFlags(particleCount);
    }

    /** The particles inside, ascending. */
    wrongOf(positions: Float32Array, collider: ColliderState): Uint32Array<ArrayBuffer> {
        intoFrameOf(collider, positions, this.#points.view);
        return marked(this.#map.containsBatch(this.#points, this.#inside));
    }
    /** The same of a model that has deformed, whose exact map the simulation has. */
    wrongNow(simulation: Simulation): Uint32Array<ArrayBuffer> {
        return marked(simulation.containsBatch(this.#inside));
    }

    delete(): void {
        this.#points.delete();
        this.#inside.delete();
    }
}

function marked({ view }: FlagBuffer): Uint32Array<ArrayBuffer> {
    const marks: number[] = [];
    for (let i = view.indexOf(1); i >= 0; i = view.indexOf(1, i + 1)) marks.push(i);
    return new Uint32Array(marks);
}
