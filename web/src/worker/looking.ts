import type { DistanceMap, Echinus, ExactMap } from 'echinus';
import { UNIT, following } from '../frames';
import { type CellNews, type ColouredFaces, type Cut, type Difference, type FromWorker, type SurfaceNews, type Triple, isInsideOut } from '../protocol';
import { colouredFaces, cornersOf, largestOf, layersTo, onSphere, scaleTo } from './coloured_faces';
import type { Playground } from './playground';

const CUT_SIDE = 220;
const SAMPLE_COUNT = 200_000;
/** Points at most this far from the surface, in radii. */
const NEAR = 0.02;
const NEAR_COUNT = 100_000;

/** The surface of the map in use in colours, and where the two kinds of map differ. */
export function surfaceOf(echinus: Echinus, { map, exactMap, report }: Playground): SurfaceNews {
    const { mesh, values } = map.kind === 'exact' ? withLists(map) : withLayers(map);
    const largest = largestOf(values);
    // An exact map has the model's own faces, which may look inwards.
    const corners = cornersOf(mesh.vertices, mesh.faces, map.kind === 'exact' && isInsideOut(report));
    mesh.delete();
    return {
        faces: colouredFaces(corners, values, map.kind === 'exact' ? scaleTo(largest) : layersTo(largest)),
        largest,
        mapKind: map.kind,
        ...(map.kind === 'distance' && { differences: differencesOf(echinus, exactMap, map) }),
    };
}

/** The cells of the map in use, where that is an exact one. */
export function cellsOf({ map }: Playground): CellNews | undefined {
    if (map.kind !== 'exact') return undefined;
    const { faceCounts, corners } = map.cells();
    const largest = largestOf(faceCounts);
    return { faces: colouredFaces(onSphere(corners, map.centre, map.radius), faceCounts, scaleTo(largest)), largest };
}

/** The buffers that are transferred to the page without a copy. */
export const buffersOf = ({ positions, normals, colours }: ColouredFaces): Transferable[] => [positions.buffer, normals.buffer, colours.buffer];

function withLists(map: ExactMap) {
    const { mesh, longestLists } = map.surface();
    return { mesh, values: longestLists };
}
function withLayers(map: DistanceMap) {
    const { mesh, layers } = map.surface();
    return { mesh, values: layers };
}

/** Where the two maps differ: of points of fixed sequences in the bounding sphere, and near the surface. */
function differencesOf(echinus: Echinus, exact: ExactMap, distance: DistanceMap): NonNullable<SurfaceNews['differences']> {
    const { centre, radius } = exact;
    const inBall = (i: number) => inUnitBall(i).map((part, k) => centre[k] + radius * part) as Triple;
    const { mesh } = exact.surface();
    const near = nearSurface(mesh.vertices, mesh.faces, NEAR * radius);
    mesh.delete();
    return {
        everywhere: difference(echinus, exact, distance, SAMPLE_COUNT, inBall),
        near: { ...difference(echinus, exact, distance, NEAR_COUNT, near), within: NEAR },
    };
}

/** @param pointAt  point i of a sequence */
function difference(echinus: Echinus, exact: ExactMap, distance: DistanceMap, sampleCount: number, pointAt: (i: number) => Triple): Difference {
    const points = echinus.makePoints(sampleCount);
    const first = echinus.makeFlags(sampleCount);
    const second = echinus.makeFlags(sampleCount);
    try {
        const { view } = points;
        for (let i = 0; i < sampleCount; ++i) view.set(pointAt(i), 3 * i);
        const a = exact.containsBatch(points, first).view;
        const b = distance.containsBatch(points, second).view;
        const found: number[] = [];
        for (let i = 0; i < sampleCount; ++i) if (a[i] !== b[i]) found.push(...points.view.subarray(3 * i, 3 * i + 3));
        return { points: new Float32Array(found), sampleCount };
    } finally {
        for (const buffer of [points, first, second]) buffer.delete();
    }
}

