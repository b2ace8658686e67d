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

/** Square sheets above each other, the lowest at height 0, each turned against the one below it. @param size  of one */
export function stackOf({ count, columns, size, apart, turn }: { count: number; columns: number; size: number; apart: number; turn: number }): SheetMesh & { tints: number[] } {
    const stack = { vertices: [] as number[], faces: [] as number[], weave: [] as number[], tints: [] as number[] };
    for (let layer = 0; layer < count; ++layer) {
        const [c, s] = [Math.cos(turn * layer), Math.sin(turn * layer)];
        const sheet = sheetMesh(columns, columns, [size, size], (u, v) => {
            const [x, y] = [(u - 0.5) * size, (v - 0.5) * size];
            return [c * x - s * y, s * x + c * y, layer * apart];
        });
        const first = stack.vertices.length / 3;
        for (const part of sheet.vertices) stack.vertices.push(part);
        for (const corner of sheet.faces) stack.faces.push(first + corner);
        for (const part of sheet.weave) stack.weave.push(part);
        for (let i = 0; i < columns * columns; ++i) stack.tints.push(layer / (count - 1));
    }
    return stack;
}

/** The two faces between a vertex and its next ones in the row and in the column. */
export const square = (a: number, right: number, down: number): number[] => [a, a + right, a + right + down, a, a + right + down, a + down];
