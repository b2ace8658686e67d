import { Handle, requireOwn } from './core.mjs';
import { refuse, requireCount, requirePoint } from './errors.mjs';

const FAULTS = ['borderEdges', 'nonmanifoldEdges', 'misorientedEdges', 'duplicateFaces', 'degenerateFaces'];
const REPAIRS = ['duplicate_faces', 'doubled_patches', 'inside_out', 'seams', 'slivers', 'orientation'];

export class Mesh extends Handle {
    constructor(core, address) {
        super(core, address, 'mesh_delete');
    }

    static fromArrays(core, vertices, faces) {
        const arrays = [asVertices(vertices), asIndices(faces, 'faces', 3)];
        const [vertexCount, faceCount] = arrays.map(({ length }) => length / 3); // now: the module's own arrays are empty once its memory grows
        return core.withCopies(arrays, (v, f) => new Mesh(core, core.try('mesh_make', v, vertexCount, f, faceCount)));
    }
    static fromPolygons(core, vertices, corners, cornerCounts) {
        const arrays = [asVertices(vertices), asIndices(corners, 'corners', 1), asIndices(cornerCounts, 'corner counts', 1)];
        const [coordinateCount, cornerCount, polygonCount] = arrays.map(({ length }) => length);
        return core.withCopies(arrays, (v, c, n) =>
            new Mesh(core, core.try('mesh_make_from_polygons', v, coordinateCount / 3, c, cornerCount, n, polygonCount)));
    }
    static fromBytes(core, bytes, name) {
        if (typeof name !== 'string') refuse('the name of the file is required; its extension gives the format');
        const data = asBytes(bytes);
        return core.withTexts([name], (n, size) =>
            core.withCopies([data], (b) => new Mesh(core, core.try('mesh_read', b, data.length, n, size))));
    }
    static torus(core, majorRadius, minorRadius, majorSegments, minorSegments) {
        requireCount(majorSegments, 'majorSegments');
        requireCount(minorSegments, 'minorSegments');
        return new Mesh(core, core.try('mesh_make_torus', majorRadius, minorRadius, majorSegments, minorSegments));
    }
    static sphere(core, radius, meridianCount, parallelCount) {
        requireCount(meridianCount, 'meridianCount');
        requireCount(parallelCount, 'parallelCount');
        return new Mesh(core, core.try('mesh_make_sphere', radius, meridianCount, parallelCount));
    }
    static box(core, size, segments) {
        requirePoint(size, 'the size of a box');
        requireCount(segments, 'segments');
        return new Mesh(core, core.try('mesh_make_box', ...size, segments));
    }

    get vertexCount() {
        return this.core.call('mesh_vertex_count', this.address);
    }
    get faceCount() {
        return this.core.call('mesh_face_count', this.address);
    }
    /** Copies. */
    get vertices() {
        return this.core.copyFloats(this.core.call('mesh_vertices', this.address), 3 * this.vertexCount);
    }
    get origin() {
        const address = this.core.call('mesh_origin', this.address) >>> 0;
        return Array.from(new Float64Array(this.core.views.bytes.buffer, address, 3));
    }
    get faces() {
        return this.core.copyWords(this.core.call('mesh_faces', this.address), 3 * this.faceCount);
    }

    report() {
        return this.core.json('mesh_report', this.address);
    }

    faults() {
        const lists = this.#numbers(FAULTS.length, 'mesh_faults');
        return Object.fromEntries(FAULTS.map((name, which) => [name, lists[which]]));
    }

    intersectingPairs(other) {
        return this.#numbers(1, 'mesh_intersecting_pairs', requireOwn(this.core, other, Mesh))[0];
    }
    selfIntersectingPairs() {
        return this.#numbers(1, 'mesh_self_intersecting_pairs')[0];
    }

    /** Copies of the first lists of numbers that an export returns. */
    #numbers(listCount, name, ...args) {
        const arrays = this.core.try(name, this.address, ...args);
        try {
            return Array.from({ length: listCount }, (_, which) =>
                this.core.copyWords(this.core.call('arrays_numbers', arrays, which), this.core.call('arrays_number_count', arrays, which)));
        } finally {
            this.core.call('arrays_delete', arrays);
        }
    }

    weld() {
        return new Mesh(this.core, this.core.try('mesh_weld', this.address));
    }

    repair(words = REPAIRS) {
        for (const word of words) if (!REPAIRS.includes(word)) refuse(`there is no repair '${word}'; there are ${REPAIRS.join(', ')}`);
        const repaired = this.core.try('mesh_repair', this.address, ...REPAIRS.map((word) => (words.includes(word) ? 1 : 0)));
        try {
            const report = this.core.json('repaired_report', repaired);
            return { mesh: new Mesh(this.core, this.core.try('repaired_mesh', repaired)), report };
        } finally {
            this.core.call('repaired_delete', repaired);
        }
    }

    windingNumber(point) {
        return this.core.call('mesh_winding_number', this.address, ...requirePoint(point, 'the point'));
    }
    unsignedDistance(point) {
        return this.core.call('mesh_unsigned_distance', this.address, ...requirePoint(point, 'the point'));
    }
}

export function asVertices(values) {
    if (values?.length === undefined || values.length % 3 !== 0) refuse('vertices must be an array of three numbers for each vertex');
    return values instanceof Float32Array ? values : Float32Array.from(values);
}

export function asIndices(values, what, multiple) {
    if (values?.length === undefined || values.length % multiple !== 0)
        refuse(`${what} must be an array of whole numbers${multiple > 1 ? `, ${multiple} for each` : ''}`);
    if (values instanceof Uint32Array) return values;
    // Typed arrays of other kinds would silently convert values that do not fit.
    const index = Array.prototype.findIndex.call(values, (v) => !Number.isInteger(v) || v < 0 || v > 0xffffffff);
    if (index >= 0) refuse(`number ${index} of ${what} is ${String(values[index])}; it must be a whole number from 0 to 2^32 - 1`);
    return Uint32Array.from(values);
}

export function asBytes(bytes) {
    if (bytes instanceof Uint8Array) return bytes;
    if (bytes instanceof ArrayBuffer) return new Uint8Array(bytes);
    if (ArrayBuffer.isView(bytes)) return new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    return refuse('bytes must be an ArrayBuffer or a view of one');
}
