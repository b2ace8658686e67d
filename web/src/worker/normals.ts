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
