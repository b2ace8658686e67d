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
