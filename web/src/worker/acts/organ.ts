import type { Act } from './act';
import { ellipsoid, joined, lathe, surfaceOf } from './solids';

const BALL = 0.13;

/** A rod with a ball at its lower end, which is the frame's origin. */
export const probe = () =>
    lathe(
        [[0, -BALL], ...[-1.2, -0.8, -0.4, 0, 0.4, 0.8, 1.1].map((s) => [BALL * Math.cos(s), BALL * Math.sin(s)] as const),
            ...[0.2, 0.5, 0.8, 1.1, 1.4].map((z) => [0.045, z] as const), [0.06, 1.45], [0, 1.5]],
        24,
    );

/** Where the probe begins, and the organ's middle below it. */
const BELOW = -0.72;

/** Something like a liver: a large lobe, a small one, a hollow below. */
function organSurface() {
    const lobes = joined([ellipsoid([-0.2, 0, 0.02], [0.55, 0.42, 0.3]), ellipsoid([0.45, 0.05, -0.04], [0.42, 0.28, 0.17])], 0.22);
    return surfaceOf(lobes, [-0.95, -0.62, -0.5], [1.1, 0.6, 0.5], 0.09);
}

/** A soft organ, held at its lower side, and a probe that pushes it. */
export function organ(): Act {
    const size = (particles: number) => Math.min(0.3, Math.max(0.1, 0.15 * Math.cbrt(1500 / particles)));
    return {
        body: { centre: [0, 0, BELOW + 0.2], radius: 1.25, up: 'z' },
        floor: BELOW - 0.36,
        deepest: -0.72, // what is held below must not be squeezed
        lasts: Infinity,
        thickness: () => 0.018,
        scene: ({ particles }) => ({
            bodies: [{
                mesh: 'organ', element: size(particles), density: 1000, young_modulus: 1.4e4, poisson_ratio: 0.45, damping: 0.02,
                position: [0, 0, BELOW], pins: { from: [-9, -9, -9], to: [9, 9, -0.17] },
            }],
            material: { thickness: 0.018, air_drag: 2 },
        }),
        bodies(echinus) {
            const { vertices, faces } = organSurface();
            return [echinus.makeMesh(vertices, faces)];
        },
        // It goes down, wanders about and comes up again, until somebody takes it (worker/shake.ts).
        motion: (seconds) => ({
            linear: [0.35 * Math.cos(0.9 * seconds) * Math.min(1, seconds / 2), 0.22 * Math.cos(1.3 * seconds + 0.5) * Math.min(1, seconds / 2), -0.5 * Math.sin(1.6 * seconds)],
            angular: [0, 0, 0],
        }),
    };
}
