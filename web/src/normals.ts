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

/** Faces that meet at a sharper angle than this keep an edge between them. */
const CREASE = Math.cos(Math.PI / 4.5);

/** A surface whose faces have corners of their own, each with a normal: smooth, but for creases. */
export interface Shape {
    /** [9 faces] */
    positions: Float32Array<ArrayBuffer>;
    /** [9 faces] */
    normals: Float32Array<ArrayBuffer>;
}

/**
 * The normal of a corner is that of the faces around its vertex, by their areas, as far as they look the same way as its own face.
 * @param vertices  [3 vertices] @param faces  [3 faces]
 */
export function creasedNormals(vertices: Float32Array, faces: Uint32Array): Shape {
    const across = faceVectors(vertices, faces);
    const { first, corners } = cornersByVertex(faces, vertices.length / 3);
    const positions = new Float32Array(3 * faces.length), normals = new Float32Array(3 * faces.length);
    for (let corner = 0; corner < faces.length; ++corner) {
        const vertex = faces[corner], own = 3 * Math.floor(corner / 3);
        const ownLength = Math.hypot(across[own], across[own + 1], across[own + 2]);
        let x = 0, y = 0, z = 0;
        for (let i = first[vertex]; i < first[vertex + 1]; ++i) {
            const other = 3 * Math.floor(corners[i] / 3);
            const [ox, oy, oz] = [across[other], across[other + 1], across[other + 2]];
            const cosine = across[own] * ox + across[own + 1] * oy + across[own + 2] * oz;
            if (cosine < CREASE * ownLength * Math.sqrt(ox * ox + oy * oy + oz * oz)) continue;
            x += ox;
            y += oy;
            z += oz;
        }
        const scale = 1 / (Math.hypot(x, y, z) || 1);
        normals.set([scale * x, scale * y, scale * z], 3 * corner);
        for (let k = 0; k < 3; ++k) positions[3 * corner + k] = vertices[3 * vertex + k];
    }
    return { positions, normals };
}

/** [3 faces] normals of twice the area's length. */
function faceVectors(vertices: Float32Array, faces: Uint32Array): Float32Array {
    const across = new Float32Array(faces.length);
    for (let face = 0; face < faces.length; face += 3) {
        const a = 3 * faces[face], b = 3 * faces[face + 1], c = 3 * faces[face + 2];
        const ux = vertices[b] - vertices[a], uy = vertices[b + 1] - vertices[a + 1], uz = vertices[b + 2] - vertices[a + 2];
        const vx = vertices[c] - vertices[a], vy = vertices[c + 1] - vertices[a + 1], vz = vertices[c + 2] - vertices[a + 2];
        across[face] = uy * vz - uz * vy;
        across[face + 1] = uz * vx - ux * vz;
        across[face + 2] = ux * vy - uy * vx;
    }
    return across;
}

/** The corners at vertex v are corners[first[v]] to corners[first[v + 1] - 1]. */
function cornersByVertex(faces: Uint32Array, vertexCount: number): { first: Uint32Array; corners: Uint32Array } {
    const first = new Uint32Array(vertexCount + 1);
    for (const vertex of faces) ++first[vertex + 1];
    for (let v = 0; v < vertexCount; ++v) first[v + 1] += first[v];
    const next = first.slice(), corners = new Uint32Array(faces.length);
    faces.forEach((vertex, corner) => (corners[next[vertex]++] = corner));
    return { first, corners };
}

/**
 * Normals of a sheet whose particles lie row by row, of any length but 0: cross products of the differences between
 * neighbours in the row and in the column. One pass, so that they do not delay a cloth of 100 000.
 * @param positions  [3 columns rows]
 * @param normals    [3 columns rows] out
 */
export function sheetNormals(positions: Float32Array, columns: number, normals: Float32Array): void {
    const rows = positions.length / 3 / columns;
    for (let row = 0; row < rows; ++row) {
        const up = row > 0 ? -3 * columns : 0;
        const down = row + 1 < rows ? 3 * columns : 0;
        for (let column = 0; column < columns; ++column) {
            const i = 3 * (row * columns + column);
            const left = column > 0 ? i - 3 : i;
            const right = column + 1 < columns ? i + 3 : i;
            const ax = positions[right] - positions[left], bx = positions[i + down] - positions[i + up];
            const ay = positions[right + 1] - positions[left + 1], by = positions[i + down + 1] - positions[i + up + 1];
            const az = positions[right + 2] - positions[left + 2], bz = positions[i + down + 2] - positions[i + up + 2];
            const x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
            const scale = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
            normals[i] = scale * x;
            normals[i + 1] = scale * y;
            normals[i + 2] = scale * z;
        }
    }
}
