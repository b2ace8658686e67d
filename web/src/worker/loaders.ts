import { type Object3D, LoadingManager } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { TDSLoader } from 'three/examples/jsm/loaders/TDSLoader.js';

/** The scene of a .glb, or of a .gltf with the files that it refers to. @throws Error with a sentence that names no file */
export async function readGltf(bytes: ArrayBuffer, companions: readonly File[]): Promise<Object3D> {
    const parts = new Map(companions.map((file) => [file.name, URL.createObjectURL(file)]));
    const manager = new LoadingManager().setURLModifier((address) => withinFiles(address, parts));
    const { scene, scenes } = await new GLTFLoader(manager).parseAsync(bytes, '').catch(explain);
    for (const part of parts.values()) URL.revokeObjectURL(part);
    const root = scene ?? scenes[0]; // the default scene is optional
    if (!root) throw new Error('it contains no scene');
    return root;
}

class Elsewhere extends Error {}

/** The loader's own words are for those who call it. */
function explain(error: unknown): never {
    if (error instanceof Elsewhere) throw error;
    if (/draco|meshopt/i.test(String(error))) throw new Error('its shapes are compressed, which this page cannot read: save it without compression');
    throw new Error('it is not a complete glTF 2.0 file');
}

const ONE_PIXEL = 'data:image/gif;base64,R0lGODlhAQABAAAAACH5BAEAAAAALAAAAAABAAEAAAICRAEAOw==';

/** Nothing is fetched from elsewhere: images are not needed, and the shapes must be in the files that were opened. @param parts  their addresses, by name */
function withinFiles(address: string, parts: ReadonlyMap<string, string>): string {
    if (/^(data|blob):/.test(address)) return address;
    if (/\.(png|jpe?g|webp|avif|ktx2|gif)$/i.test(address)) return ONE_PIXEL;
    const part = parts.get(decodeURIComponent(address).split('/').pop()!);
    if (part) return part;
    throw new Elsewhere(`it refers to another file, ${address}: open both together, or save the model as one .glb`);
}

/** The objects of a .3ds. @throws Error with a sentence that names no file */
export function read3ds(bytes: ArrayBuffer): Object3D {
    return new TDSLoader().parse(bytes, '');
}
