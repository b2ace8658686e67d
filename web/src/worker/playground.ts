import type { AnyMap, ContactBuffer, Echinus, ExactMap, Mesh, MeshFaults, MeshReport, Scene, Simulation, SimulationProfile } from 'echinus';
import { AXES, type Axis, UNIT, furthestAlong } from '../axes';
import type { FrameArrays, Figures, MapNews, ModelNews, Triple } from '../protocol';
import type { Settings } from '../settings';
import { type Body, columnsOf, sceneFor, thicknessOf } from './cloth_scene';
import { measureDepths } from './depth';
import { Hand } from './hand';
import { Judge } from './judge';
import { Maps } from './maps';
import type { Model } from './models';
import { motionAt } from './motion';
import { sheetNormals } from './normals';

/**
 * How long one frame may simulate: most of the time between frames, so that a slow display does not slow the cloth.
 * Beyond that the cloth falls more slowly than in reality, rather than jerkily.
 */
const FRAME_BUDGET_MS = { least: 14, most: 100, share: 0.85 };

/** One model, its maps, and the cloth on it. Everything it makes lives in the module's memory until delete(). */
export class Playground {
    readonly hand = new Hand();
    readonly body: Body;

    readonly #echinus: Echinus;
    readonly #name: string;
    readonly #mesh: Mesh;
    readonly #report: MeshReport;
    readonly #faults: MeshFaults;
    #mendedFaces = 0;
    #flippedParts = 0;

    readonly #maps: Maps;

    #settings: Settings;
    #scene!: Scene;
    #simulation!: Simulation;
    #clothMap!: AnyMap;
    #judge!: Judge;
    #contacts!: ContactBuffer;
    /** Frames of the simulations before the present one, whose count restarts after continueWith(). */
    #earlierFrames = 0;
    #owedSeconds = 0;
    #lastMs = 0;

