import type { ColliderState, Echinus, ExactMap, FlagBuffer, PointBuffer } from 'echinus';
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
        const { view } = this.#map.containsBatch(this.#points, this.#inside);
        const wrong: number[] = [];
        for (let i = view.indexOf(1); i >= 0; i = view.indexOf(1, i + 1)) wrong.push(i);
        return new Uint32Array(wrong);
    }

    delete(): void {
        this.#points.delete();
        this.#inside.delete();
    }
}
