import type { ColliderState } from 'echinus';
import type { Triple } from './protocol';

export const AXES = ['x', 'y', 'z'] as const;
export type Axis = (typeof AXES)[number];

export const UNIT: Record<Axis, Triple> = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

/** The next two axes, cyclically. */
export function following(axis: Axis): [Axis, Axis] {
    const k = AXES.indexOf(axis);
    return [AXES[(k + 1) % 3], AXES[(k + 2) % 3]];
}

/** The vertex that lies furthest along a direction, of [3 n] coordinates. */
export function furthestAlong([x, y, z]: Triple, vertices: ArrayLike<number>): Triple {
    let furthest = 0, most = -Infinity;
    for (let i = 0; i < vertices.length; i += 3) {
        const along = x * vertices[i] + y * vertices[i + 1] + z * vertices[i + 2];
        if (along > most) [furthest, most] = [i, along];
    }
    return [vertices[furthest], vertices[furthest + 1], vertices[furthest + 2]];
}

/** World points in the frame of a collider of scale 1: subtracts its position, then rotates inversely. @param local  out; may be `world` */
export function intoFrameOf({ position, rotation: [w, x, y, z] }: Pick<ColliderState, 'position' | 'rotation'>, world: Float32Array, local: Float32Array): void {
    for (let i = 0; i < world.length; i += 3) {
        const px = world[i] - position[0], py = world[i + 1] - position[1], pz = world[i + 2] - position[2];
        // p + 2 w (p x v) + 2 v x (v x p): Rodrigues' formula for the conjugate of (w, v).
        const tx = 2 * (py * z - pz * y), ty = 2 * (pz * x - px * z), tz = 2 * (px * y - py * x);
        local[i] = px + w * tx + (ty * z - tz * y);
        local[i + 1] = py + w * ty + (tz * x - tx * z);
        local[i + 2] = pz + w * tz + (tx * y - ty * x);
    }
}

/** The inverse, in place. */
export function outOfFrameOf({ position, rotation: [w, x, y, z] }: Pick<ColliderState, 'position' | 'rotation'>, points: Float32Array): void {
    intoFrameOf({ position: [0, 0, 0], rotation: [w, -x, -y, -z] }, points, points);
    for (let i = 0; i < points.length; ++i) points[i] += position[i % 3];
}
