import type { Triple } from '../../protocol';

export interface SheetMesh {
    vertices: number[];
    faces: number[];
    weave: number[];
}

/**
 * A sheet as a mesh of rows of squares.
 * @param place  of a point of it, given as shares of its width and height @param size  of the fabric
 */
export function sheetMesh(columns: number, rows: number, [width, height]: readonly [number, number], place: (u: number, v: number) => Triple): SheetMesh {
    const mesh: SheetMesh = { vertices: [], faces: [], weave: [] };
    for (let row = 0; row < rows; ++row)
        for (let column = 0; column < columns; ++column) {
            const u = column / (columns - 1), v = row / (rows - 1);
            mesh.vertices.push(...place(u, v));
            mesh.weave.push(u * width, v * height);
        }
    for (let row = 0; row + 1 < rows; ++row)
        for (let column = 0; column + 1 < columns; ++column) mesh.faces.push(...square(row * columns + column, 1, columns));
    return mesh;
}

/** The two faces between a vertex and its next ones in the row and in the column. */
export const square = (a: number, right: number, down: number): number[] => [a, a + right, a + right + down, a, a + right + down, a + down];
