import type { ColliderState, Echinus, ExactMap, FlagBuffer, PointBuffer } from 'echinus';
import { intoFrameOf } from './collider_frame';

/** Counts the particles inside the model by the exact map, even for a cloth that uses the paper's map. */
export class Judge {
    readonly #map: ExactMap;
    readonly #points: PointBuffer;
    readonly #inside: FlagBuffer;

    constructor(echinus: Echinus, map: ExactMap, particleCount: number) {
        this.#map = map;
        this.#points = echinus.makePoints(particleCount);
        this.#inside = echinus.makeFlags(particleCount);
    }

    count(positions: Float32Array, collider: ColliderState): number {
        intoFrameOf(collider, positions, this.#points.view);
        const { view } = this.#map.containsBatch(this.#points, this.#inside);
        let count = 0;
        for (const flag of view) count += flag;
        return count;
    }

    delete(): void {
        this.#points.delete();
        this.#inside.delete();
    }
}
