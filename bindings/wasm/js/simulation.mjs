import { ContactBuffer, FlagBuffer, requireWithin, withPoints } from './buffers.mjs';
import { Handle, requireOwn } from './core.mjs';
import { refuse, requireCount, requireFinite, withDefaults } from './errors.mjs';
import { asJson, requireMap, wrapMap } from './maps.mjs';
import { Mesh } from './mesh.mjs';

/** A validated scene. */
export class Scene extends Handle {
    constructor(core, json, name) {
        super(core, core.withTexts([asJson(json), name], (...texts) => core.try('scene_parse', ...texts)), 'scene_delete');
        Object.assign(this, core.json('scene_describe', this.address));
    }

    makeModel() {
        return new Mesh(this.core, this.core.try('scene_make_model', this.address));
    }
    buildMap(mesh) {
        return wrapMap(this.core, this.core.try('scene_build_map', this.address, requireOwn(this.core, mesh, Mesh)));
    }
    makeSimulation(maps, options = {}) {
        const { allowOpenCollider, cloth, clothAtRest, bodies } = withDefaults(options, SIMULATION_DEFAULTS, 'an option of a simulation');
        const mesh = (own) => (own === null ? 0 : requireOwn(this.core, own, Mesh));
        const addresses = [addressesOf(this.core, [maps].flat()), Uint32Array.from(bodies, mesh)];
        const [mapCount, bodyCount] = addresses.map(({ length }) => length);
        const given = [allowOpenCollider ? 1 : 0, mesh(cloth), mesh(clothAtRest)];
        return this.core.withCopies(addresses, (mapsAt, bodiesAt) =>
            new Simulation(this.core, this.core.try('simulation_make', this.address, mapsAt, mapCount, ...given, bodiesAt, bodyCount)));
    }
}

const SIMULATION_DEFAULTS = { allowOpenCollider: false, cloth: null, clothAtRest: null, bodies: [] };

const addressesOf = (core, maps) => Uint32Array.from(maps, (map) => requireMap(core, map));

export class Simulation extends Handle {
    #positions = null;
    #previousPositions = null;

    constructor(core, address) {
        super(core, address, 'simulation_delete');
        Object.defineProperty(this, 'particleCount', { value: core.call('simulation_particle_count', address), enumerable: true });
    }

    /** Continues with the options of another scene; particles and colliders keep their state. */
    continueWith(scene, maps = []) {
        const own = requireOwn(this.core, scene, Scene);
        const addresses = addressesOf(this.core, [maps].flat());
        return this.core.withCopies([addresses], (mapsAt) =>
            new Simulation(this.core, this.core.try('simulation_continue', this.address, own, mapsAt, addresses.length)));
    }

    step(frameCount = 1) {
        requireCount(frameCount, 'the number of frames');
        this.core.try('simulation_step', this.address, frameCount);
    }

    // Views of the simulation's own memory: see Buffer in buffers.mjs.
    get positions() {
        const address = this.address;
        if (this.#positions?.buffer !== this.core.memory.buffer) this.#positions = this.#view('simulation_positions', address);
        return this.#positions;
    }
    get previousPositions() {
        const address = this.address;
        if (this.#previousPositions?.buffer !== this.core.memory.buffer)
            this.#previousPositions = this.#view('simulation_previous_positions', address);
        return this.#previousPositions;
    }
    #view(name, address) {
        const first = this.core.call(name, address) >>> 0;
        return new Float32Array(this.core.memory.buffer, first, 3 * this.particleCount);
    }

    /** A copy: three particles for each face. */
    get faces() {
        return this.core.copyWords(this.core.call('simulation_faces', this.address), 3 * this.core.call('simulation_face_count', this.address));
    }
    get frame() {
        return this.core.call('simulation_frame', this.address);
    }
    get atRest() {
        return this.core.call('simulation_at_rest', this.address) !== 0;
    }
    get largestSpeed() {
        return this.core.call('simulation_largest_speed', this.address);
    }
    get stateHash() {
        return BigInt.asUintN(64, this.core.call('simulation_state_hash', this.address)).toString(16).padStart(16, '0');
    }
    get residual() {
        return this.core.json('simulation_residual', this.address);
    }
    get profile() {
        return this.core.json('simulation_profile', this.address);
    }

    get colliderCount() {
        return this.core.call('simulation_collider_count', this.address);
    }
    get collider() {
        return this.colliderAt(0);
    }
    colliderAt(index) {
        return this.core.json('simulation_collider', this.address, this.#requireCollider(index));
    }
    setColliderVelocity(linear, angular, index = 0) {
        requireFinite(linear, 'the linear velocity');
        requireFinite(angular, 'the angular velocity');
        this.core.call('simulation_set_collider_velocity', this.address, this.#requireCollider(index), ...linear, ...angular);
    }
    setColliderVertices(vertices, index = 0) {
        const collider = this.#requireCollider(index);
        withPoints(this.core, vertices, undefined, (at, count) => this.core.try('simulation_set_collider_vertices', this.address, collider, at, count));
    }
    #requireCollider(index) {
        requireCount(index, 'the collider');
        if (index >= this.colliderCount) refuse(`there is no collider ${index}; there are ${this.colliderCount}`);
        return index;
    }

    setParticleVelocity(particle, velocity) {
        requireCount(particle, 'the particle');
        if (particle >= this.particleCount) refuse(`there is no particle ${particle}; there are ${this.particleCount}`);
        this.core.call('simulation_set_particle_velocity', this.address, particle, ...requireFinite(velocity, 'the velocity'));
    }
    blow(wind, rate) {
        if (!(rate >= 0 && rate < Infinity)) refuse(`the rate is ${String(rate)}; it must be a finite number, not negative`);
        this.core.try('simulation_blow', this.address, ...requireFinite(wind, 'the wind'), rate);
    }

    containsBatch(inside) {
        const flags = requireOwn(this.core, inside, FlagBuffer);
        requireWithin(this.particleCount, inside.length, 'answers');
        this.core.call('simulation_contains_batch', this.address, flags);
        return inside;
    }
    contactsBatch(margin, contacts) {
        const results = requireOwn(this.core, contacts, ContactBuffer);
        requireWithin(this.particleCount, contacts.length, 'contacts');
        this.core.call('simulation_contacts_batch', this.address, margin, results);
        return contacts;
    }
}