    /** Takes ownership of the model's mesh. @throws EchinusError when no map of it, or no cloth on it, is possible */
    constructor(echinus: Echinus, model: Model, settings: Settings) {
        this.#echinus = echinus;
        this.#settings = settings;
        this.#name = model.name;
        this.#mesh = settings.mend ? this.#mend(model.mesh) : model.mesh;
        this.#report = this.#mesh.report();
        this.#faults = this.#mesh.faults();
        const up = settings.up === 'auto' ? model.up : settings.up;
        this.#maps = new Maps(echinus, this.#mesh, up, settings);
        this.body = bodyOf(this.#mesh, this.#maps.exact, up);
        this.restart();
    }

    delete(): void {
        this.#dropCloth();
        this.#maps.delete();
        this.#mesh.delete();
    }

    get columns(): number {
        return columnsOf(this.#settings.particles);
    }
    get faces(): Uint32Array {
        return this.#simulation.faces;
    }
    get map(): AnyMap {
        return this.#maps.by(this.#settings).map;
    }
    get mapNews(): MapNews {
        return this.#maps.by(this.#settings).news;
    }
    get exactMap(): ExactMap {
        return this.#maps.exact;
    }
    get settings(): Settings {
        return this.#settings;
    }

    news(): ModelNews {
        return {
            name: this.#name,
            vertices: this.#mesh.vertices,
            faces: this.#mesh.faces,
            report: this.#report,
            faults: this.#faults,
            mendedFaces: this.#mendedFaces,
            flippedParts: this.#flippedParts,
            centre: [...this.exactMap.centre] as Triple,
            radius: this.exactMap.radius,
            up: this.body.up,
            map: this.mapNews,
        };
    }

    /** @returns whether the cloth started anew */
    change(settings: Settings): boolean {
        const before = this.#settings;
        this.#settings = settings;
        try {
            return this.#follow(settings, before);
        } catch (error) {
            this.#settings = before; // the previous state continues
            throw error;
        }
    }

    #follow(settings: Settings, before: Settings): boolean {
        if (this.#maps.by(settings).map !== this.#clothMap || settings.particles !== before.particles) {
            this.restart();
            return true;
        }
        const keys = ['friction', 'thickness', 'surfaces', 'self'] as const;
        if (keys.every((key) => settings[key] === before[key])) return false;
        try {
            this.#continue();
            return false;
        } catch (error) {
            if (!settings.surfaces) throw error;
            this.restart(); // layers that have passed through each other cannot always be parted
            return true;
        }
    }

    /** Builds the map in use once more: during the very first build, the host's code is not yet optimised. */
    rebuild(): MapNews {
        const { map, news } = this.#maps.build(this.#settings);
        map.delete(); // the same bytes as the one in use
        return news;
    }

    restart(): void {
        const scene = this.#echinus.parseScene(sceneFor(this.#settings, this.body));
        const { map } = this;
        const simulation = scene.makeSimulation(map, { allowOpenCollider: true });
        this.#dropCloth();
        this.#clothMap = map;
        this.#scene = scene;
        this.#simulation = simulation;
        this.#judge = new Judge(this.#echinus, this.exactMap, simulation.particleCount);
        this.#contacts = this.#echinus.makeContacts(simulation.particleCount);
        this.#earlierFrames = 0;
        this.#owedSeconds = 0;
        this.#lastMs = performance.now();
    }

    /** Makes as many steps as real time requires, within FRAME_BUDGET_MS, and fills the arrays with the result. */
    advance(paused: boolean, arrays: FrameArrays | undefined): { arrays: FrameArrays; figures: Figures } {
        const now = performance.now();
        // A hidden page has not simulated, and need not catch up.
        const elapsed = now - this.#lastMs;
        this.#owedSeconds = Math.min(this.#owedSeconds + 0.001 * elapsed, 0.1);
        this.#lastMs = now;
        const budget = Math.min(FRAME_BUDGET_MS.most, Math.max(FRAME_BUDGET_MS.least, FRAME_BUDGET_MS.share * elapsed));
        const before = this.#simulation.profile;
        let stepCount = 0;
        if (!paused && !this.#rests())
            while (this.#owedSeconds >= this.#scene.timeStep && performance.now() - now < budget) {
                this.#step();
                this.#owedSeconds -= this.#scene.timeStep;
                ++stepCount;
            }
        return this.#look(arrays, before, stepCount, performance.now() - now, paused);
    }

    /** One step, for a cloth that is paused. */
    stepOnce(arrays: FrameArrays | undefined): { arrays: FrameArrays; figures: Figures } {
        const before = this.#simulation.profile;
        const begin = performance.now();
        this.#step();
        return this.#look(arrays, before, 1, performance.now() - begin, true);
    }

    get collider() {
        return this.#simulation.collider;
    }

    grab(particle: number, target: Triple): void {
        if (particle < this.#simulation.particleCount) this.hand.grab(this.#simulation, this.columns, particle, target);
    }

    #step(): void {
        const simulation = this.#simulation;
        const { radius, up } = this.body;
        const frame = this.#earlierFrames + simulation.frame;
        const { linear, angular } = motionAt(this.#settings.motion, UNIT[up], frame * this.#scene.timeStep, this.body.centre, simulation.collider);
        simulation.setColliderVelocity(linear, angular);
        if (this.#settings.wind > 0) simulation.blow(this.#wind(frame), 4);
        this.hand.pull(simulation, this.#scene.timeStep, 12 * radius);
        simulation.step();
    }

    /** From the side, in gusts: a steady wind would hold the cloth like a wall. A function of the frame, so that a link reproduces it. */
    #wind(frame: number): Triple {
        const seconds = frame * this.#scene.timeStep;
        const speed = this.#settings.wind * this.body.radius * (0.75 + 0.25 * Math.sin(2.1 * seconds) * Math.sin(0.8 * seconds));
        const across: Record<Axis, Triple> = { x: [0, 0.94, 0.34], y: [0.34, 0, 0.94], z: [0.94, 0.34, 0] };
        return across[this.body.up].map((part) => speed * part) as Triple;
    }

    /** Nothing moves the cloth any more, so the simulation may stop. */
    #rests(): boolean {
        return this.#simulation.atRest && this.#settings.motion === 'still' && this.#settings.wind === 0 && !this.hand.holds;
    }

    #look(arrays: FrameArrays | undefined, before: SimulationProfile, stepCount: number, ms: number, paused: boolean) {
        const simulation = this.#simulation;
        const filled = fitted(arrays, simulation.particleCount);
        filled.positions.set(simulation.positions);
        sheetNormals(filled.positions, this.columns, filled.normals);
        if (this.#settings.colour === 'depth') measureDepths(simulation, thicknessOf(this.#settings, this.body), this.#contacts, filled.depths);
        const after = simulation.profile;
        const perStep = 1000 / Math.max(1, stepCount);
        const collisionSeconds = after.collisionSeconds - before.collisionSeconds;
        const figures: Figures = {
            frame: this.#earlierFrames + simulation.frame,
            paused,
            atRest: this.#rests(),
            stepMs: stepCount > 0 ? ms / stepCount : 0,
            constraintMs: perStep * (after.constraintSeconds - before.constraintSeconds),
            collisionMs: perStep * collisionSeconds,
            queriesPerSecond: collisionSeconds > 0 ? (after.queryCount - before.queryCount) / collisionSeconds : 0,
            inside: this.#judge.count(filled.positions, simulation.collider),
            stepCount,
        };
        return { arrays: filled, figures };
    }

    #continue(): void {
        const scene = this.#echinus.parseScene(sceneFor(this.#settings, this.body, { falls: true }));
        const simulation = this.#simulation.continueWith(scene);
        this.#earlierFrames += this.#simulation.frame;
        this.#simulation.delete();
        this.#scene.delete();
        this.#scene = scene;
        this.#simulation = simulation;
    }

    #mend(mesh: Mesh): Mesh {
        const { mesh: mended, report } = mesh.repair();
        mesh.delete();
        this.#mendedFaces = report.duplicateFacesDropped.length + report.doubledPatchFacesDropped.length;
        this.#flippedParts = report.componentsFlipped;
        return mended;
    }

    #dropCloth(): void {
        this.hand.release();
        this.#simulation?.delete();
        this.#scene?.delete();
        this.#judge?.delete();
        this.#contacts?.delete();
    }
}

function bodyOf(mesh: Mesh, map: ExactMap, up: Axis): Body {
    return { centre: map.centre, radius: map.radius, up, top: furthestAlong(up, mesh.vertices)[AXES.indexOf(up)] };
}

function fitted(arrays: FrameArrays | undefined, particleCount: number): FrameArrays {
    if (arrays?.depths.length === particleCount) return arrays;
    return {
        positions: new Float32Array(3 * particleCount),
        normals: new Float32Array(3 * particleCount),
        depths: new Float32Array(particleCount),
    };
}
