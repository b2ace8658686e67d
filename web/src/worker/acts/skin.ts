import type { Triple } from '../../protocol';
import type { SolidMesh } from './solids';

/** A bone of a figure in the pose in which its mesh was made. It turns about its joint, and with it all that hangs on it. */
export interface Bone {
    /** An earlier bone. */
    parent?: number;
    joint: Triple;
    end: Triple;
    /** About that of the flesh around it. */
    radius: number;
}

/** Row by row. */
export type Turn = readonly [number, number, number, number, number, number, number, number, number];

/** How far, in units of length, a bone's influence reaches into that of its neighbours, and how often it is evened out over the skin. */
const REACH = 0.02, ROUNDS = 10;
/** Less than this is none. */
const LEAST = 1e-3;

/** The skin of a figure: each vertex goes with the bones around it (linear blend skinning). */
export class Skin {
    readonly #vertices: Float32Array;
    readonly #bones: readonly Bone[];
    /** Of vertex v: the bones[first[v]] to bones[first[v + 1] - 1], with their shares. */
    readonly #first: Uint32Array;
    readonly #boneOf: Uint8Array;
    readonly #share: Float32Array;

    constructor({ vertices, faces }: SolidMesh, bones: readonly Bone[]) {
        this.#vertices = vertices;
        this.#bones = bones;
        const count = vertices.length / 3;
        const shares = evened(sharesBySpace(vertices, bones), faces, bones.length);
        this.#first = new Uint32Array(count + 1);
        const boneOf: number[] = [], share: number[] = [];
        for (let v = 0; v < count; ++v) {
            const kept = bones.map((_, b) => shares[v * bones.length + b]).map((part) => (part < LEAST ? 0 : part));
            const sum = kept.reduce((a, b) => a + b);
            kept.forEach((part, b) => {
                if (part === 0) return;
                boneOf.push(b);
                share.push(part / sum);
            });
            this.#first[v + 1] = boneOf.length;
        }
        this.#boneOf = Uint8Array.from(boneOf);
        this.#share = Float32Array.from(share);
    }

    /** @param turns  of each bone against the one that it hangs on, in the axes of the mesh @returns [3 vertices] */
    posed(turns: readonly Turn[]): Float32Array<ArrayBuffer> {
        const moves = movesOf(this.#bones, turns);
        const posed = new Float32Array(this.#vertices.length);
        for (let v = 0, at = 0; at < posed.length; ++v, at += 3) {
            const x = this.#vertices[at], y = this.#vertices[at + 1], z = this.#vertices[at + 2];
            for (let i = this.#first[v]; i < this.#first[v + 1]; ++i) {
                const share = this.#share[i], m = 12 * this.#boneOf[i];
                posed[at] += share * (moves[m] * x + moves[m + 1] * y + moves[m + 2] * z + moves[m + 3]);
                posed[at + 1] += share * (moves[m + 4] * x + moves[m + 5] * y + moves[m + 6] * z + moves[m + 7]);
                posed[at + 2] += share * (moves[m + 8] * x + moves[m + 9] * y + moves[m + 10] * z + moves[m + 11]);
            }
        }
        return posed;
    }
}

/** By the distance from the bones: of the nearest one and those that meet it. [vertices][bones] */
function sharesBySpace(vertices: Float32Array, bones: readonly Bone[]): Float32Array {
    const shares = new Float32Array((vertices.length / 3) * bones.length);
    for (let v = 0; 3 * v < vertices.length; ++v) {
        const gaps = bones.map((bone) => distance(vertices.subarray(3 * v, 3 * v + 3), bone) - bone.radius);
        const nearest = gaps.indexOf(Math.min(...gaps));
        const parts = bones.map(({ parent }, b) => (b === nearest || parent === nearest || bones[nearest].parent === b ? Math.exp(-Math.max(gaps[b], -REACH) / REACH) : 0));
        const sum = parts.reduce((a, b) => a + b);
        parts.forEach((part, b) => (shares[v * bones.length + b] = part / sum));
    }
    return shares;
}

/** Half of each, and half of the mean of its neighbours. */
function evened(shares: Float32Array, faces: Uint32Array, boneCount: number): Float32Array {
    for (let round = 0; round < ROUNDS; ++round) {
        const sums = new Float32Array(shares.length), counts = new Float32Array(shares.length / boneCount);
        faces.forEach((vertex, corner) => {
            const next = faces[corner % 3 === 2 ? corner - 2 : corner + 1];
            for (const [to, from] of [[vertex, next], [next, vertex]]) {
                ++counts[to];
                for (let b = 0; b < boneCount; ++b) sums[to * boneCount + b] += shares[from * boneCount + b];
            }
        });
        shares = shares.map((part, i) => 0.5 * part + (0.5 * sums[i]) / counts[Math.floor(i / boneCount)]);
    }
    return shares;
}

function distance(point: ArrayLike<number>, { joint, end }: Bone): number {
    const way = end.map((part, k) => part - joint[k]);
    const square = way.reduce((sum, part) => sum + part * part, 0);
    const along = way.reduce((sum, part, k) => sum + part * (point[k] - joint[k]), 0);
    const share = Math.min(1, Math.max(0, along / square));
    return Math.hypot(...way.map((part, k) => point[k] - joint[k] - share * part));
}

/** [bones] rows of three numbers and a shift: where each bone takes a point of the mesh. */
function movesOf(bones: readonly Bone[], turns: readonly Turn[]): Float64Array {
    const moves = new Float64Array(12 * bones.length);
    bones.forEach(({ parent, joint }, b) => {
        const before = parent === undefined ? [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0] : moves.subarray(12 * parent, 12 * parent + 12);
        const turn = turns[b];
        for (let row = 0; row < 3; ++row) {
            const [x, y, z, rest] = before.slice(4 * row, 4 * row + 4);
            const turned = [0, 1, 2].map((k) => x * turn[k] + y * turn[3 + k] + z * turn[6 + k]);
            // The joint itself goes where the bone before takes it.
            const stays = x * joint[0] + y * joint[1] + z * joint[2] + rest;
            moves.set([...turned, stays - turned[0] * joint[0] - turned[1] * joint[1] - turned[2] * joint[2]], 12 * b + 4 * row);
        }
    });
    return moves;
}

/** Radians about each axis: first about x, then y, then z. */
export function turned(x: number, y: number, z: number): Turn {
    const [a, b, c, d, e, f] = [Math.cos(x), Math.sin(x), Math.cos(y), Math.sin(y), Math.cos(z), Math.sin(z)];
    return [c * e, b * d * e - a * f, a * d * e + b * f, c * f, b * d * f + a * e, a * d * f - b * e, -d, b * c, a * c];
}
