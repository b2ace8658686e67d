import type { Triple } from '../../protocol';

/** Negative inside a solid. */
type Field = (x: number, y: number, z: number) => number;

export interface SolidMesh {
    vertices: Float32Array;
    faces: Uint32Array;
}

/** A closed mesh of a solid of revolution about z. @param outline  radius and height, from the lower pole to the upper, whose radii are 0 */
export function lathe(outline: readonly (readonly [number, number])[], segments: number): SolidMesh {
    const rings = outline.slice(1, -1);
    const vertices: number[] = [0, 0, outline[0][1]], faces: number[] = [];
    for (const [radius, height] of rings)
        for (let s = 0; s < segments; ++s) vertices.push(radius * Math.cos((2 * Math.PI * s) / segments), radius * Math.sin((2 * Math.PI * s) / segments), height);
    const last = vertices.length / 3;
    vertices.push(0, 0, outline[outline.length - 1][1]);
    const at = (ring: number, s: number) => 1 + ring * segments + (s % segments);
    for (let s = 0; s < segments; ++s) {
        faces.push(0, at(0, s + 1), at(0, s));
        for (let ring = 0; ring + 1 < rings.length; ++ring)
            faces.push(at(ring, s), at(ring, s + 1), at(ring + 1, s + 1), at(ring, s), at(ring + 1, s + 1), at(ring + 1, s));
        faces.push(last, at(rings.length - 1, s), at(rings.length - 1, s + 1));
    }
    return { vertices: new Float32Array(vertices), faces: new Uint32Array(faces) };
}

/** A cone with a ball at each end. */
export function limb(a: Triple, b: Triple, radiusA: number, radiusB: number): Field {
    const way = b.map((part, k) => part - a[k]);
    const square = way.reduce((sum, part) => sum + part * part, 0);
    return (x, y, z) => {
        const [px, py, pz] = [x - a[0], y - a[1], z - a[2]];
        const t = Math.min(1, Math.max(0, (px * way[0] + py * way[1] + pz * way[2]) / square));
        return Math.hypot(px - t * way[0], py - t * way[1], pz - t * way[2]) - (radiusA + t * (radiusB - radiusA));
    };
}

export const ellipsoid = (centre: Triple, [rx, ry, rz]: Triple): Field => {
    const least = Math.min(rx, ry, rz);
    return (x, y, z) => (Math.hypot((x - centre[0]) / rx, (y - centre[1]) / ry, (z - centre[2]) / rz) - 1) * least;
};

/** Fields joined with fillets of about this size: the polynomial smooth minimum of Quilez, "Smooth minimum" (2013). */
export function joined(fields: readonly Field[], fillet: number): Field {
    return (x, y, z) =>
        fields.map((field) => field(x, y, z)).reduce((a, b) => {
            const h = Math.max(0, fillet - Math.abs(a - b)) / fillet;
            return Math.min(a, b) - 0.25 * h * h * fillet;
        });
}

/**
 * The surface of a solid by surface nets: Gibson, "Constrained Elastic Surface Nets" (1998). Closed, where the box holds all of the solid.
 * @param step  the edge of the grid's cells
 */
export function surfaceOf(field: Field, from: Triple, to: Triple, step: number): SolidMesh {
    const counts = from.map((low, k) => Math.ceil((to[k] - low) / step) + 1) as Triple;
    const [nx, ny, nz] = counts;
    const strides: Triple = [1, nx, nx * ny];
    const values = new Float32Array(nx * ny * nz);
    for (let k = 0, i = 0; k < nz; ++k)
        for (let j = 0; j < ny; ++j) for (let c = 0; c < nx; ++c, ++i) values[i] = field(from[0] + c * step, from[1] + j * step, from[2] + k * step);
    const vertices: number[] = [], faces: number[] = [];
    const vertexOf = new Int32Array(values.length).fill(-1);
    const inside = (i: number) => values[i] < 0;
    for (let k = 0; k + 1 < nz; ++k)
        for (let j = 0; j + 1 < ny; ++j)
            for (let c = 0; c + 1 < nx; ++c) {
                const cell = c + j * nx + k * nx * ny;
                const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((b) => cell + (b & 1) + ((b >> 1) & 1) * nx + (b >> 2) * nx * ny);
                const within = corners.filter(inside).length;
                if (within === 0 || within === 8) continue;
                vertexOf[cell] = vertices.length / 3;
                vertices.push(...ontoSurface(field, [from[0] + (c + 0.5) * step, from[1] + (j + 0.5) * step, from[2] + (k + 0.5) * step], step));
            }
    // Each edge of the grid through the surface gives a square between the four cells around it.
    for (let k = 1; k + 1 < nz; ++k)
        for (let j = 1; j + 1 < ny; ++j)
            for (let c = 1; c + 1 < nx; ++c) {
                const i = c + j * nx + k * nx * ny;
                for (let axis = 0; axis < 3; ++axis) {
                    if (inside(i) === inside(i + strides[axis])) continue;
                    const [u, v] = [strides[(axis + 1) % 3], strides[(axis + 2) % 3]];
                    const around = [i - u - v, i - v, i, i - u].map((cell) => vertexOf[cell]);
                    if (!inside(i)) around.reverse();
                    faces.push(around[0], around[1], around[2], around[0], around[2], around[3]);
                }
            }
    return { vertices: new Float32Array(vertices), faces: new Uint32Array(faces) };
}

/** Leads a point towards the surface by the field's slope, staying within its cell. */
function ontoSurface(field: Field, centre: Triple, step: number): Triple {
    const point: Triple = [...centre];
    const e = 0.05 * step;
    for (let turn = 0; turn < 4; ++turn) {
        const [x, y, z] = point;
        const value = field(x, y, z);
        const slope = [field(x + e, y, z) - field(x - e, y, z), field(x, y + e, z) - field(x, y - e, z), field(x, y, z + e) - field(x, y, z - e)].map((d) => d / (2 * e));
        const square = slope.reduce((sum, part) => sum + part * part, 0) || 1;
        for (let k = 0; k < 3; ++k) {
            const next = point[k] - (value * slope[k]) / square;
            point[k] = Math.min(centre[k] + 0.49 * step, Math.max(centre[k] - 0.49 * step, next));
        }
    }
    return point;
}
