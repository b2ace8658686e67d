import * as THREE from 'three';
import type { ModelNews, SurfaceNews } from '../protocol';
import { colouredFaces, largestOf, scaleTo } from './coloured_faces';

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
