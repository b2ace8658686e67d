import * as THREE from 'three';
import type { FrameArrays } from '../protocol';
import { CLOTH, TINTS } from './colours';

/** The narrow strip between the two sides of a cloth, where it ends. */
export class Edge {
    readonly mesh = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshLambertMaterial({ vertexColors: true, flatShading: true, side: THREE.DoubleSide }));
    /** Two particles for each piece of the border, and the third of the face beside it. */
    #pieces = new Uint32Array(0);
    #faces: Uint32Array | undefined;
    #tints: Float32Array | undefined;

    /** The border is found when it is needed first. */
    begin(faces: Uint32Array, tints: Float32Array | undefined): void {
        this.#faces = faces;
        this.#tints = tints;
        this.mesh.geometry.dispose();
        this.mesh.geometry = new THREE.BufferGeometry();
    }

    #find(faces: Uint32Array): void {
        this.#faces = undefined;
        this.#pieces = borderOf(faces);
        const count = this.#pieces.length / 2;
        const corners: number[] = [];
        for (let piece = 0; piece < count; ++piece) corners.push(...[0, 1, 3, 0, 3, 2].map((k) => 4 * piece + k));
        this.mesh.geometry
            .setIndex(corners)
            .setAttribute('position', new THREE.BufferAttribute(new Float32Array(12 * count), 3).setUsage(THREE.DynamicDrawUsage))
            .setAttribute('color', new THREE.BufferAttribute(this.#colours(), 3));
    }

    /** In the colour of the piece of cloth that it ends, as fabric.ts mixes it. */
    #colours(): Float32Array<ArrayBuffer> {
        const colours = new Float32Array(6 * this.#pieces.length);
        const [first, middle, last] = TINTS.map((hex) => new THREE.Color(hex)), usual = new THREE.Color(CLOTH);
        this.#pieces.forEach((particle, i) => {
            const tint = this.#tints?.[particle];
            const colour = tint === undefined ? usual : tint < 0.5 ? first.clone().lerp(middle, 2 * tint) : middle.clone().lerp(last, 2 * tint - 1);
            for (const end of [0, 3]) colour.toArray(colours, 6 * i + end);
        });
        return colours;
    }

    /** @param half  of the thickness */
    follow({ positions, normals }: FrameArrays, half: number): void {
        if (this.#faces) this.#find(this.#faces);
        const attribute = this.mesh.geometry.attributes.position as THREE.BufferAttribute;
        const array = attribute.array as Float32Array;
        this.#pieces.forEach((particle, i) => {
            for (let k = 0; k < 3; ++k) {
                array[6 * i + k] = positions[3 * particle + k] + half * normals[3 * particle + k];
                array[6 * i + 3 + k] = positions[3 * particle + k] - half * normals[3 * particle + k];
            }
        });
        attribute.needsUpdate = true;
    }
}

/** Pairs of particles: the edges of one face alone. */
function borderOf(faces: Uint32Array): Uint32Array<ArrayBuffer> {
    const once = new Map<number, [number, number]>();
    for (let i = 0; i < faces.length; i += 3)
        for (let k = 0; k < 3; ++k) {
            const [a, b] = [faces[i + k], faces[i + ((k + 1) % 3)]];
            if (a === b) continue;
            const key = Math.min(a, b) * 2 ** 26 + Math.max(a, b);
            if (!once.delete(key)) once.set(key, [a, b]);
        }
    return new Uint32Array([...once.values()].flat());
}
