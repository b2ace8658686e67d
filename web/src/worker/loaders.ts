import { type Object3D, LoadingManager } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { TDSLoader } from 'three/examples/jsm/loaders/TDSLoader.js';

/** The scene of a .glb, or of a self-contained .gltf. @throws Error with a sentence that names no file */
export async function readGltf(bytes: ArrayBuffer): Promise<Object3D> {
    const manager = new LoadingManager().setURLModifier(withinFile);
    const { scene, scenes } = await new GLTFLoader(manager).parseAsync(bytes, '').catch(explain);
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

/** Nothing is fetched for a file: images are not needed, and the shapes must be in it. */
function withinFile(address: string): string {
    if (/^(data|blob):/.test(address)) return address;
    if (/\.(png|jpe?g|webp|avif|ktx2|gif)$/i.test(address)) return ONE_PIXEL;
    throw new Elsewhere(`it refers to another file, ${address}: save the model as one .glb`);
}

/** The objects of a .3ds. @throws Error with a sentence that names no file */
export function read3ds(bytes: ArrayBuffer): Object3D {
    return new TDSLoader().parse(bytes, '');
}
