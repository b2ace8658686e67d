import { Handle } from './core.mjs';
import { EchinusError, refuse, requireCount, requireFinite, withDefaults } from './errors.mjs';
import { requireMap } from './maps.mjs';
import { asIndices, asVertices } from './mesh.mjs';
import { collider, deformableArrays, particleCollisionOptions, pose, surfaceCollisionOptions } from './structs.mjs';

const NO_TURN = [1, 0, 0, 0];

/** Keeps particles that another solver moves out of models. */
export class Collision extends Handle {
    #views = { buffer: null };

    constructor(core, options) {
        const all = complete(options);
        const particleCount = all.positions.length / 3; // now: see Mesh.fromArrays
        super(core, inOwnWords(() => make(core, all)), 'wasm_collision_delete');
        Object.defineProperty(this, 'particleCount', { value: particleCount, enumerable: true });
        Object.defineProperty(this, 'colliderCount', { value: all.colliders.length, enumerable: true });
    }

    // Views of the module's memory: see Buffer in buffers.mjs.
    get #arrays() {
        const { address } = this;
        const { buffer } = this.core.memory;
        if (this.#views.buffer !== buffer) {
            const at = (name) => this.core.call(name, address) >>> 0;
            this.#views = {
                buffer,
                positions: new Float32Array(buffer, at('wasm_collision_positions'), 3 * this.particleCount),
                velocities: new Float32Array(buffer, at('wasm_collision_velocities'), 3 * this.particleCount),
            };
        }
        return this.#views;
    }
    get positions() {
        return this.#arrays.positions;
    }
    get velocities() {
        return this.#arrays.velocities;
    }
    get corrected() {
        const { address } = this;
        return new Uint32Array(this.core.memory.buffer, this.core.call('wasm_collision_corrected', address) >>> 0, this.#correctedCount);
    }
    get unresolvedCount() {
        return this.core.call('wasm_collision_unresolved_count', this.address);
    }
    get #correctedCount() {
        return this.core.call('wasm_collision_corrected_count', this.address) >>> 0;
    }

    setColliderPose(index, position, rotation = NO_TURN) {
        requireCount(index, 'the collider');
        const place = { translation: Array.from(requireFinite(position, 'the position')), rotation: Array.from(requireRotation(rotation)) };
        this.core.withStruct(pose, place, (address) => this.core.do('wasm_collision_set_pose', this.address, index, address));
    }

    correct(seconds) {
        if (!(seconds > 0 && seconds < Infinity)) refuse(`the step takes ${String(seconds)} seconds; it must be a finite number above 0`);
        this.core.do('wasm_collision_correct', this.address, seconds);
        return this.#correctedCount;
    }
}

/** Those from friction on are members of the library's structs, whose defaults bindings/options.toml has. */
const DEFAULTS = {
    positions: undefined, faces: [], colliders: undefined, thickness: undefined, surfaces: false,
    friction: undefined, selfThickness: undefined, selfCollision: undefined, allowOpenColliders: undefined, untangle: undefined,
};
const OF_SURFACES = ['selfThickness', 'selfCollision', 'untangle'];
const COLLIDER_DEFAULTS = { map: undefined, position: [0, 0, 0], rotation: NO_TURN, scale: 1 };

/** The options with all their defaults, checked as far as C++ does not. */
function complete(options) {
    const all = withDefaults(options, DEFAULTS, 'an option of a collision');
    if (!Array.isArray(all.colliders) || all.colliders.length === 0) refuse('colliders must be an array of at least one collider');
    const isGiven = (name) => all[name] !== undefined;
    for (const name of ['thickness', ...['friction', 'selfThickness'].filter(isGiven)]) if (!(Number.isFinite(all[name]) && all[name] >= 0)) refuse(`${name} is ${String(all[name])}; it must be a number, not negative`);
    for (const name of ['surfaces', 'selfCollision', 'allowOpenColliders', 'untangle'].filter(isGiven)) if (typeof all[name] !== 'boolean') refuse(`${name} must be true or false`);
    const colliders = all.colliders.map((given) => {
        const placed = withDefaults(given, COLLIDER_DEFAULTS, 'a key of a collider');
        const scale = typeof placed.scale === 'number' ? Array(3).fill(placed.scale) : placed.scale;
        return {
            map: placed.map,
            pose: {
                translation: Array.from(requireFinite(placed.position, 'the position of a collider')),
                rotation: Array.from(requireRotation(placed.rotation)),
            },
            scale: Array.from(requireFinite(scale, 'the scale of a collider')),
        };
    });
    const faces = asIndices(all.faces, 'faces', 3);
    for (const name of OF_SURFACES) if (all[name] && !all.surfaces) refuse(`${name} needs surfaces: set both`);
    if (all.surfaces && faces.length === 0) refuse('surfaces collide where there are faces: give the faces of the deformable, three particles each');
    return { ...all, positions: asVertices(all.positions), faces, colliders };
}

/** The library's name of an option, such as self_thickness, as it is here. */
const ownName = (word) => word.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());

/** Calls `make`, whose errors name options. */
function inOwnWords(make) {
    try {
        return make();
    } catch (error) {
        if (!(error instanceof EchinusError)) throw error;
        throw new EchinusError(error.code, error.message.replace(/\w+/g, (word) => (ownName(word) in DEFAULTS ? ownName(word) : word)));
    }
}

function requireRotation(rotation) {
    if (rotation?.length !== 4 || !Array.prototype.every.call(rotation, Number.isFinite)) refuse('a rotation must be four finite numbers: w, x, y, z');
    return rotation;
}

/** Of all options those that were given and are members of a struct. */
const givenOf = (struct, all) => Object.fromEntries(Object.keys(struct.members).filter((name) => all[name] !== undefined).map((name) => [name, all[name]]));

function make(core, all) {
    const { positions, faces, colliders, thickness, surfaces } = all;
    if (positions.length === 0) refuse('there are no particles');
    const counts = { particleCount: positions.length / 3, faceCount: faces.length / 3 };
    const maps = colliders.map(({ map }) => requireMap(core, map));
    const deformable = core.withCopies([positions, faces], (p, f) =>
        core.withStruct(deformableArrays, { ...counts, positions: p, faces: f }, (arrays) => core.make('echinus_deformable_create', arrays)));
    try {
        return core.withMemory(collider.bytes * colliders.length, (row) => {
            colliders.forEach(({ pose, scale }, i) => {
                core.call('echinus_collider_init', row + collider.bytes * i, collider.bytes, maps[i]);
                core.write(collider, row + collider.bytes * i, { pose, scale });
            });
            const [maker, init, struct] = surfaces
                ? ['wasm_collision_make_surfaces', 'echinus_surface_collision_options_init', surfaceCollisionOptions]
                : ['wasm_collision_make', 'echinus_particle_collision_options_init', particleCollisionOptions];
            return core.withOptions(init, struct, givenOf(struct, all), (options) => core.make(maker, deformable, row, colliders.length, thickness, options));
        });
    } finally {
        core.call('echinus_deformable_destroy', deformable);
    }
}
