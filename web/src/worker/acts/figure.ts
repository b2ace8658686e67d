import type { Triple } from '../../protocol';
import { columnsOf } from '../cloth_scene';
import type { Act } from './act';
import { ellipsoid, joined, limb, surfaceOf } from './solids';
import { square } from './sheet_mesh';

/** A dancer on one leg, arms above the head. z up, the foot at 0. */
export function dancer() {
    const arm = (side: number) => {
        const [shoulder, elbow, wrist, hand] = [[0.14 * side, 0, 1.4], [0.3 * side, 0.02, 1.58], [0.2 * side, 0.06, 1.8], [0.07 * side, 0.07, 1.88]] as Triple[];
        return [limb(shoulder, elbow, 0.047, 0.037), limb(elbow, wrist, 0.036, 0.027), limb(wrist, hand, 0.026, 0.02)];
    };
    const body = joined(
        [
            ellipsoid([0, 0, 1.3], [0.15, 0.095, 0.17]),
            limb([0, 0, 1.1], [0, 0, 1.25], 0.095, 0.1),
            ellipsoid([0, 0, 0.99], [0.135, 0.11, 0.12]),
            limb([0, 0, 1.4], [0, 0.005, 1.53], 0.05, 0.042),
            ellipsoid([0, 0.015, 1.64], [0.075, 0.09, 0.11]),
            ellipsoid([0, -0.085, 1.7], [0.045, 0.045, 0.045]), // the knot of her hair
            ...arm(1),
            ...arm(-1),
            limb([0.06, 0, 0.95], [0.035, 0.01, 0.5], 0.085, 0.052), // the leg she stands on
            limb([0.035, 0.01, 0.5], [0.02, -0.01, 0.12], 0.052, 0.03),
            limb([0.02, -0.01, 0.12], [0.02, 0.03, 0.015], 0.032, 0.018),
            limb([-0.06, 0.01, 0.95], [-0.34, 0.2, 0.83], 0.085, 0.055), // the one she has drawn up
            limb([-0.34, 0.2, 0.83], [-0.06, 0.09, 0.6], 0.052, 0.031),
            limb([-0.06, 0.09, 0.6], [0.03, 0.075, 0.49], 0.03, 0.018),
        ],
        0.05,
    );
    return surfaceOf(body, [-0.5, -0.25, -0.06], [0.45, 0.34, 1.96], 0.026);
}

/** The skirt is cut as a ring around the waist, and starts nearly flat. */
const WAIST = 0.16, LEVEL = 1.1, LENGTH = 0.58, DROP = 0.28;

/** Rings, and particles around each. */
function cut(particles: number): { rings: number; around: number } {
    const rings = Math.max(4, Math.round(columnsOf(particles) * 0.55));
    return { rings, around: Math.max(12, Math.round(particles / rings)) };
}

/** She begins to turn, turns fast, and stops again. Radians per second. */
const turning = (seconds: number): number => 7.5 * Math.sin(Math.PI * Math.min(1, (seconds % 9) / 7)) ** 2;

/** A skirt on a dancer who turns on one leg. */
export function figure(): Act {
    return {
        body: { centre: [0, 0, 0.93], radius: 1, up: 'z' },
        floor: 0,
        lasts: Infinity,
        thickness: ({ thickness, particles }) => (0.55 * thickness * LENGTH) / (cut(particles).rings - 1),
        scene: ({ particles }) => ({
            cloth: { mesh: 'skirt', bending: 'sticks', attachments: Array.from({ length: 2 * cut(particles).around }, (_, i) => i) },
            material: { drag: 0.004 },
        }),
        cloth(echinus, { particles }) {
            const { rings, around } = cut(particles);
            const vertices: number[] = [], faces: number[] = [], weave: number[] = [];
            for (let ring = 0; ring < rings; ++ring)
                for (let i = 0; i < around; ++i) {
                    const angle = (2 * Math.PI * i) / around, along = (ring / (rings - 1)) * LENGTH;
                    const radius = WAIST + along * Math.sqrt(1 - DROP * DROP);
                    vertices.push(radius * Math.cos(angle), radius * Math.sin(angle), LEVEL - DROP * along);
                    weave.push(WAIST * 2 * Math.PI * (i / around), along);
                    if (ring + 1 < rings) {
                        const right = i + 1 < around ? 1 : 1 - around;
                        faces.push(...square(ring * around + i, around, right)); // red outside
                    }
                }
            return { mesh: echinus.makeMesh(vertices, faces), weave: new Float32Array(weave) };
        },
        motion: (seconds) => ({ linear: [0, 0, 0], angular: [0, 0, turning(seconds)] }),
    };
}
