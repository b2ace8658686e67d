import { columnsOf } from '../cloth_scene';
import { type Act, garmentOf } from './act';
import { Dancer } from './dancer';
import { square } from './sheet_mesh';

/** The skirt is cut as a ring around the waist, and starts nearly flat. */
const WAIST = 0.13, LEVEL = 1.1, LENGTH = 0.58, DROP = 0.28;

/** Rings, and particles around each. */
function cut(particles: number): { rings: number; around: number } {
    const rings = Math.max(4, Math.round(columnsOf(particles) * 0.55));
    return { rings, around: Math.max(12, Math.round(particles / rings)) };
}

/** She begins to turn, turns fast, and stops again. Radians per second. */
const turning = (seconds: number): number => 7.5 * Math.sin(Math.PI * Math.min(1, (seconds % 9) / 7)) ** 2;

/** A skirt on a dancer who steps and turns. */
export function figure(): Act {
    const dancer = new Dancer();
    return {
        solid: dancer.mesh,
        shape: (seconds) => dancer.at(seconds),
        body: { centre: [0, 0, 0.93], radius: 1, up: 'z' },
        floor: 0,
        lasts: Infinity,
        thickness: ({ thickness, particles }) => (0.55 * thickness * LENGTH) / (cut(particles).rings - 1),
        scene: ({ particles }) => ({
            cloth: { mesh: 'skirt', bending: 'sticks', attachments: Array.from({ length: 2 * cut(particles).around }, (_, i) => i) },
            material: { drag: 0.008 },
            time_step: 1 / 120, // each step builds a map
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
            return garmentOf(echinus, { vertices, faces, weave });
        },
        motion: (seconds) => ({ linear: [0, 0, 0], angular: [0, 0, turning(seconds)] }),
    };
}