/** A sequence of points on the faces, evenly by area, and off them by up to a distance to either side. */
function nearSurface(vertices: Float32Array, faces: Uint32Array, distance: number): (i: number) => Triple {
    const corner = (face: number, k: number) => [0, 1, 2].map((c) => vertices[3 * faces[3 * face + k] + c]);
    const across = (face: number) => {
        const [a, b, c] = [0, 1, 2].map((k) => corner(face, k));
        const [u, v] = [b, c].map((p) => p.map((part, k) => part - a[k]));
        return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    };
    const sums = new Float64Array(faces.length / 3 + 1);
    for (let face = 0; face + 1 < sums.length; ++face) sums[face + 1] = sums[face] + Math.hypot(...across(face));
    const total = sums[sums.length - 1];
    let face = 0;
    return (i) => {
        const wanted = ((i + 0.5) / NEAR_COUNT) * total; // ascending, so the face is found by going on
        if (i === 0) face = 0;
        while (face + 2 < sums.length && sums[face + 1] < wanted) ++face;
        let [u, v, w] = fractions(i);
        if (u + v > 1) [u, v] = [1 - u, 1 - v];
        const [a, b, c] = [0, 1, 2].map((k) => corner(face, k));
        const normal = across(face);
        const out = ((2 * w - 1) * distance) / (Math.hypot(...normal) || 1);
        return [0, 1, 2].map((k) => a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]) + out * normal[k]) as Triple;
    };
}

/**
 * Point i of a sequence that fills the unit ball evenly: Roberts, "The Unreasonable Effectiveness of Quasirandom
 * Sequences" (2018), R3, mapped to volume, height and longitude.
 */
function inUnitBall(i: number): Triple {
    const [u, v, w] = fractions(i);
    const radius = Math.cbrt(u), height = 2 * v - 1, longitude = 2 * Math.PI * w;
    const across = radius * Math.sqrt(1 - height * height);
    return [across * Math.cos(longitude), across * Math.sin(longitude), radius * height];
}

const fractions = (i: number) => [0.8191725133961645, 0.6710436067037893, 0.5497004779019703].map((step) => (0.5 + step * i) % 1);

/** The answers of the map in use on a square across the bounding sphere. @param height  along up, in radii from the centre */
export function cutAt(echinus: Echinus, { map, body: { up } }: Playground, height: number): Cut {
    const { centre, radius } = map;
    const [across, along] = following(up).map((axis) => UNIT[axis]);
    const count = CUT_SIDE * CUT_SIDE;
    const points = echinus.makePoints(count);
    const inside = echinus.makeFlags(count);
    try {
        const { view } = points;
        const place = (i: number) => ((2 * i + 1) / CUT_SIDE - 1) * radius;
        for (let row = 0; row < CUT_SIDE; ++row)
            for (let column = 0; column < CUT_SIDE; ++column)
                for (let k = 0; k < 3; ++k)
                    view[3 * (row * CUT_SIDE + column) + k] = centre[k] + UNIT[up][k] * height * radius + across[k] * place(column) + along[k] * place(row);
        return { inside: map.containsBatch(points, inside).view.slice(), side: CUT_SIDE, height };
    } finally {
        points.delete();
        inside.delete();
    }
}

/** The ray through the first point of the surface on a straight line, if there is one. */
export function lookAt(playground: Playground, from: Triple, to: Triple): FromWorker {
    const { found, point } = playground.exactMap.sweep(from, to);
    if (!found) return { kind: 'missed' };
    const { centre } = playground.exactMap;
    return lookAlong(playground, [0, 1, 2].map((k) => point[k] - centre[k]) as Triple);
}

/** The data of the map in use along a ray from its centre. */
export function lookAlong({ map }: Playground, direction: Triple): FromWorker {
    if (map.kind === 'distance') {
        const { crossings, intervals } = map.ray(direction);
        return { kind: 'ray', crossings, intervals, direction, outline: [], bands: [] };
    }
    const { crossings, intervals, cellCorners, bands } = map.ray(direction);
    return { kind: 'ray', crossings, intervals, direction, outline: cellCorners, bands: bands.map(({ from, to }) => [from, to]) };
}
