import type { Echinus, Mesh, SceneDescription, Simulation } from 'echinus';
import type { Triple } from '../../protocol';
import type { Settings } from '../../settings';
import type { Body } from '../cloth_scene';
import type { SolidMesh } from './solids';

/** The scene around a model: by default sheets fall on it (sheets.ts). */
export interface Act {
    /** The model, where the act makes it. */
    solid?: SolidMesh;
    /** Its vertices at a time, where it deforms: at 0 those of `solid`. It does so while surfaces collide, which alone are kept off faces that move. */
    shape?(seconds: number): Float32Array<ArrayBuffer>;
    /** The sphere that the camera shows, and to which lengths and gravity are scaled, if it is not that of the model. */
    body?: Pick<Body, 'centre' | 'radius' | 'up'>;
    /** How high the ground is, along up, where it is not under the model. */
    floor?: number;
    /** The cloth or the soft bodies in the scene, with the material, and what differs from every act's scene. */
    scene(settings: Settings, body: Body): Partial<SceneDescription>;
    /** The distance that particles keep from the model. */
    thickness(settings: Settings, body: Body): number;
    /** A cloth that is not one sheet. The caller deletes its mesh. */
    cloth?(echinus: Echinus, settings: Settings, body: Body): Garment | undefined;
    /** The surfaces of soft bodies. The caller deletes them. */
    bodies?(echinus: Echinus): Mesh[];
    /** Sets velocities of particles before each step. */
    steer?(simulation: Simulation, seconds: number, timeStep: number): void;
    /** The model's own motion at a time, where it has one: velocities of the pose of its frame. */
    motion?(seconds: number): { linear: Triple; angular: Triple };
    /** The air's velocity at a time, in radii per second. */
    wind?(seconds: number): Triple;
    /** How far down the visitor may push the model; by default onto the ground. */
    deepest?: number;
    /** Until then nothing counts as at rest, in seconds. */
    lasts: number;
}

export interface Garment {
    mesh: Mesh;
    /** [2 particles] places on the fabric, in units of length. */
    weave: Float32Array<ArrayBuffer>;
    /** [particles] places on the scale of colours, 0 to 1, where pieces differ in colour. */
    tints?: Float32Array<ArrayBuffer>;
    /** The edge of its sheets on the fabric, where they are squares with a border. */
    hem?: number;
}

/** @param unit  the length that places on the fabric are measured by */
export function garmentOf(echinus: Echinus, { vertices, faces, weave, tints }: SheetMesh & { tints?: number[] }, { unit = 1, hem }: { unit?: number; hem?: number } = {}): Garment {
    return { mesh: echinus.makeMesh(vertices, faces), weave: Float32Array.from(weave, (part) => part / unit), ...(tints && { tints: new Float32Array(tints) }), ...(hem && { hem }) };
}

interface SheetMesh {
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
