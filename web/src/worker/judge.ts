import { type ColliderState, type Echinus, type ExactMap, type FlagBuffer, type PointBuffer, type Simulation, ContactBuffer } from 'echinus';
import { intoFrameOf } from '../frames';

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

/**
 * How deep each particle is in the layer of contact, which reaches from the model's surface to twice the thickness, as
 * far as the collision searches for contacts. By the cloth's own map, at the end of a step. 0 and less: no contact;
 * 0.5: at the thickness, where the collision puts it; 1: on the surface; more: inside.
 * @param thickness  the distance that particles keep from the model
 * @param depths     [particles] out
 */
export function measureDepths(simulation: Simulation, thickness: number, contacts: ContactBuffer, depths: Float32Array): void {
    const layer = 2 * thickness;
    simulation.contactsBatch(layer, contacts);
    const { floats } = contacts;
    for (let i = 0; i < depths.length; ++i) {
        const depth = floats[ContactBuffer.STRIDE * i + ContactBuffer.DEPTH]; // of a contact outside: minus its
                                                                              // distance; 0: no contact
        depths[i] = depth === 0 ? 0 : 1 + depth / layer;
    }
}
