/** Geometries of three.js: as meshes, and of cloth. */
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Vector3 } from 'three';
import { refuse } from './errors.mjs';

export function meshOfGeometry(echinus, geometry, matrix = null) {
    if (!geometry?.attributes?.position?.count) refuse('a BufferGeometry with positions is needed here; of an object, its geometry');
    const { position } = geometry.attributes;
    const vertices = new Float32Array(3 * position.count);
    const vertex = new Vector3();
    for (let i = 0; i < position.count; ++i) {
        vertex.fromBufferAttribute(position, i); // attributes may be interleaved, quantised and normalised
        vertex.toArray(vertices, 3 * i);
    }
    const corners = Uint32Array.from({ length: geometry.index?.count ?? position.count }, geometry.index ? (_, i) => geometry.index.getX(i) : (_, i) => i);
    join(corners, vertices);
    if (matrix) for (let i = 0; i < vertices.length; i += 3) vertex.fromArray(vertices, i).applyMatrix4(matrix).toArray(vertices, i);
    const mesh = echinus.makeMesh(vertices, isMirror(matrix) ? turnedRound(corners) : corners);
    try {
        return mesh.weld(); // drops the vertices that are not used any more
    } finally {
        mesh.delete();
    }
}

export function geometryOfMesh(mesh) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(mesh.vertices, 3));
    geometry.setIndex(new BufferAttribute(mesh.faces, 1));
    geometry.computeVertexNormals();
    return geometry;
}

export class ClothGeometry extends BufferGeometry {
    #simulation;

    constructor(simulation) {
        super();
        this.setAttribute('position', new BufferAttribute(simulation.positions.slice(), 3).setUsage(DynamicDrawUsage));
        this.setIndex(new BufferAttribute(simulation.faces, 1));
        this.#simulation = simulation;
        this.update();
    }

    /** As it is now; it does not follow the simulation. */
    clone() {
        return new BufferGeometry().copy(this);
    }

    update() {
        const { position } = this.attributes;
        position.array.set(this.#simulation.positions);
        position.needsUpdate = true;
        this.computeVertexNormals();
        this.computeBoundingSphere();
        this.boundingBox = null; // made anew when somebody asks
    }
}

/** Of the largest coordinate: what sines and cosines of a full turn are off by, and a few times more. */
const TOLERANCE = 1e-6;
const CELLS = 1e4; // to the largest coordinate: a place is rarely so near to another cell that two have to be looked at

/**
 * Gives each corner the first vertex at its place. A geometry has a vertex for each normal and texture coordinate, and where
 * its shape closes, those of its beginning and its end differ by rounding. An index without a vertex
 * and a vertex that is no place stay, to be refused.
 */
function join(corners, vertices) {
    const used = [...Uint32Array.from(new Set(corners)).sort()].filter((i) => 3 * i < vertices.length);
    const largest = used.reduce((most, i) => Math.max(most, Math.abs(vertices[3 * i]), Math.abs(vertices[3 * i + 1]), Math.abs(vertices[3 * i + 2])), 0);
    if (!(largest > 0 && largest < Infinity)) return;
    const tolerance = TOLERANCE * largest;
    const cellsAround = (c) => [...new Set([c - tolerance, c, c + tolerance].map((x) => Math.floor((x / largest) * CELLS)))];
    const cells = new Map();
    const isNear = (a, b) => [0, 1, 2].every((k) => Math.abs(vertices[3 * a + k] - vertices[3 * b + k]) <= tolerance);
    const firstAt = (i) => {
        const around = [0, 1, 2].map((k) => cellsAround(vertices[3 * i + k]));
        for (const x of around[0])
            for (const y of around[1])
                for (const z of around[2]) {
                    const near = cells.get(`${x} ${y} ${z}`)?.find((j) => isNear(i, j));
                    if (near !== undefined) return near;
                }
        const own = [0, 1, 2].map((k) => Math.floor((vertices[3 * i + k] / largest) * CELLS)).join(' ');
        if (!cells.has(own)) cells.set(own, []);
        cells.get(own).push(i);
        return i;
    };
    const places = new Map(used.map((i) => [i, firstAt(i)]));
    corners.forEach((corner, at) => (corners[at] = places.get(corner) ?? corner));
}

const isMirror = (matrix) => matrix !== null && matrix.determinant() < 0;

function turnedRound(corners) {
    for (let i = 0; i < corners.length; i += 3) [corners[i + 1], corners[i + 2]] = [corners[i + 2], corners[i + 1]];
    return corners;
}
