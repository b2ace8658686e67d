import * as THREE from 'three';
import type { FrameArrays } from '../protocol';
import { CLOTH, CLOTH_BACK, FAULT, SCALE } from './colours';
import { matte } from './matte';

/** The cloth: red in front and sand behind, or coloured by the depth of its contacts; with the faces marked that intersect something. */
export class ClothView {
    /** Uniform: 1 for colours by depth, otherwise 0. */
    readonly #depthShare = { value: 0 };
    readonly mesh = new THREE.Mesh(sheet(NOTHING, NO_FACES), fabric(this.#depthShare));
    readonly #cut = new THREE.Mesh(facesOf(this.mesh.geometry), warning());
    readonly #threads = new THREE.LineSegments(threadsOf(this.mesh.geometry), new THREE.LineBasicMaterial({ color: CLOTH }));
    #faces: Uint32Array = NO_FACES;
    #shown: FrameArrays | undefined;

    constructor() {
        this.mesh.add(this.#cut, this.#threads);
        for (const mesh of [this.mesh, this.#cut, this.#threads]) mesh.frustumCulled = false; // it moves: its bounding sphere would be wrong a frame later
    }

    /**
     * Another cloth, which becomes visible with its first arrays.
     * @param faces  a face with the same corner twice at its end is a piece of thread
     */
    begin(faces: Uint32Array): void {
        this.#faces = faces;
        this.#shown = undefined;
        this.#lay(sheet(NOTHING, NO_FACES));
    }

    /** @returns the previously shown arrays, which the worker may fill again */
    show(arrays: FrameArrays): FrameArrays | undefined {
        const previous = this.#shown;
        const { geometry } = this.mesh;
        this.#shown = arrays;
        if (!previous) this.#lay(sheet(arrays, this.#faces));
        else {
            replace(geometry, 'position', arrays.positions);
            replace(geometry, 'normal', arrays.normals);
            if (this.#depthShare.value > 0) replace(geometry, 'contactDepth', arrays.depths);
        }
        return previous;
    }

    /** @param cut  numbers of the faces that intersect the model or other faces */
    markCut(cut: Uint32Array): void {
        const { geometry } = this.#cut;
        const index = geometry.index!;
        cut.forEach((face, i) => (index.array as Uint32Array).set(this.#faces.subarray(3 * face, 3 * face + 3), 3 * i));
        index.needsUpdate = true;
        geometry.setDrawRange(0, 3 * cut.length);
    }

    #lay(geometry: THREE.BufferGeometry): void {
        for (const mesh of [this.mesh, this.#cut, this.#threads]) mesh.geometry.dispose();
        this.mesh.geometry = geometry;
        this.#cut.geometry = facesOf(geometry);
        this.#threads.geometry = threadsOf(geometry);
    }

    get positions(): Float32Array | undefined {
        return this.#shown?.positions;
    }
    get faces(): Uint32Array {
        return this.#faces;
    }

    set byDepth(on: boolean) {
        this.#depthShare.value = on ? 1 : 0;
    }

    /** The particle under a ray, and the ray's hit point on the cloth. */
    pick(ray: THREE.Raycaster): { particle: number; point: THREE.Vector3; distance: number } | undefined {
        const { geometry } = this.mesh;
        const { position } = geometry.attributes;
        geometry.computeBoundingSphere();
        const [hit] = ray.intersectObject(this.mesh, false);
        if (!hit?.face) return undefined;
        const corner = new THREE.Vector3();
        const away = (i: number) => corner.fromBufferAttribute(position as THREE.BufferAttribute, i).distanceTo(hit.point);
        const particle = [hit.face.a, hit.face.b, hit.face.c].sort((a, b) => away(a) - away(b))[0];
        return { particle, point: hit.point, distance: hit.distance };
    }
}

/** For colours by depth, each particle's depth is mapped to the palette's scale; a particle inside gets the colour of faults. */
function fabric(byDepth: { value: number }): THREE.MeshLambertMaterial {
    const material = matte(CLOTH, CLOTH_BACK);
    const scale = { value: SCALE.map((hex) => new THREE.Color(hex)) };
    const inside = { value: new THREE.Color(FAULT.faces) };
    const { onBeforeCompile } = material;
    material.onBeforeCompile = (shader, renderer) => {
        onBeforeCompile(shader, renderer);
        Object.assign(shader.uniforms, { byDepth, scale, inside });
        shader.vertexShader = shader.vertexShader
            .replace('#include <common>', '#include <common>\nattribute float contactDepth;\nvarying float vContactDepth;')
            .replace('#include <begin_vertex>', '#include <begin_vertex>\nvContactDepth = contactDepth;');
        shader.fragmentShader = shader.fragmentShader
            .replace('#include <common>', '#include <common>\nuniform float byDepth;\nuniform vec3 scale[5];\nuniform vec3 inside;\nvarying float vContactDepth;')
            .replace(
                '#include <alphamap_fragment>', // after matte() has chosen the side's colour
                `float place = 4.0 * clamp(vContactDepth, 0.0, 1.0);
                vec3 shade = scale[0];
                for (int i = 0; i < 4; ++i) shade = mix(shade, scale[i + 1], clamp(place - float(i), 0.0, 1.0));
                if (vContactDepth > 1.0) shade = inside;
                diffuseColor.rgb = mix(diffuseColor.rgb, shade, byDepth);
                #include <alphamap_fragment>`,
            );
    };
    return material;
}

/** Over the cloth, from both sides, in a colour that no light changes. */
function warning(): THREE.MeshBasicMaterial {
    return new THREE.MeshBasicMaterial({ color: FAULT.faces, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: -2 });
}

/** No cloth yet, but with all attributes of one, since three.js compiles the program for them at once. */
const NO_FACES = new Uint32Array(0);
const NOTHING: FrameArrays = { positions: new Float32Array(0), normals: new Float32Array(0), depths: new Float32Array(0) };

function sheet({ positions, normals, depths }: FrameArrays, faces: Uint32Array): THREE.BufferGeometry {
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(faces, 1));
    geometry.setAttribute('position', dynamic(positions, 3));
    geometry.setAttribute('normal', dynamic(normals, 3));
    geometry.setAttribute('contactDepth', dynamic(depths, 1));
    return geometry;
}

/** The faces of another geometry that are threads, as lines. The two share the array of positions, so they are disposed of together. */
function threadsOf({ attributes, index }: THREE.BufferGeometry): THREE.BufferGeometry {
    const corners = index!.array;
    const ends: number[] = [];
    for (let i = 0; i < corners.length; i += 3) if (corners[i + 1] === corners[i + 2]) ends.push(corners[i], corners[i + 1]);
    return new THREE.BufferGeometry().setIndex(new THREE.BufferAttribute(new Uint32Array(ends), 1)).setAttribute('position', attributes.position);
}

/** Faces of another geometry, none yet. They share the array of positions, too. */
function facesOf({ attributes, index }: THREE.BufferGeometry): THREE.BufferGeometry {
    const corners = new THREE.BufferAttribute(new Uint32Array(index!.count), 1).setUsage(THREE.DynamicDrawUsage);
    const faces = new THREE.BufferGeometry().setIndex(corners).setAttribute('position', attributes.position);
    faces.setDrawRange(0, 0);
    return faces;
}

function dynamic(array: Float32Array, itemSize: number): THREE.BufferAttribute {
    return new THREE.BufferAttribute(array, itemSize).setUsage(THREE.DynamicDrawUsage);
}
function replace(geometry: THREE.BufferGeometry, name: string, array: Float32Array): void {
    const attribute = geometry.attributes[name] as THREE.BufferAttribute;
    attribute.array = array;
    attribute.needsUpdate = true;
}
