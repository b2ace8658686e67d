import * as THREE from 'three';
import type { FrameArrays } from '../protocol';
import { CLOTH, CLOTH_BACK, FAULT, SCALE } from './colours';

/** The cloth: red in front and sand behind, or coloured by the depth of its contacts. */
export class ClothView {
    readonly mesh: THREE.Group = new THREE.Group();
    #front: THREE.Mesh | undefined;
    #back: THREE.Mesh | undefined;
    #geometry = new THREE.BufferGeometry();
    #shown: FrameArrays | undefined;
    #byDepth = false;

    begin(faces: Uint32Array): void {
        this.#geometry.dispose();
        this.mesh.clear();
        this.#shown = undefined;
        this.#geometry = new THREE.BufferGeometry();
        this.#geometry.setIndex(new THREE.BufferAttribute(faces, 1));
        // Two sides, two materials: three.js gives one material one colour.
        this.#front = new THREE.Mesh(this.#geometry, fabric(CLOTH, THREE.FrontSide));
        this.#back = new THREE.Mesh(this.#geometry, fabric(CLOTH_BACK, THREE.BackSide));
        this.mesh.add(this.#front, this.#back);
        for (const side of [this.#front, this.#back]) {
            side.frustumCulled = false; // it moves: a sphere around it would be wrong a frame later
            side.visible = false;
        }
    }

    /** @returns the arrays shown until now, which the worker may fill again */
    show(arrays: FrameArrays): FrameArrays | undefined {
        const previous = this.#shown;
        this.#shown = arrays;
        if (!this.#geometry.attributes.position) {
            this.#geometry.setAttribute('position', dynamic(arrays.positions, 3));
            this.#geometry.setAttribute('normal', dynamic(arrays.normals, 3));
            this.#geometry.setAttribute('contactDepth', dynamic(arrays.depths, 1));
            for (const side of [this.#front, this.#back]) if (side) side.visible = true;
        } else {
            replace(this.#geometry, 'position', arrays.positions);
            replace(this.#geometry, 'normal', arrays.normals);
            if (this.#byDepth) replace(this.#geometry, 'contactDepth', arrays.depths);
        }
        return previous;
    }

    get positions(): Float32Array | undefined {
        return this.#shown?.positions;
    }
    get faces(): ArrayLike<number> {
        return this.#geometry.index?.array ?? [];
    }

    set byDepth(on: boolean) {
        this.#byDepth = on;
        for (const side of [this.#front, this.#back]) if (side) (side.material as FabricMaterial).userData.byDepth.value = on ? 1 : 0;
    }

    /** The particle under a ray, and where the ray meets the cloth. */
    pick(ray: THREE.Raycaster): { particle: number; point: THREE.Vector3; distance: number } | undefined {
        const { position } = this.#geometry.attributes;
        if (!this.#front || !position) return undefined;
        this.#geometry.computeBoundingSphere();
        const both = [this.#front, this.#back as THREE.Mesh].flatMap((side) => ray.intersectObject(side, false));
        const hit = both.sort((a, b) => a.distance - b.distance)[0];
        if (!hit?.face) return undefined;
        const corner = new THREE.Vector3();
        const away = (i: number) => corner.fromBufferAttribute(position as THREE.BufferAttribute, i).distanceTo(hit.point);
        const particle = [hit.face.a, hit.face.b, hit.face.c].sort((a, b) => away(a) - away(b))[0];
        return { particle, point: hit.point, distance: hit.distance };
    }
}

type FabricMaterial = THREE.MeshStandardMaterial;

/** Matte. Where colours are by depth, that of each particle goes through the palette's scale; inside it is the colour of faults. */
function fabric(colour: number, side: THREE.Side): FabricMaterial {
    const material = new THREE.MeshStandardMaterial({ color: colour, roughness: 0.95, side });
    const byDepth = { value: 0 };
    material.userData.byDepth = byDepth;
    const scale = { value: SCALE.map((hex) => new THREE.Color(hex)) };
    const inside = { value: new THREE.Color(FAULT.faces) };
    material.onBeforeCompile = (shader) => {
        Object.assign(shader.uniforms, { byDepth, scale, inside });
        shader.vertexShader = shader.vertexShader
            .replace('#include <common>', '#include <common>\nattribute float contactDepth;\nvarying float vContactDepth;')
            .replace('#include <begin_vertex>', '#include <begin_vertex>\nvContactDepth = contactDepth;');
        shader.fragmentShader = shader.fragmentShader
            .replace('#include <common>', '#include <common>\nuniform float byDepth;\nuniform vec3 scale[5];\nuniform vec3 inside;\nvarying float vContactDepth;')
            .replace(
                '#include <color_fragment>',
                `#include <color_fragment>
                float place = 4.0 * clamp(vContactDepth, 0.0, 1.0);
                vec3 shade = scale[0];
                for (int i = 0; i < 4; ++i) shade = mix(shade, scale[i + 1], clamp(place - float(i), 0.0, 1.0));
                if (vContactDepth > 1.0) shade = inside;
                diffuseColor.rgb = mix(diffuseColor.rgb, shade, byDepth);`,
            );
    };
    return material;
}

function dynamic(array: Float32Array, itemSize: number): THREE.BufferAttribute {
    return new THREE.BufferAttribute(array, itemSize).setUsage(THREE.DynamicDrawUsage);
}
function replace(geometry: THREE.BufferGeometry, name: string, array: Float32Array): void {
    const attribute = geometry.attributes[name] as THREE.BufferAttribute;
    attribute.array = array;
    attribute.needsUpdate = true;
}
