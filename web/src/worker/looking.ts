import type { DistanceMap, Echinus, ExactMap } from 'echinus';
import { UNIT, following } from '../axes';
import type { Cut, FromWorker, SurfaceNews, Triple } from '../protocol';
import type { Playground } from './playground';

const CUT_SIDE = 220;
const SAMPLE_COUNT = 200_000;

/** The surface of the map in use, with the numbers that colour it, and where the two kinds of map differ. */
export function surfaceOf(echinus: Echinus, { map, exactMap, settings, body }: Playground): SurfaceNews {
    const { mesh, values } = map.kind === 'exact' ? withLists(map) : withLayers(map);
    const news = {
        vertices: mesh.vertices,
        faces: mesh.faces,
        values,
        mapKind: settings.map,
        disagreements: map.kind === 'exact' ? new Float32Array() : disagreements(echinus, exactMap, map, body.centre, body.radius),
        sampleCount: SAMPLE_COUNT,
        ...(map.kind === 'exact' && { cells: map.cells() }),
    };
    mesh.delete();
    return news;
}

function withLists(map: ExactMap) {
    const { mesh, longestLists } = map.surface();
    return { mesh, values: longestLists };
}
function withLayers(map: DistanceMap) {
    const { mesh, layers } = map.surface();
    return { mesh, values: layers };
}

/** The points of a fixed sequence in the bounding sphere that one map has inside and the other outside. */
function disagreements(echinus: Echinus, exact: ExactMap, distance: DistanceMap, centre: readonly number[], radius: number): Float32Array {
    const points = echinus.makePoints(SAMPLE_COUNT);
    const first = echinus.makeFlags(SAMPLE_COUNT);
    const second = echinus.makeFlags(SAMPLE_COUNT);
    try {
        const { view } = points;
        for (let i = 0; i < SAMPLE_COUNT; ++i) {
            const [x, y, z] = inUnitBall(i);
            view.set([centre[0] + radius * x, centre[1] + radius * y, centre[2] + radius * z], 3 * i);
        }
        const a = exact.containsBatch(points, first).view;
        const b = distance.containsBatch(points, second).view;
        const found: number[] = [];
        for (let i = 0; i < SAMPLE_COUNT; ++i) if (a[i] !== b[i]) found.push(...points.view.subarray(3 * i, 3 * i + 3));
        return new Float32Array(found);
    } finally {
        for (const buffer of [points, first, second]) buffer.delete();
    }
}

/**
 * Point i of a sequence that fills the unit ball evenly: Roberts, "The Unreasonable Effectiveness of Quasirandom
 * Sequences" (2018), R3, mapped to volume, height and longitude.
 */
function inUnitBall(i: number): Triple {
    const [u, v, w] = [0.8191725133961645, 0.6710436067037893, 0.5497004779019703].map((step) => (0.5 + step * i) % 1);
    const radius = Math.cbrt(u), height = 2 * v - 1, longitude = 2 * Math.PI * w;
    const across = radius * Math.sqrt(1 - height * height);
    return [across * Math.cos(longitude), across * Math.sin(longitude), radius * height];
}

/** The answers of the map in use on a square across the bounding sphere. @param height  along up, in radii from the centre */
export function cutAt(echinus: Echinus, { map, body: { centre, radius, up } }: Playground, height: number): Cut {
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
    const { centre } = playground.body;
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
