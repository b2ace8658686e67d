import { ContactBuffer, FlagBuffer, requireWithin, withPoints } from './buffers.mjs';
import { Handle, requireOwn, textOf } from './core.mjs';
import { requireCount, requireFinite, withDefaults } from './errors.mjs';
import { asJson, requireMap, wrapMap } from './maps.mjs';
import { Mesh } from './mesh.mjs';
import { collider, contactPoint, deformableArrays, simulationProfile } from './structs.mjs';

/** A validated scene. */
export class Scene extends Handle {
    constructor(core, json, name) {
        super(core, core.withTexts([asJson(json), name], (...texts) => core.make('echinus_scene_parse', ...texts)), 'echinus_scene_destroy');
        const [[frameLimit, timeStep, particleCount], ...texts] = core.lists('wasm_scene_describe', this.address);
        const [modelFile, clothFile, clothRestFile, ...repair] = texts.map((bytes) => textOf(bytes) || null);
        Object.assign(this, { modelFile, repair, frameLimit, timeStep, clothFile, clothRestFile, particleCount: Number.isNaN(particleCount) ? null : particleCount });
    }

    makeModel() {
        return new Mesh(this.core, this.core.make('wasm_scene_make_model', this.address));
    }
    buildMap(mesh) {
        return wrapMap(this.core, this.core.make('wasm_scene_build_map', this.address, requireOwn(this.core, mesh, Mesh)));
    }
    makeSimulation(maps, options = {}) {
        const { allowOpenCollider, cloth, clothAtRest, bodies } = withDefaults(options, SIMULATION_DEFAULTS, 'an option of a simulation');
        const mesh = (own) => (own === null ? 0 : requireOwn(this.core, own, Mesh));
        const addresses = [addressesOf(this.core, [maps].flat()), Uint32Array.from(bodies, mesh)];
        const [mapCount, bodyCount] = addresses.map(({ length }) => length);
        const given = [allowOpenCollider ? 1 : 0, mesh(cloth), mesh(clothAtRest)];
        return this.core.withCopies(addresses, (mapsAt, bodiesAt) =>
            new Simulation(this.core, this.core.make('wasm_scene_make_simulation', this.address, mapsAt, mapCount, ...given, bodiesAt, bodyCount)));
    }
}

const SIMULATION_DEFAULTS = { allowOpenCollider: false, cloth: null, clothAtRest: null, bodies: [] };

const addressesOf = (core, maps) => Uint32Array.from(maps, (map) => requireMap(core, map));

export class Simulation extends Handle {
    #positions = null;
    #velocities = null;

    constructor(core, address) {
        super(core, address, 'echinus_simulation_destroy');
        Object.defineProperty(this, 'particleCount', { value: core.call('echinus_simulation_particle_count', address), enumerable: true });
    }

    /** Continues with the options of another scene; particles and colliders keep their state. */
    continueWith(scene, maps = []) {
        const own = requireOwn(this.core, scene, Scene);
        const addresses = addressesOf(this.core, [maps].flat());
        return this.core.withCopies([addresses], (mapsAt) =>
            new Simulation(this.core, this.core.make('wasm_simulation_continue', this.address, own, mapsAt, addresses.length)));
    }

    step(frameCount = 1) {
        requireCount(frameCount, 'the number of frames');
        for (let i = 0; i < frameCount; ++i) this.core.do('echinus_simulation_step', this.address);
    }

