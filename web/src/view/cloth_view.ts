import * as THREE from 'three';
import type { ClothNews, FrameArrays } from '../protocol';
import { CLOTH, CLOTH_BACK, FLESH, WRONG } from './colours';
import { glow, replace } from './material';
import { Edge } from './edge';
import { FabricUniforms, fabric, weaveTexture } from './fabric';

/** How much of the distance that particles keep is cloth, in the fine look: two layers that touch do not meet. */
const THICK = 0.42;

/**
 * The cloth: red in front and sand behind, or coloured by the depth of its contacts; with the faces marked that intersect something, and the
 * particles inside. In the fine look it has two sides with a thickness, and a weave.
 */
export class ClothView {
    readonly group = new THREE.Group();
    readonly #uniforms = new FabricUniforms();
    /** How far either side is from the particles. */
    readonly #lift = { value: 0 };
    readonly #drop = { value: 0 };
    readonly #front = fabric(CLOTH, CLOTH_BACK, this.#uniforms, this.#lift);
    readonly #behind = backSide(this.#uniforms, this.#drop);
    readonly mesh = new THREE.Mesh(sheet(NOTHING, NO_CLOTH), this.#front);
    readonly #back = new THREE.Mesh(this.mesh.geometry, this.#behind);
    readonly #edge = new Edge();
    readonly #cut = new THREE.Mesh(facesOf(this.mesh.geometry), warning());
    readonly #threads = new THREE.LineSegments(threadsOf(this.mesh.geometry), new THREE.LineBasicMaterial({ color: CLOTH }));
    readonly #cutMarks = glow(this.#cut.geometry, 6, 0.25); // three on a face, and faces that are cut lie side by side
    readonly #wrong = glow(undefined, 9);
    #weave: THREE.Texture | undefined;
    #cloth: Partial<ClothNews> & Pick<ClothNews, 'faces'> = NO_CLOTH;
    #shown: FrameArrays | undefined;
    #fine = false;

    constructor() {
        this.group.add(this.mesh, this.#back, this.#edge.mesh, this.#cut, this.#cutMarks, this.#threads, this.#wrong);
        for (const part of this.#parts) part.frustumCulled = false; // it moves: its bounding sphere would be wrong a frame later
        for (const part of [this.mesh, this.#edge.mesh]) part.castShadow = part.receiveShadow = true;
        this.#back.receiveShadow = true;
        this.#wrong.visible = this.#edge.mesh.visible = false;
    }

    get #parts() {
        return [this.mesh, this.#back, this.#edge.mesh, this.#cut, this.#cutMarks, this.#threads, this.#wrong];
    }

    /**
     * Another cloth, which becomes visible with its first arrays. A face with the same corner twice at its end is a piece of thread.
     */
    begin(cloth: Partial<ClothNews> & Pick<ClothNews, 'faces'>): void {
        this.#cloth = cloth;
        this.#shown = undefined;
        this.#uniforms.tinted.value = cloth.tints ? 1 : 0;
        this.#uniforms.hem.value = cloth.hem ?? 0;
        this.#front.color.set(cloth.soft ? FLESH : CLOTH);
        this.#lay(sheet(NOTHING, NO_CLOTH));
        this.markWrong(new Uint32Array(0));
        this.#edge.begin(cloth.faces, cloth.tints);
        this.#refine();
    }

    /** @returns the previously shown arrays, which the worker may fill again */
    show(arrays: FrameArrays): FrameArrays | undefined {
        const previous = this.#shown;
        const { geometry } = this.mesh;
        this.#shown = arrays;
        if (!previous) this.#lay(sheet(arrays, this.#cloth));
        else {
            replace(geometry, 'position', arrays.positions);
            replace(geometry, 'normal', arrays.normals);
            if (this.#uniforms.byDepth.value > 0) replace(geometry, 'contactDepth', arrays.depths);
        }
        if (this.#edge.mesh.visible) this.#edge.follow(arrays, this.#lift.value);
        return previous;
    }

    /** @param cut  numbers of the faces that intersect the model or other faces */
    markCut(cut: Uint32Array): void {
        const { geometry } = this.#cut;
        const index = geometry.index!;
        cut.forEach((face, i) => (index.array as Uint32Array).set(this.faces.subarray(3 * face, 3 * face + 3), 3 * i));
        index.needsUpdate = true;
        geometry.setDrawRange(0, 3 * cut.length);
    }

    /** @param wrong  numbers of the particles that are inside the model */
    markWrong(wrong: Uint32Array): void {
        this.#wrong.visible = wrong.length > 0 && this.#shown !== undefined;
        if (!this.#wrong.visible) return;
        const places = new Float32Array(3 * wrong.length);
        wrong.forEach((particle, i) => places.set(this.#shown!.positions.subarray(3 * particle, 3 * particle + 3), 3 * i));
        this.#wrong.geometry.dispose();
        this.#wrong.geometry = new THREE.BufferGeometry().setAttribute('position', new THREE.BufferAttribute(places, 3));
    }

    #lay(geometry: THREE.BufferGeometry): void {
        for (const part of [this.mesh, this.#cut, this.#threads]) part.geometry.dispose();
        this.mesh.geometry = this.#back.geometry = geometry;
        this.#cut.geometry = this.#cutMarks.geometry = facesOf(geometry);
        this.#threads.geometry = threadsOf(geometry);
    }

    dispose(): void {
        this.group.removeFromParent();
        for (const part of this.#parts) {
            part.geometry.dispose();
            for (const material of [part.material].flat()) {
                if ('map' in material) material.map?.dispose();
                material.dispose();
            }
        }
        this.#weave?.dispose();
    }

    get positions(): Float32Array | undefined {
        return this.#shown?.positions;
    }
    get faces(): Uint32Array {
        return this.#cloth.faces;
    }

    set byDepth(on: boolean) {
        this.#uniforms.byDepth.value = on ? 1 : 0;
    }

    set fine(on: boolean) {
        if (on === this.#fine) return;
        this.#fine = on;
        this.#refine();
        if (this.#shown && this.#edge.mesh.visible) this.#edge.follow(this.#shown, this.#lift.value);
    }

    #refine(): void {
        const { soft, thickness = 0, weave } = this.#cloth;
        const isThick = this.#fine && !soft && thickness > 0;
        this.#lift.value = isThick ? THICK * thickness : 0;
        this.#drop.value = -this.#lift.value;
        this.#edge.mesh.visible = isThick;
        this.#back.visible = !soft;
        this.#front.side = soft ? THREE.DoubleSide : THREE.FrontSide;
        if (this.#fine && weave) this.#weave ??= weaveTexture();
        for (const material of [this.#front, this.#behind]) {
            material.bumpMap = this.#fine && weave ? this.#weave! : null;
            material.bumpScale = 1.6;
            material.defines = { ...(this.#fine && { FINE: '' }) };
            material.needsUpdate = true;
        }
    }

    /** The particle under a ray, and the ray's hit point on the cloth. */
    pick(ray: THREE.Raycaster): { particle: number; point: THREE.Vector3; distance: number } | undefined {
        const { geometry } = this.mesh;
        const { position } = geometry.attributes;
        if (position.count === 0) return undefined;
        geometry.computeBoundingSphere();
        const { side } = this.#front;
        this.#front.side = THREE.DoubleSide;
        const [hit] = ray.intersectObject(this.mesh, false);
        this.#front.side = side;
        if (!hit?.face) return undefined;
        const corner = new THREE.Vector3();
        const away = (i: number) => corner.fromBufferAttribute(position as THREE.BufferAttribute, i).distanceTo(hit.point);
        const particle = [hit.face.a, hit.face.b, hit.face.c].sort((a, b) => away(a) - away(b))[0];
        return { particle, point: hit.point, distance: hit.distance };
    }
}

/**
 * The side that faces away, drawn as the front of its own. It is drawn a little farther away than it is: beyond the edge of a fold, where both
 * sides meet, it would otherwise show through the front as a row of dark dots.
 */
function backSide(uniforms: FabricUniforms, drop: { value: number }): THREE.MeshLambertMaterial {
    const material = fabric(CLOTH_BACK, CLOTH_BACK, uniforms, drop);
    Object.assign(material, { side: THREE.BackSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    return material;
}

/** Over the cloth, from both sides, in a colour that no light changes. */
function warning(): THREE.MeshBasicMaterial {
    return new THREE.MeshBasicMaterial({ color: WRONG, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -8 });
}

/** No cloth yet, but with all attributes of one, since three.js compiles the program for them at once. */
const NO_CLOTH = { faces: new Uint32Array(0) };
const NOTHING: FrameArrays = { positions: new Float32Array(0), normals: new Float32Array(0), depths: new Float32Array(0) };

function sheet({ positions, normals, depths }: FrameArrays, { faces, weave, tints }: Partial<ClothNews> & Pick<ClothNews, 'faces'>): THREE.BufferGeometry {
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(faces, 1));
    geometry.setAttribute('position', dynamic(positions, 3));
    geometry.setAttribute('normal', dynamic(normals, 3));
    geometry.setAttribute('contactDepth', dynamic(depths, 1));
    const particles = positions.length / 3;
    geometry.setAttribute('uv', new THREE.BufferAttribute(fitting(weave, 2 * particles), 2));
    geometry.setAttribute('tint', new THREE.BufferAttribute(fitting(tints, particles), 1));
    return geometry;
}

const fitting = (array: Float32Array | undefined, length: number): Float32Array => (array?.length === length ? array : new Float32Array(length));

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
