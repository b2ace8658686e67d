/**
 * Normals at the vertices of any surface: of the faces around each, by their areas. 0 where there are none.
 * @param positions  [3 vertices]
 * @param faces      [3 faces]
 * @param normals    [3 vertices] out
 */
export function surfaceNormals(positions: Float32Array, faces: Uint32Array, normals: Float32Array): void {
    normals.fill(0);
    for (let face = 0; face < faces.length; face += 3) {
        const a = 3 * faces[face], b = 3 * faces[face + 1], c = 3 * faces[face + 2];
        const ux = positions[b] - positions[a], vx = positions[c] - positions[a];
        const uy = positions[b + 1] - positions[a + 1], vy = positions[c + 1] - positions[a + 1];
        const uz = positions[b + 2] - positions[a + 2], vz = positions[c + 2] - positions[a + 2];
        const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
        for (const corner of [a, b, c]) {
            normals[corner] += x;
            normals[corner + 1] += y;
            normals[corner + 2] += z;
        }
    }
    for (let i = 0; i < normals.length; i += 3) {
        const scale = 1 / (Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1);
        normals[i] *= scale;
        normals[i + 1] *= scale;
        normals[i + 2] *= scale;
    }
}
