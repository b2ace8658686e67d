import * as THREE from 'three';
import type { ColliderState } from 'echinus';
import type { Shape } from '../normals';
import type { ModelNews, ModelShape, Triple } from '../protocol';
import { CLAY, FAULT, TOOL } from './colours';
import { matte, replace } from './material';

/** How much of a line shows that something hides: faults on the far side must be seen, but not as if they lay on the cloth. */
const HIDDEN = 0.18;

/** The model as clay, with the faults of its mesh drawn on it. Moves with the collider. */
export class ModelView {
    readonly group = new THREE.Group();
    /** The model alone, without the faults. Added to the group once it has normals, since three.js compiles the program for its attributes at once. */
    readonly clay = new THREE.Mesh(new THREE.BufferGeometry(), clay());

    #first: { vertices: Float32Array; normals: Float32Array } = { vertices: new Float32Array(0), normals: new Float32Array(0) };
    #shape: ModelShape | undefined;

    show({ vertices, faces, shape, normals, faults }: Pick<ModelNews, 'vertices' | 'faces' | 'shape' | 'normals' | 'faults'>): void {
        this.group.remove(this.clay);
        clear(this.group);
        this.clay.geometry.dispose();
        this.clay.geometry = shape ? creased(shape) : smooth(vertices, faces, normals);
        this.#first = { vertices, normals: this.clay.geometry.attributes.normal.array as Float32Array };
        this.#shape = undefined;
        this.clay.castShadow = this.clay.receiveShadow = true;
        this.group.add(this.clay);

        for (const kind of ['borderEdges', 'nonmanifoldEdges', 'misorientedEdges'] as const)
            if (faults[kind].length > 0) this.group.add(...edges(vertices, faults[kind], FAULT[kind]));
        const wrong = [...faults.duplicateFaces, ...faults.degenerateFaces];
        if (wrong.length > 0) this.group.add(marked(vertices, faces, wrong));
    }

    /** As it has deformed; undefined: as it was shown first. Of a model without creases. */
    deform(shape: ModelShape | undefined): void {
        if (shape === this.#shape) return;
        this.#shape = shape;
        const { vertices, normals } = shape ?? this.#first;
        const { geometry } = this.clay;
        replace(geometry, 'position', vertices);
        replace(geometry, 'normal', normals);
        geometry.boundingSphere = null; // three.js finds another
    }

    follow({ position, rotation: [w, x, y, z] }: Pick<ColliderState, 'position' | 'rotation'>): void {
        this.group.position.set(...position);
        this.group.quaternion.set(x, y, z, w);
        this.group.updateMatrixWorld();
    }

    /** The vertices at the model's present pose. */
    verticesNow(vertices: Float32Array): Float32Array {
        const moved = new THREE.BufferAttribute(vertices.slice(), 3);
        return moved.applyMatrix4(this.group.matrixWorld).array as Float32Array;
    }
}

/** A little further away than it is, so that lines on it are drawn whole. */
function clay(): THREE.MeshLambertMaterial {
    return Object.assign(matte(CLAY), { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4 });
}

function creased({ positions, normals }: Shape): THREE.BufferGeometry {
    return new THREE.BufferGeometry().setAttribute('position', new THREE.BufferAttribute(positions, 3)).setAttribute('normal', new THREE.BufferAttribute(normals, 3));
}

function smooth(vertices: Float32Array, faces: Uint32Array, normals: Float32Array | undefined): THREE.BufferGeometry {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(vertices, 3));
    geometry.setIndex(new THREE.BufferAttribute(faces, 1));
    if (normals) geometry.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
    else geometry.computeVertexNormals();
    return geometry;
}

/** Where they are in sight, and faintly where something hides them. */
function edges(vertices: Float32Array, pairs: Uint32Array, colour: number): THREE.LineSegments[] {
    return [1, HIDDEN].map((opacity) => {
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute('position', new THREE.BufferAttribute(vertices, 3));
        geometry.setIndex(new THREE.BufferAttribute(pairs, 1));
        const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: colour, depthTest: opacity === 1, depthWrite: false, opacity, transparent: true }));
        lines.renderOrder = 2;
        return lines;
    });
}

function marked(vertices: Float32Array, faces: Uint32Array, wrong: number[]): THREE.Mesh {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(vertices, 3));
    geometry.setIndex(wrong.flatMap((face) => [...faces.subarray(3 * face, 3 * face + 3)]));
    return new THREE.Mesh(
        geometry,
        new THREE.MeshBasicMaterial({ color: FAULT.faces, side: THREE.DoubleSide, transparent: true, opacity: 0.6, polygonOffset: true, polygonOffsetFactor: -2 }),
    );
}

/** Removes everything from a group and frees its graphics memory. */
export function clear(group: THREE.Object3D): void {
    for (const child of [...group.children]) {
        group.remove(child);
        if (child instanceof THREE.Mesh || child instanceof THREE.LineSegments || child instanceof THREE.Points) {
            child.geometry.dispose();
            const { material } = child;
            if ('map' in material) material.map?.dispose();
            material.dispose();
        }
    }
}

/** The ball that the visitor leads. */
export class BallView {
    readonly mesh = new THREE.Mesh(new THREE.SphereGeometry(1, 40, 24), matte(TOOL));

    constructor() {
        this.mesh.visible = false;
        this.mesh.castShadow = this.mesh.receiveShadow = true;
    }

    show(ball: { radius: number; position?: Triple } | undefined): void {
        this.mesh.visible = ball?.position !== undefined;
        if (!ball?.position) return;
        this.mesh.position.set(...ball.position);
        this.mesh.scale.setScalar(ball.radius);
    }
}
