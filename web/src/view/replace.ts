import type * as THREE from 'three';

/** Other numbers, as many as before, for a part of the vertices. */
export function replace(geometry: THREE.BufferGeometry, name: string, array: Float32Array): void {
    const attribute = geometry.attributes[name] as THREE.BufferAttribute;
    attribute.array = array;
    attribute.needsUpdate = true;
}
