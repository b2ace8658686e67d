import type { Triple } from '../../protocol';
import { columnsOf } from '../cloth_scene';
import { type Act, garmentOf, square } from './act';
import { type Bone, type Turn, Skin, turned } from './skin';
import { type SolidMesh, ellipsoid, joined, limb, surfaceOf } from './solids';

/** z up, the soles at 0, facing y. In this pose arms and legs stand away, so that no two parts of the skin are joined that should not be. */
const HIP = [0.085, 0, 0.93] as const, KNEE = [0.115, 0.012, 0.5] as const, ANKLE = [0.13, -0.01, 0.1] as const, TOE = [0.15, 0.1, 0.026] as const;
const SHOULDER = [0.15, 0, 1.41] as const, ELBOW = [0.395, 0.01, 1.31] as const, WRIST = [0.62, 0.04, 1.26] as const, HAND = [0.71, 0.055, 1.25] as const;

const onSide = ([x, y, z]: readonly [number, number, number], side: number): Triple => [side * x, y, z];

function body() {
    const parts = [-1, 1].flatMap((side) => {
        const [hip, knee, ankle, toe, shoulder, elbow, wrist, hand] = [HIP, KNEE, ANKLE, TOE, SHOULDER, ELBOW, WRIST, HAND].map((place) => onSide(place, side));
        return [
            limb([0.07 * side, 0, 1.39], shoulder, 0.055, 0.05), limb(shoulder, elbow, 0.048, 0.039), limb(elbow, wrist, 0.038, 0.03), limb(wrist, hand, 0.03, 0.025),
            limb(hip, knee, 0.084, 0.053), limb(knee, ankle, 0.053, 0.033), limb(ankle, toe, 0.035, 0.026),
        ];
    });
    return joined(
        [
            ellipsoid([0, 0, 1.3], [0.145, 0.095, 0.17]),
            limb([0, 0, 1.1], [0, 0, 1.25], 0.095, 0.1),
            ellipsoid([0, -0.005, 0.98], [0.135, 0.11, 0.12]),
            limb([0, 0, 1.4], [0, 0.005, 1.53], 0.05, 0.042),
            ellipsoid([0, 0.015, 1.64], [0.075, 0.09, 0.11]),
            ellipsoid([0, -0.085, 1.7], [0.045, 0.045, 0.045]), // the knot of her hair
            ...parts,
        ],
        0.045,
    );
}

const ofSide = (side: number, first: number): Bone[] => [
    { parent: 2, joint: onSide(SHOULDER, side), end: onSide(ELBOW, side), radius: 0.045 },
    { parent: first, joint: onSide(ELBOW, side), end: onSide(HAND, side), radius: 0.033 },
    { parent: 0, joint: onSide(HIP, side), end: onSide(KNEE, side), radius: 0.07 },
    { parent: first + 2, joint: onSide(KNEE, side), end: onSide(ANKLE, side), radius: 0.043 },
    { parent: first + 3, joint: onSide(ANKLE, side), end: onSide(TOE, side), radius: 0.03 },
];

const BONES: readonly Bone[] = [
    { joint: [0, 0, 0.93], end: [0, 0, 1.1], radius: 0.12 },
    { parent: 0, joint: [0, 0, 1.17], end: [0, 0, 1.27], radius: 0.1 },
    { parent: 1, joint: [0, 0, 1.28], end: [0, 0, 1.42], radius: 0.11 },
    { parent: 2, joint: [0, 0, 1.49], end: [0, 0.015, 1.72], radius: 0.08 },
    ...ofSide(-1, 4),
    ...ofSide(1, 9),
];

/** From one leg to the other and back, seconds. */
const BEAT = 2.4;
/** She begins gently. */
const BEGIN = 1.6;

/** 0 to 1, and smooth where it begins. */
const swell = (part: number): number => Math.min(1, Math.max(0, part)) ** 2 * (3 - 2 * Math.min(1, Math.max(0, part)));

/** She lifts one knee after the other, sways against it, and lets her arms rise and sink. At 0 she stands as she was made. */
function turnsAt(seconds: number): Turn[] {
    const begun = swell(seconds / BEGIN);
    const beat = begun * Math.sin((2 * Math.PI * seconds) / BEAT), slow = begun * Math.sin((Math.PI * seconds) / BEAT);
    const limbs = (side: number): Turn[] => {
        const lift = swell(-side * beat), arm = begun * (0.55 + 0.5 * side * slow);
        return [
            turned(0.25 * lift, -side * arm, 0), turned(0, 0, side * 0.5 * arm),
            turned(0.85 * lift, -side * 0.1 * lift - 0.07 * beat, 0), turned(-1.3 * lift, 0, 0), turned(-0.5 * lift, 0, 0),
        ];
    };
    const trunk = [turned(0, 0.07 * beat, 0.1 * beat), turned(0, 0.1 * beat, -0.15 * beat), turned(-0.05 * begun, 0.08 * beat, -0.1 * beat), turned(0, -0.12 * beat, 0)];
    return [...trunk, ...limbs(-1), ...limbs(1)];
}

/** A dancer, and how she moves. */
export class Dancer {
    readonly mesh: SolidMesh = surfaceOf(body(), [-0.8, -0.25, -0.06], [0.8, 0.34, 1.86], 0.038);
    readonly #skin = new Skin(this.mesh, BONES);

    /** [3 vertices] of the mesh at a time. */
    at(seconds: number): Float32Array<ArrayBuffer> {
        return this.#skin.posed(turnsAt(seconds));
    }
}

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
            cloth: { mesh: 'skirt', attachments: Array.from({ length: 2 * cut(particles).around }, (_, i) => i) },
            material: { air_drag: 1 },
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
