import type { ColliderState } from 'echinus';

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
