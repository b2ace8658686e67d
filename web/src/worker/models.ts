import type { Echinus, Mesh } from 'echinus';
import type { Object3D } from 'three';
import type { Axis } from '../frames';
import type { Sample } from '../settings';
import type { Act } from './acts/act';
import { figure } from './acts/figure';
import { flag, pole } from './acts/flag';
import { organ, probe } from './acts/organ';
import { RING, ring } from './acts/ring';
import { layers } from './acts/sheets';
import type { SolidMesh } from './acts/solids';

/** A mesh, its up axis by the convention of its source, and what happens on it unless a cloth falls on it. */
export interface Model {
    name: string;
    mesh: Mesh;
    up: Axis;
    act?: Act;
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
        default:
            return (echinus) => {
                const act = ACTS[sample]?.();
                return { name: sample, mesh: makeSample(echinus, sample, act), up: 'z', ...(act && { act }) };
            };
    }
}

function makeSample(echinus: Echinus, sample: Exclude<Sample, 'horse'>, act: Act | undefined): Mesh {
    const made = ({ vertices, faces }: SolidMesh) => echinus.makeMesh(vertices, faces);
    switch (sample) {
        case 'torus':
            return echinus.makeTorus(1, 0.4, 60, 24);
        case 'sphere':
        case 'layers':
            return echinus.makeSphere(1, 60, 30);
        case 'ring':
            return echinus.makeTorus(RING.major, RING.minor, 72, 28);
        case 'figure':
            return made(act!.solid!);
        case 'flag':
            return made(pole());
        case 'organ':
            return made(probe());
    }
}

/**
 * OBJ, PLY, STL and OFF are read by Echinus; 3DS and glTF by three.js, which is loaded only then.
 * @param companions  files that a .gltf may refer to
 * @throws Error with a sentence that begins with the file's name; so does the returned function
 */
export async function prepareFile(name: string, bytes: ArrayBuffer, companions: readonly File[] = []): Promise<Reading> {
    const ending = name.toLowerCase().split('.').pop();
    if (ending === 'glb' && !beginsAs(bytes, 'glTF')) throw new Error(`${name}: it does not begin with "glTF", as a .glb file does`);
    switch (ending) {
        case '3ds':
            return welding(name, await described(name, async () => (await import('./loaders')).read3ds(bytes)));
        case 'glb':
        case 'gltf':
            return welding(name, await described(name, async () => (await import('./loaders')).readGltf(bytes, companions)));
        case 'obj':
        case 'ply':
            return (echinus) => ({ name, mesh: echinus.readMesh(bytes, name), up: 'y' });
        case 'stl':
        case 'off':
            return (echinus) => ({ name, mesh: echinus.readMesh(bytes, name), up: 'z' });
        default:
            throw new Error(`${name}: the page opens only .obj, .ply, .stl, .off, .3ds, .glb and .gltf files`);
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

const beginsAs = (bytes: ArrayBuffer, mark: string): boolean => new TextDecoder('latin1').decode(bytes.slice(0, mark.length)) === mark;

/** Of what a reader complains of: its first line, without the bytes of the file that it may quote. */
const legible = (sentence: string): string => sentence.split('\n')[0].replace(/[^\x20-\x7e]+/g, '?').slice(0, 160);

/** Third-party readers name no file. */
async function described<T>(name: string, read: () => Promise<T>): Promise<T> {
    try {
        return await read();
    } catch (error) {
        throw new Error(`${name}: cannot be read (${legible(error instanceof Error ? error.message : String(error))})`);
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

/** The acts of samples; on a sample without one a sheet falls. */
const ACTS: { readonly [S in Sample]?: () => Act } = { figure, flag, layers, organ, ring };
