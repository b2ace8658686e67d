/** Echinus for JavaScript: docs/wasm.md explains it, echinus.d.ts is the contract. */
import { ContactBuffer, FlagBuffer, PointBuffer } from './buffers.mjs';
import { Collision } from './collision.mjs';
import { Core } from './core.mjs';
import { EchinusError, refuse } from './errors.mjs';
import { DistanceMap, ExactMap, buildMap, loadMap } from './maps.mjs';
import { Mesh } from './mesh.mjs';
import { Scene, Simulation } from './simulation.mjs';

export { Collision, ContactBuffer, DistanceMap, EchinusError, ExactMap, FlagBuffer, Mesh, PointBuffer, Scene, Simulation };

// The smallest modules that need a vector instruction (i8x16.splat) and a handler of exceptions (try, catch_all).
const MAGIC = [0, 97, 115, 109, 1, 0, 0, 0];
const VECTORS = [...MAGIC, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 8, 1, 6, 0, 65, 0, 253, 15, 11];
const EXCEPTIONS = [...MAGIC, 1, 4, 1, 96, 0, 0, 3, 2, 1, 0, 10, 8, 1, 6, 0, 6, 64, 25, 11, 11];

/** The features that the host lacks to run this module: an empty array when it lacks none. */
export function missingFeatures() {
    if (typeof WebAssembly !== 'object') return ['WebAssembly'];
    const lacks = (bytes) => !WebAssembly.validate(new Uint8Array(bytes));
    return [...(lacks(VECTORS) ? ['WebAssembly SIMD'] : []), ...(lacks(EXCEPTIONS) ? ['WebAssembly exceptions'] : [])];
}

/** Loads echinus.wasm from beside this file, or from `source`. */
export async function load(source = new URL('./echinus.wasm', import.meta.url)) {
    const missing = missingFeatures();
    if (missing.length > 0) throw new EchinusError('Unsupported', `this browser lacks ${missing.join(' and ')}, which Echinus needs`);
    return new Echinus(await Core.start(await compile(await source)));
}

/** Whatever is wrong with the module or its address. */
async function compile(source) {
    try {
        return await compileAny(source);
    } catch (error) {
        if (error instanceof EchinusError) throw error;
        throw new EchinusError('Unreadable', `echinus.wasm cannot be loaded: ${error.message}`, { cause: error });
    }
}

async function compileAny(source) {
    if (source instanceof WebAssembly.Module) return source;
    if (typeof Response === 'function' && source instanceof Response) return compileResponse(source);
    if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return WebAssembly.compile(source);
    return compileResponse(await fetch(source));
}

async function compileResponse(response) {
    if (!response.ok) throw new EchinusError('Unreadable', `${response.url}: the server answers with status ${response.status}`);
    // A response with an unknown content type cannot be compiled while it streams.
    const streams = response.headers.get('content-type')?.startsWith('application/wasm');
    return streams ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
}

/** One instance of the module: makes everything else. */
export class Echinus {
    #core;

    constructor(core) {
        if (!(core instanceof Core)) refuse('only load() makes instances');
        this.#core = core;
    }

    get memoryByteCount() {
        return this.#core.memory.buffer.byteLength;
    }
    get instructionSet() {
        return this.#core.textOf('echinus_instruction_set');
    }
    set instructionSet(name) {
        this.#core.withTexts([String(name)], (text) => this.#core.do('echinus_use_instruction_set', text));
    }

    makePoints(length) {
        return new PointBuffer(this.#core, length);
    }
    makeFlags(length) {
        return new FlagBuffer(this.#core, length);
    }
    makeContacts(length) {
        return new ContactBuffer(this.#core, length);
    }

    makeMesh(vertices, faces) {
        return Mesh.fromArrays(this.#core, vertices, faces);
    }
    makeMeshFromPolygons(vertices, corners, cornerCounts) {
        return Mesh.fromPolygons(this.#core, vertices, corners, cornerCounts);
    }
    readMesh(bytes, name) {
        return Mesh.fromBytes(this.#core, bytes, name);
    }
    makeTorus(majorRadius, minorRadius, majorSegments, minorSegments) {
        return Mesh.torus(this.#core, majorRadius, minorRadius, majorSegments, minorSegments);
    }
    makeSphere(radius, meridianCount, parallelCount) {
        return Mesh.sphere(this.#core, radius, meridianCount, parallelCount);
    }
    makeBox(size, segments = 1) {
        return Mesh.box(this.#core, size, segments);
    }

    check(meshes) {
        return Mesh.check(this.#core, meshes);
    }

    buildMap(mesh, options = {}) {
        return buildMap(this.#core, mesh, options);
    }
    loadMap(bytes, name = 'the map') {
        return loadMap(this.#core, bytes, name);
    }

    makeCollision(options) {
        return new Collision(this.#core, options);
    }

    parseScene(scene, name = 'the scene') {
        return new Scene(this.#core, scene, name);
    }
}
