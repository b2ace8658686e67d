import type { Echinus, Mesh } from 'echinus';
import type { Object3D } from 'three';
import type { Axis } from '../axes';
import type { Sample } from '../settings';

/** A mesh, and its up axis by the convention of its source. */
export interface Model {
    name: string;
    mesh: Mesh;
    up: Axis;
}

/** The remaining work on a model once its bytes have arrived: the part that needs the module. */
export type Reading = (echinus: Echinus) => Model;

/** @param page  the address of the page; the samples lie beside it */
export async function fetchSample(sample: Sample, page: string): Promise<Reading> {
    switch (sample) {
        case 'horse': {
            const response = await fetch(new URL('./models/horse.3ds', page)).catch((error) => {
                throw new Error(`horse.3ds: the server does not answer (${error.message})`);
            });
            if (!response.ok) throw new Error(`horse.3ds: the server answers with status ${response.status}`);
            return prepareFile('horse.3ds', await response.arrayBuffer());
        }
        case 'torus':
            return (echinus) => ({ name: 'torus', mesh: echinus.makeTorus(1, 0.4, 60, 24), up: 'z' });
        case 'sphere':
            return (echinus) => ({ name: 'sphere', mesh: echinus.makeSphere(1, 60, 30), up: 'z' });
    }
}

/**
 * OBJ, PLY, STL and OFF are read by Echinus; 3DS and glTF by three.js, which is loaded only then.
 * @throws Error with a sentence that begins with the file's name; so does the returned function
 */
export async function prepareFile(name: string, bytes: ArrayBuffer): Promise<Reading> {
    const ending = name.toLowerCase().split('.').pop();
    switch (ending) {
        case '3ds':
            return welding(name, await described(name, async () => (await import('./three_ds')).read3ds(bytes)));
        case 'glb':
        case 'gltf':
            return welding(name, await described(name, async () => (await import('./gltf')).readGltf(bytes)));
        case 'obj':
        case 'ply':
            return (echinus) => ({ name, mesh: echinus.readMesh(bytes, name), up: 'y' });
        case 'stl':
        case 'off':
            return (echinus) => ({ name, mesh: echinus.readMesh(bytes, name), up: 'z' });
        default:
            throw new Error(`${name}: only models that end in .obj, .ply, .stl, .off, .3ds, .glb or .gltf can be opened`);
    }
}

const welding = (name: string, root: Object3D): Reading => (echinus) => ({ name, mesh: named(name, () => weldTriangles(echinus, root)), up: 'y' });

/** Adds the file's name to errors. */
export function named<T>(name: string, make: () => T): T {
    try {
        return make();
    } catch (error) {
        if (error instanceof Error) error.message = `${name}: ${error.message}`; // a new one would lack its code
        throw error;
    }
}

/** Third-party readers name no file. */
async function described<T>(name: string, read: () => Promise<T>): Promise<T> {
    try {
        return await read();
    } catch (error) {
        throw new Error(`${name}: cannot be read (${error instanceof Error ? error.message : String(error)})`);
    }
}

/** All triangles under an object, in its frame, as one mesh. */
function weldTriangles(echinus: Echinus, root: Object3D): Mesh {
    const vertices: number[] = [];
    const faces: number[] = [];
    root.updateMatrixWorld(true);
    root.traverse((object) => {
        if (!isMesh(object)) return;
        const { position } = object.geometry.attributes;
        if (!position) return;
        const first = vertices.length / 3;
        const point = object.position.clone();
        for (let i = 0; i < position.count; ++i) {
            point.fromBufferAttribute(position, i).applyMatrix4(object.matrixWorld);
            vertices.push(point.x, point.y, point.z);
        }
        const { index } = object.geometry;
        const cornerCount = index ? index.count : position.count;
        for (let i = 0; i + 2 < cornerCount; i += 3)
            for (let k = 0; k < 3; ++k) faces.push(first + (index ? index.getX(i + k) : i + k));
    });
    if (faces.length === 0) throw new Error('it contains no triangle');
    const loose = echinus.makeMesh(vertices, faces);
    try {
        return loose.weld();
    } finally {
        loose.delete();
    }
}

const isMesh = (object: Object3D): object is import('three').Mesh => 'isMesh' in object;
