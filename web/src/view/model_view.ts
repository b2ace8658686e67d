import * as THREE from 'three';
import { toCreasedNormals } from 'three/examples/jsm/utils/BufferGeometryUtils.js';
import type { ColliderState } from 'echinus';
import type { ModelNews } from '../protocol';
import { CLAY, FAULT } from './colours';
import { matte } from './matte';

/** Beyond this many faces, creases are left out: they take seconds, and small faces look smooth anyway. */
const CREASED_FACES = 60_000;

/** The model as clay, with the faults of its mesh drawn on it. Moves with the collider. */
export class ModelView {
    readonly group = new THREE.Group();
    /** The model alone, without the faults. Added to the group once it has normals, since three.js compiles the program for its attributes at once. */
    readonly clay = new THREE.Mesh(new THREE.BufferGeometry(), matte(CLAY));

    show({ vertices, faces, faults }: Pick<ModelNews, 'vertices' | 'faces' | 'faults'>): void {
        this.group.remove(this.clay);
        clear(this.group);
        this.clay.geometry.dispose();
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute('position', new THREE.BufferAttribute(vertices, 3));
        geometry.setIndex(new THREE.BufferAttribute(faces, 1));
        this.clay.geometry = faces.length / 3 <= CREASED_FACES ? toCreasedNormals(geometry, Math.PI / 4.5) : smooth(geometry);
        this.group.add(this.clay);

        for (const kind of ['borderEdges', 'nonmanifoldEdges', 'misorientedEdges'] as const)
            if (faults[kind].length > 0) this.group.add(edges(vertices, faults[kind], FAULT[kind]));
        const wrong = [...faults.duplicateFaces, ...faults.degenerateFaces];
        if (wrong.length > 0) this.group.add(marked(vertices, faces, wrong));
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

function smooth(geometry: THREE.BufferGeometry): THREE.BufferGeometry {
    geometry.computeVertexNormals();
    return geometry;
}

/** Drawn through everything in front: faults on the far side must be visible as well. */
function edges(vertices: Float32Array, pairs: Uint32Array, colour: number): THREE.LineSegments {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(vertices, 3));
    geometry.setIndex(new THREE.BufferAttribute(pairs, 1));
    const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: colour, depthTest: false, transparent: true }));
    lines.renderOrder = 2;
    return lines;
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
