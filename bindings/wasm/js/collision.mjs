import { Handle } from './core.mjs';
import { EchinusError, refuse, requireFinite, withDefaults } from './errors.mjs';
import { requireMap } from './maps.mjs';
import { asIndices, asVertices } from './mesh.mjs';

const NO_TURN = [1, 0, 0, 0];

/** Keeps particles that another solver moves out of models. */
export class Collision extends Handle {
    #views = { buffer: null };

    constructor(core, options) {
        const { positions, faces, ...rest } = complete(options);
        const [particleCount, faceCount] = [positions, faces].map(({ length }) => length / 3); // now: see Mesh.fromArrays
        super(core, core.withCopies([positions, faces, mapsOf(core, rest.colliders)], (p, f, m) =>
            core.withTexts([JSON.stringify(rest, withoutMaps)], (...text) =>
                inOwnWords(() => core.try('collision_make', p, particleCount, f, faceCount, m, rest.colliders.length, ...text)))), 'collision_delete');
        Object.defineProperty(this, 'particleCount', { value: particleCount, enumerable: true });
        Object.defineProperty(this, 'colliderCount', { value: rest.colliders.length, enumerable: true });
    }

    // Views of the module's memory: see Buffer in buffers.mjs.
    get #arrays() {
        const { address } = this;
        const { buffer } = this.core.memory;
        if (this.#views.buffer !== buffer) {
            const at = (name) => this.core.call(name, address) >>> 0;
            this.#views = {
                buffer,
                positions: new Float32Array(buffer, at('collision_positions'), 3 * this.particleCount),
                velocities: new Float32Array(buffer, at('collision_velocities'), 3 * this.particleCount),
                corrected: new Uint32Array(buffer, at('collision_corrected'), this.particleCount),
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
        return this.#arrays.corrected.subarray(0, this.core.call('collision_corrected_count', this.address));
    }
    get squeezedCount() {
        return this.core.call('collision_squeezed_count', this.address);
    }

    setColliderPose(collider, position, rotation = NO_TURN) {
        if (!(Number.isInteger(collider) && collider >= 0 && collider < this.colliderCount))
            refuse(`there is no collider ${String(collider)}; there are ${this.colliderCount}`);
        this.core.try('collision_set_pose', this.address, collider, ...requireFinite(position, 'the position'), ...requireRotation(rotation));
    }

    correct(seconds) {
        if (!(seconds > 0 && seconds < Infinity)) refuse(`the step takes ${String(seconds)} seconds; it must be a finite number above 0`);
        this.core.try('collision_correct', this.address, seconds);
        return this.core.call('collision_corrected_count', this.address);
    }
}

const DEFAULTS = { positions: undefined, faces: [], colliders: undefined, thickness: undefined, friction: 0.5, surfaces: false, selfCollision: false, allowOpenColliders: false, untangle: false };
const COLLIDER_DEFAULTS = { map: undefined, position: [0, 0, 0], rotation: NO_TURN, scale: 1 };

/** The options with all their defaults, checked as far as C++ does not. */
function complete(options) {
    const all = withDefaults(options, DEFAULTS, 'an option of a collision');
    if (!Array.isArray(all.colliders) || all.colliders.length === 0) refuse('colliders must be an array of at least one collider');
    for (const name of ['thickness', 'friction']) if (!Number.isFinite(all[name])) refuse(`${name} is ${String(all[name])}; it must be a number`);
    for (const name of ['surfaces', 'selfCollision', 'allowOpenColliders', 'untangle']) if (typeof all[name] !== 'boolean') refuse(`${name} must be true or false`);
    const colliders = all.colliders.map((given) => {
        const collider = withDefaults(given, COLLIDER_DEFAULTS, 'a key of a collider');
        const scale = typeof collider.scale === 'number' ? Array(3).fill(collider.scale) : collider.scale;
        return {
            map: collider.map,
            position: Array.from(requireFinite(collider.position, 'the position of a collider')),
            rotation: Array.from(requireRotation(collider.rotation)),
            scale: Array.from(requireFinite(scale, 'the scale of a collider')),
        };
    });
    const faces = asIndices(all.faces, 'faces', 3);
    if (all.surfaces && faces.length === 0) refuse('surfaces collide where there are faces: give the faces of the deformable, three particles each');
    return { ...all, positions: asVertices(all.positions), faces, colliders };
}

/** The library's names of options, and those that they have here. */
const OWN_NAMES = { surface_collision: 'surfaces', self_collision: 'selfCollision', allow_open_colliders: 'allowOpenColliders' };

/** Calls `make`, whose errors name options. */
function inOwnWords(make) {
    try {
        return make();
    } catch (error) {
        if (!(error instanceof EchinusError)) throw error;
        throw new EchinusError(error.code, error.message.replace(/\w+/g, (word) => OWN_NAMES[word] ?? word));
    }
}

function requireRotation(rotation) {
    if (rotation?.length !== 4 || !Array.prototype.every.call(rotation, Number.isFinite)) refuse('a rotation must be four finite numbers: w, x, y, z');
    return rotation;
}

const mapsOf = (core, colliders) => Uint32Array.from(colliders, ({ map }) => requireMap(core, map));
const withoutMaps = (key, value) => (key === 'map' ? undefined : value);
