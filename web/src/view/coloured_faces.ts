import * as THREE from 'three';
import type { ModelNews, SurfaceNews } from '../protocol';
import { SCALE } from './colours';

/** Separate faces, so that each has its own colour. @param positions  [9 faces] of their corners */
export function colouredFaces(positions: Float32Array, values: Uint32Array, colourOf: (value: number) => THREE.Color): THREE.BufferGeometry {
    const colours = new Float32Array(positions.length);
    values.forEach((value, face) => {
        const { r, g, b } = colourOf(value);
        for (let corner = 0; corner < 3; ++corner) colours.set([r, g, b], 9 * face + 3 * corner);
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3));
    geometry.computeVertexNormals();
    return geometry;
}

/** The palette's scale from 0 to the largest value. */
export function scaleTo(largest: number): (value: number) => THREE.Color {
    const stops = SCALE.map((hex) => new THREE.Color(hex));
    return (value) => {
        const place = ((stops.length - 1) * Math.min(value, largest)) / largest;
        const stop = Math.min(stops.length - 2, Math.floor(place));
        return stops[stop].clone().lerp(stops[stop + 1], place - stop);
    };
}

/** The end of the scale. */
export function largestOf(values: Uint32Array): number {
    return values.reduce((a, b) => Math.max(a, b), 1);
}

/** The cells of an exact map, projected onto the bounding sphere: the more faces they list, the darker. */
export function cellBall({ corners, faceCounts }: NonNullable<SurfaceNews['cells']>, { centre, radius }: ModelNews): THREE.BufferGeometry {
    const positions = new Float32Array(corners.length);
    for (let cell = 0; cell < faceCounts.length; ++cell) {
        const [a, b, c] = [0, 1, 2].map((k) => new THREE.Vector3().fromArray(corners, 9 * cell + 3 * k));
        const outwards = a.dot(b.clone().cross(c)) > 0;
        (outwards ? [a, b, c] : [a, c, b]).forEach((corner, k) =>
            corner.multiplyScalar(radius).add(new THREE.Vector3(...centre)).toArray(positions, 9 * cell + 3 * k),
        );
    }
    return colouredFaces(positions, faceCounts, scaleTo(largestOf(faceCounts)));
}
