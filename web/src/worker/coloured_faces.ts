import type { ColouredFaces, Triple } from '../protocol';
import { LAYERS, SCALE } from '../view/colours';

/** A colour for each value from 0 on: [3 values], linear, as three.js takes the colours of vertices. */
type Palette = Float32Array;

/** @param positions  [9 faces] of their corners @param values  [faces] in the palette */
export function colouredFaces(positions: Float32Array<ArrayBuffer>, values: Uint32Array, palette: Palette): ColouredFaces {
    const normals = new Float32Array(positions.length), colours = new Float32Array(positions.length);
    for (let face = 0; face < values.length; ++face) {
        const at = 9 * face, colour = 3 * values[face];
        const ux = positions[at + 3] - positions[at], vx = positions[at + 6] - positions[at];
        const uy = positions[at + 4] - positions[at + 1], vy = positions[at + 7] - positions[at + 1];
        const uz = positions[at + 5] - positions[at + 2], vz = positions[at + 8] - positions[at + 2];
        const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
        const scale = 1 / (Math.hypot(x, y, z) || 1);
        for (let corner = at; corner < at + 9; corner += 3) {
            normals[corner] = scale * x;
            normals[corner + 1] = scale * y;
            normals[corner + 2] = scale * z;
            for (let k = 0; k < 3; ++k) colours[corner + k] = palette[colour + k];
        }
    }
    return { positions, normals, colours };
}

/** The scale from 0 to the largest value, evenly between its stops. */
export function scaleTo(largest: number): Palette {
    const stops = SCALE.map(linear);
    return paletteOf(largest, (value) => {
        const place = ((stops.length - 1) * value) / largest;
        const stop = Math.min(stops.length - 2, Math.floor(place));
        return stops[stop].map((part, k) => part + (place - stop) * (stops[stop + 1][k] - part)) as Triple;
    });
}

/** Neighbouring layers differ. */
export function layersTo(largest: number): Palette {
    const colours = LAYERS.map(linear);
    return paletteOf(largest, (layer) => colours[layer % colours.length]);
}

function paletteOf(largest: number, colourOf: (value: number) => Triple): Palette {
    const palette = new Float32Array(3 * (largest + 1));
    for (let value = 0; value <= largest; ++value) palette.set(colourOf(value), 3 * value);
    return palette;
}

/** Of an sRGB colour: IEC 61966-2-1. */
const linear = (hex: number): Triple =>
    [16, 8, 0].map((shift) => {
        const part = ((hex >> shift) & 0xff) / 255;
        return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
    }) as Triple;

/** The end of the scale. */
export function largestOf(values: Uint32Array): number {
    let largest = 1;
    for (const value of values) if (value > largest) largest = value;
    return largest;
}

/** The corners of all faces, one after the other. @param turned  the faces look the other way */
export function cornersOf(vertices: Float32Array, faces: Uint32Array, turned: boolean): Float32Array<ArrayBuffer> {
    const corners = new Float32Array(3 * faces.length);
    const order = turned ? [0, 2, 1] : [0, 1, 2];
    for (let i = 0; i < faces.length; ++i) {
        const vertex = 3 * faces[i - (i % 3) + order[i % 3]];
        for (let k = 0; k < 3; ++k) corners[3 * i + k] = vertices[vertex + k];
    }
    return corners;
}

/** Triangles of unit vectors on a sphere, looking outwards. @param unit  [9 triangles] */
export function onSphere(unit: Float32Array, centre: readonly number[], radius: number): Float32Array<ArrayBuffer> {
    const corners = new Float32Array(unit.length);
    for (let at = 0; at < unit.length; at += 9) {
        const order = looksOutwards(unit, at) ? [0, 3, 6] : [0, 6, 3];
        for (let corner = 0; corner < 9; ++corner) corners[at + corner] = centre[corner % 3] + radius * unit[at + order[Math.floor(corner / 3)] + (corner % 3)];
    }
    return corners;
}

/** The sign of the determinant of a triangle's corners. */
function looksOutwards(p: Float32Array, a: number): boolean {
    const b = a + 3, c = a + 6;
    const x = p[b + 1] * p[c + 2] - p[b + 2] * p[c + 1], y = p[b + 2] * p[c] - p[b] * p[c + 2], z = p[b] * p[c + 1] - p[b + 1] * p[c];
    return p[a] * x + p[a + 1] * y + p[a + 2] * z > 0;
}
