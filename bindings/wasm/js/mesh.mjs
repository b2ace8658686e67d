import { Handle, requireOwn } from './core.mjs';
import { refuse, requireCount, requirePoint } from './errors.mjs';
import { checkedMeshes, meshReport, partReport, repairOptions, repairReport, repairs } from './structs.mjs';

const FAULTS = ['borderEdges', 'nonmanifoldEdges', 'misorientedEdges', 'duplicateFaces', 'degenerateFaces'];

export class Mesh extends Handle {
    constructor(core, address) {
        super(core, address, 'echinus_mesh_destroy');
    }

    static fromArrays(core, vertices, faces) {
        const arrays = [asVertices(vertices), asIndices(faces, 'faces', 3)];
        const [vertexCount, faceCount] = arrays.map(({ length }) => length / 3); // now: the module's own arrays are empty once its memory grows
        return core.withCopies(arrays, (v, f) => new Mesh(core, core.make('echinus_mesh_create', v, vertexCount, 0, f, faceCount)));
    }
    static fromPolygons(core, vertices, corners, cornerCounts) {
        const arrays = [asVertices(vertices), asIndices(corners, 'corners', 1), asIndices(cornerCounts, 'corner counts', 1)];
        const [coordinateCount, cornerCount, polygonCount] = arrays.map(({ length }) => length);
        return core.withCopies(arrays, (v, c, n) =>
            new Mesh(core, core.make('wasm_mesh_from_polygons', v, coordinateCount / 3, c, cornerCount, n, polygonCount)));
    }
    static fromBytes(core, bytes, name) {
        if (typeof name !== 'string') refuse('the name of the file is required; its extension gives the format');
        const data = asBytes(bytes);
        return core.withTexts([name], (n) =>
            core.withCopies([data], (b) => new Mesh(core, core.make('wasm_mesh_from_bytes', b, data.length, n))));
    }
    static torus(core, majorRadius, minorRadius, majorSegments, minorSegments) {
        requireCount(majorSegments, 'majorSegments');
        requireCount(minorSegments, 'minorSegments');
        return new Mesh(core, core.make('echinus_mesh_torus', majorRadius, minorRadius, majorSegments, minorSegments));
    }
    static sphere(core, radius, meridianCount, parallelCount) {
        requireCount(meridianCount, 'meridianCount');
        requireCount(parallelCount, 'parallelCount');
        return new Mesh(core, core.make('echinus_mesh_sphere', radius, meridianCount, parallelCount));
    }
    static box(core, size, segments) {
        requirePoint(size, 'the size of a box');
        requireCount(segments, 'segments');
        return new Mesh(core, core.make('echinus_mesh_box', ...core.vectorsAt(size), segments));
    }

    get vertexCount() {
        return this.core.call('echinus_mesh_vertex_count', this.address);
    }
    get faceCount() {
        return this.core.call('echinus_mesh_face_count', this.address);
    }
    /** Copies. */
    get vertices() {
        return this.core.copyFloats(this.core.call('echinus_mesh_vertices', this.address), 3 * this.vertexCount);
    }
    get origin() {
        return this.core.copyDoubles(this.core.call('echinus_mesh_origin', this.address), 3);
    }
    get faces() {
        return this.core.copyWords(this.core.call('echinus_mesh_faces', this.address), 3 * this.faceCount);
    }

    report() {
        const { closed, manifold, orientable, centre, radius, ...report } = this.core.ask(meshReport, 'echinus_mesh_inspect', this.address);
        for (const name of FAULTS) report[name] = { count: report[name].count, firstFaces: report[name].firstFaces.slice(0, report[name].firstFaceCount) };
        return { ...report, closed: closed !== 0, manifold: manifold !== 0, orientable: orientable !== 0, boundingSphere: { centre, radius } };
    }

    faults() {
        const lists = this.core.makeAll(FAULTS.length, 'wasm_mesh_faults', this.address);
        return Object.fromEntries(FAULTS.map((name, which) => [name, this.core.copyArray(lists[which])]));
    }

    intersectingPairs(other) {
        return this.core.copyArray(this.core.make('echinus_mesh_intersecting_pairs', this.address, requireOwn(this.core, other, Mesh)), Uint32Array, 2);
    }
    selfIntersectingPairs() {
        return this.core.copyArray(this.core.make('echinus_mesh_self_intersecting_pairs', this.address), Uint32Array, 2);
    }

