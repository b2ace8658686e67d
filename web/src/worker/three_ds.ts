import type { Object3D } from 'three';
import { TDSLoader } from 'three/examples/jsm/loaders/TDSLoader.js';

/** The objects of a .3ds. @throws Error with a sentence that names no file */
export function read3ds(bytes: ArrayBuffer): Object3D {
    return new TDSLoader().parse(bytes, '');
}