    // Views of the simulation's own memory: see Buffer in buffers.mjs.
    get positions() {
        const { address } = this;
        if (this.#positions?.buffer !== this.core.memory.buffer) this.#positions = this.#view(this.core.call('echinus_simulation_positions', address));
        return this.#positions;
    }
    get velocities() {
        const { address } = this;
        if (this.#velocities?.buffer !== this.core.memory.buffer)
            this.#velocities = this.#view(this.core.ask(deformableArrays, 'echinus_simulation_read', address).velocities);
        return this.#velocities;
    }
    #view(first) {
        return new Float32Array(this.core.memory.buffer, first >>> 0, 3 * this.particleCount);
    }

    /** A copy: three particles for each face. */
    get faces() {
        const { faces, faceCount } = this.core.ask(deformableArrays, 'echinus_simulation_read', this.address);
        return this.core.copyWords(faces, 3 * faceCount);
    }
    get frame() {
        return this.core.call('echinus_simulation_frame', this.address);
    }
    get atRest() {
        return this.core.call('echinus_simulation_at_rest', this.address) !== 0;
    }
    get largestSpeed() {
        return this.core.call('echinus_simulation_largest_speed', this.address);
    }
    get stateHash() {
        return BigInt.asUintN(64, this.core.call('echinus_simulation_state_hash', this.address)).toString(16).padStart(16, '0');
    }
    get residual() {
        const { core } = this;
        core.do('echinus_simulation_residual', this.address, core.scratch, core.scratch + 8);
        const [rootMeanSquare, largest] = core.copyDoubles(core.scratch, 2);
        return { rootMeanSquare, largest };
    }
    get profile() {
        return this.core.ask(simulationProfile, 'echinus_simulation_read_profile', this.address);
    }

    get colliderCount() {
        return this.core.call('echinus_simulation_collider_count', this.address);
    }
    get collider() {
        return this.colliderAt(0);
    }
    colliderAt(index) {
        const { pose, scale, linearVelocity, angularVelocity } = this.#withCollider(index, (address) => this.core.read(collider, address));
        return { position: pose.translation, rotation: pose.rotation, scale, linearVelocity, angularVelocity };
    }
    setColliderVelocity(linear, angular, index = 0) {
        requireFinite(linear, 'the linear velocity');
        requireFinite(angular, 'the angular velocity');
        this.core.do('echinus_simulation_set_collider_velocity', this.address, requireCount(index, 'the collider'), ...this.core.vectorsAt(linear, angular));
    }
    setColliderFree(mass, index = 0) {
        this.core.do('echinus_simulation_set_collider_free', this.address, requireCount(index, 'the collider'), mass);
    }
    loadOn(index = 0) {
        const { core } = this;
        core.do('echinus_simulation_load_on', this.address, requireCount(index, 'the collider'), core.scratch, core.scratch + 24);
        const numbers = core.copyDoubles(core.scratch, 6);
        return { force: numbers.slice(0, 3), torque: numbers.slice(3) };
    }
    recordContacts(isOn = true) {
        this.core.do('echinus_simulation_record_contacts', this.address, isOn ? 1 : 0);
    }
    get contactPoints() {
        const { bytes, members } = contactPoint;
        const all = this.core.copyArray(this.core.make('echinus_simulation_contact_points', this.address), Uint8Array, bytes).buffer;
        const count = all.byteLength / bytes;
        const column = (name, ArrayKind) => {
            const [offset, , width = 1] = members[name];
            const result = new ArrayKind(width * count);
            for (let i = 0; i < count; ++i) result.set(new ArrayKind(all, i * bytes + offset, width), i * width);
            return result;
        };
        return {
            positions: column('position', Float64Array),
            normals: column('normal', Float64Array),
            gaps: column('gap', Float64Array),
            normalImpulses: column('normalImpulse', Float64Array),
            frictionImpulses: column('frictionImpulse', Float64Array),
            colliders: column('collider', Int32Array),
            particles: column('particles', Int32Array),
        };
    }
    setColliderVertices(vertices, index = 0) {
        requireCount(index, 'the collider');
        withPoints(this.core, vertices, undefined, (at, count) => this.core.do('echinus_simulation_set_collider_vertices', this.address, index, at, count, 0));
    }
    /** Calls `use` with the address of a collider in its present pose. */
    #withCollider(index, use) {
        requireCount(index, 'the collider');
        return this.core.withStruct(collider, {}, (address) => {
            this.core.do('echinus_simulation_read_collider', this.address, index, address);
            return use(address);
        });
    }

    setParticleVelocity(particle, velocity) {
        requireCount(particle, 'the particle');
        this.core.do('echinus_simulation_set_particle_velocity', this.address, particle, ...this.core.vectorsAt(requireFinite(velocity, 'the velocity')));
    }
    blow(wind, rate) {
        this.core.do('echinus_simulation_blow', this.address, ...this.core.vectorsAt(requireFinite(wind, 'the wind')), rate);
    }

    containsBatch(inside) {
        const flags = requireOwn(this.core, inside, FlagBuffer);
        requireWithin(this.particleCount, inside.length, 'answers');
        this.#withCollider(0, (first) =>
            this.core.do('echinus_collider_contains', first, this.core.call('echinus_simulation_positions', this.address), this.particleCount, 0, 1, flags));
        return inside;
    }
    contactsBatch(margin, contacts) {
        const results = requireOwn(this.core, contacts, ContactBuffer);
        requireWithin(this.particleCount, contacts.length, 'contacts');
        this.#withCollider(0, (first) =>
            this.core.do('echinus_collider_contacts', first, this.core.call('echinus_simulation_positions', this.address), this.particleCount, 0, margin, 1, results));
        return contacts;
    }
}