    intersections(other) {
        const { core } = this;
        const [pairs, curves, points] = core.makeAll(3, 'echinus_mesh_intersections', this.address, other === undefined ? 0 : requireOwn(core, other, Mesh));
        const found = { pairs: core.copyArray(pairs, Uint32Array, 2), curves: [] };
        const [sizes, positions] = [core.copyArray(curves, Uint32Array, 2), core.copyArray(points, Float32Array, 3)];
        for (let i = 0, at = 0; i < sizes.length; i += 2) {
            found.curves.push({ points: positions.slice(at, at + 3 * sizes[i]), closed: sizes[i + 1] !== 0 });
            at += 3 * sizes[i];
        }
        return found;
    }

    static check(core, meshes) {
        const addresses = Uint32Array.from(meshes, (mesh) => requireOwn(core, mesh, Mesh));
        const array = core.withCopies([addresses], (list) => core.make('echinus_check', list, addresses.length, 1));
        const first = core.call('echinus_array_data', array) >>> 0;
        const found = Array.from({ length: core.call('echinus_array_count', array) }, (_, i) => core.read(checkedMeshes, first + i * checkedMeshes.bytes));
        core.call('echinus_array_destroy', array);
        return found.map(({ aInB, bInA, ...both }) => ({ ...both, aInB: penetrationOf(aInB), bInA: penetrationOf(bInA) }));
    }

    part(models = [], { thickness = 0, pinned, layers } = {}) {
        const { core } = this;
        const addresses = Uint32Array.from(models, (model) => requireOwn(core, model, Mesh));
        const lists = Object.entries({ pinned, layers }).map(([name, list]) => this.#bytesOf(list, name));
        return core.withCopies([addresses, ...lists], (list, pins, numbers) =>
            core.withStruct(partReport, {}, (report) => {
                const given = (bytes, address) => (bytes.length > 0 ? address : 0);
                core.do('echinus_mesh_part', this.address, list, addresses.length, given(lists[0], pins), given(lists[1], numbers), thickness, 1, core.scratch, report);
                return { mesh: new Mesh(core, core.views.words[core.scratch >>> 2]), report: core.read(partReport, report) };
            }));
    }
    #bytesOf(list, name) {
        if (list === undefined) return new Uint8Array();
        if (list.length !== this.vertexCount) refuse(`${name} has ${list.length} entries; it needs one for each of the ${this.vertexCount} vertices`);
        return Uint8Array.from(list);
    }

    weld() {
        return new Mesh(this.core, this.core.make('echinus_mesh_weld', this.address));
    }

    repair(words = Object.keys(repairs)) {
        const { core } = this;
        for (const word of words) if (!Object.keys(repairs).includes(word)) refuse(`there is no repair '${word}'; there are ${Object.keys(repairs).join(', ')}`);
        const steps = Object.fromEntries(words.map((word) => [repairs[word], 1]));
        return core.withOptions('echinus_repair_options_init', repairOptions, steps, (options) =>
            core.withStruct(repairReport, {}, (report) => {
                const [mesh, dropped] = [core.scratch, core.scratch + 4];
                core.do('echinus_mesh_repair', this.address, options, mesh, report, dropped);
                const [repaired, droppedFaces] = [mesh, dropped].map((place) => core.views.words[place >>> 2]);
                return { mesh: new Mesh(core, repaired), report: { ...core.read(repairReport, report), droppedFaces: core.copyArray(droppedFaces) } };
            }));
    }

    windingNumber(point) {
        return this.#numberAt(point, 'echinus_mesh_winding_number');
    }
    unsignedDistance(point) {
        return this.#numberAt(point, 'echinus_mesh_unsigned_distance');
    }
    #numberAt(point, name) {
        this.core.do(name, this.address, ...this.core.vectorsAt(requirePoint(point, 'the point')), this.core.scratch);
        return this.core.copyDoubles(this.core.scratch, 1)[0];
    }
}

function penetrationOf({ known, vertexCount, deepestVertex, depth }) {
    return known ? { vertexCount, deepestVertex: vertexCount ? deepestVertex : null, depth } : null;
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
