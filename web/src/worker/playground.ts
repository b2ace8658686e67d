import type { AnyMap, ColliderState, ContactBuffer, Echinus, ExactMap, Mesh, MeshFaults, MeshReport, Scene, Simulation, SimulationProfile } from 'echinus';
import { AXES, type Axis, UNIT, furthestAlong } from '../frames';
import { creasedNormals, sheetNormals, surfaceNormals } from '../normals';
import type { ClothNews, FrameArrays, Figures, MapNews, ModelNews, ModelShape, Stage, Triple } from '../protocol';
import type { Settings } from '../settings';
import type { Act, Garment } from './acts/act';
import { SIZE, sheets } from './acts/sheets';
import { Ball, ballRadius } from './ball';
import { type Body, columnsOf, groundSize, motionAt, sceneFor } from './cloth_scene';
import { Judge, measureDepths } from './judge';
import { Hand, Shake } from './hand';
import { Maps } from './maps';
import type { Model } from './models';

/**
 * How long one frame may simulate: most of the time between frames, so that a slow display does not slow the cloth.
 * Beyond that the cloth falls more slowly than in reality, rather than jerkily.
 */
const FRAME_BUDGET_MS = { least: 14, most: 100, share: 0.85 };

/** Beyond this many faces, creases are left out: they take seconds, and small faces look smooth anyway. */
const CREASED_FACES = 60_000;

/** How far the visitor's hand reaches around the particle that it grabs, in radii. */
const HAND = 0.1;

/** Radii per second, of whatever a visitor holds. */
const FASTEST = 12;

/** The number of the ball among the colliders, after the model and the ground. */
const BALL = 2;

/** A frame, as the page receives it. */
export interface Look {
    arrays: FrameArrays;
    figures: Figures;
    wrong: Uint32Array<ArrayBuffer>;
    ball?: Triple;
    shape?: ModelShape;
}

/** One model, its maps, and the cloth on it. Everything it makes lives in the module's memory until delete(). */
export class Playground {
    readonly hand = new Hand();
    readonly shake = new Shake();
    readonly body: Body;

    readonly #echinus: Echinus;
    readonly #name: string;
    #mesh: Mesh;
    readonly #report: MeshReport;
    readonly #faults: MeshFaults;
    readonly #faces: Uint32Array;
    #mendedFaces = 0;
    #flippedParts = 0;

    readonly #maps: Maps;
    readonly #act: Act;
    readonly #ball: Ball;
    readonly #ground: ExactMap;

    #settings: Settings;
    #scene!: Scene;
    #simulation!: Simulation;
    #clothMap!: AnyMap;
    #judge!: Judge;
    #contacts!: ContactBuffer;
    #cloth!: Omit<ClothNews, 'ball'>;
    /** Of a single sheet. */
    #columns: number | undefined;
    /** Seconds that the model has moved by itself: not while it is held. */
    #ownSeconds = 0;
    /** Seconds that it has deformed. */
    #shapeSeconds = 0;
    #shape: Float32Array<ArrayBuffer> | undefined;
    /** Frames of the simulations before the present one, whose count restarts after continueWith(). */
    #earlierFrames = 0;
    #owedSeconds = 0;
    #lastMs = 0;

    /**
     * Takes ownership of the model's mesh.
     * @param tell  is told what takes time before it is done
     * @throws EchinusError when no map of it, or no cloth on it, is possible
     */
    constructor(echinus: Echinus, model: Model, settings: Settings, tell: (stage: Stage) => void) {
        this.#echinus = echinus;
        this.#settings = settings;
        this.#name = model.name;
        this.#act = model.act ?? sheets();
        this.#mesh = model.mesh;
        try {
            tell('repairing');
            if (settings.mend) this.#mend();
            this.#report = this.#mesh.report();
            this.#faults = this.#mesh.faults();
            this.#faces = this.#mesh.faces;
            const up = settings.up === 'auto' ? model.up : settings.up;
            tell('building the map');
            this.#maps = new Maps(echinus, this.#mesh, up, settings);
            this.body = bodyOf(this.#mesh, this.#maps.exact, up, this.#act);
            this.#ground = buildGround(echinus, this.body);
            this.#ball = new Ball(echinus, this.body);
            tell('laying the cloth');
            this.restart();
        } catch (error) {
            this.delete();
            throw error;
        }
    }

    /** Of a model that is refused, only a part was made. */
    delete(): void {
        this.#dropCloth();
        this.#ball?.delete();
        this.#ground?.delete();
        this.#maps?.delete();
        this.#mesh.delete();
    }

    get clothNews(): ClothNews {
        return { ...this.#cloth, ...(this.#settings.hand === 'ball' && { ball: ballRadius(this.body) }) };
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
    get report(): MeshReport {
        return this.#report;
    }

    news(): ModelNews {
        const { vertices, faces } = this.#mesh;
        return {
            name: this.#name,
            vertices,
            faces,
            ...(faces.length <= 3 * CREASED_FACES && !this.#act.shape ? { shape: creasedNormals(vertices, faces) } : { normals: normalsOf(vertices, faces) }),
            report: this.#report,
            certainShare: this.exactMap.description.certainShare,
            faults: this.#faults,
            mendedFaces: this.#mendedFaces,
            flippedParts: this.#flippedParts,
            centre: [...this.exactMap.centre] as Triple,
            radius: this.exactMap.radius,
            sight: { centre: [...this.body.centre] as Triple, radius: this.body.radius },
            floor: this.body.floor,
            up: this.body.up,
            map: this.mapNews,
        };
    }

    /** @param tell  is told what takes time before it is done @returns whether the cloth started anew */
    change(settings: Settings, tell: (stage: Stage) => void): boolean {
        const before = this.#settings;
        if (!this.#maps.has(settings)) tell('building the map');
        this.#settings = settings;
        try {
            return this.#follow(settings, before);
        } catch (error) {
            this.#settings = before; // the previous state continues
            throw error;
        }
    }

    #follow(settings: Settings, before: Settings): boolean {
        if (this.#maps.by(settings).map !== this.#clothMap || settings.particles !== before.particles || settings.cloths !== before.cloths) {
            this.restart();
            return true;
        }
        const keys = ['friction', 'thickness', 'surfaces', 'self', 'hand'] as const;
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
        const scene = this.#echinus.parseScene(sceneFor(this.#settings, this.body, this.#act));
        const { map } = this;
        const garment = this.#act.cloth?.(this.#echinus, this.#settings, this.body);
        const bodies = this.#act.bodies?.(this.#echinus) ?? [];
        let simulation;
        try {
            simulation = unlessRefused(scene, () => scene.makeSimulation(this.#clothMaps, { allowOpenCollider: true, bodies, ...(garment && { cloth: garment.mesh }) }));
        } finally {
            for (const mesh of [...bodies, garment?.mesh]) mesh?.delete();
        }
        this.#dropCloth();
        this.#clothMap = map;
        this.#scene = scene;
        this.#simulation = simulation;
        this.#columns = scene.particleCount === null ? undefined : columnsOf(this.#settings.particles);
        this.#cloth = {
            faces: simulation.faces,
            thickness: this.#act.thickness(this.#settings, this.body),
            ...(this.#columns && { weave: weaveOf(this.#columns), hem: SIZE }),
            ...(garment && onFabric(garment)),
            soft: bodies.length > 0,
        };
        this.#judge = new Judge(this.#echinus, this.exactMap, simulation.particleCount);
        this.#contacts = this.#echinus.makeContacts(simulation.particleCount);
        this.shake.forget();
        this.#ownSeconds = 0;
        this.#shapeSeconds = 0;
        this.#shape = undefined;
        this.#earlierFrames = 0;
        this.#owedSeconds = 0;
        this.#lastMs = performance.now();
    }

    get #clothMaps(): AnyMap[] {
        return [this.map, this.#ground, ...(this.#settings.hand === 'ball' ? [this.#ball.map] : [])];
    }

    /**
     * Makes as many steps as real time requires, within FRAME_BUDGET_MS, and fills the arrays with the result.
     * @param until  the last frame to make; two cloths keep step by it
     */
    advance(paused: boolean, arrays: FrameArrays | undefined, until = Infinity): Look {
        const now = performance.now();
        // A hidden page has not simulated, and need not catch up.
        const elapsed = now - this.#lastMs;
        this.#owedSeconds = Math.min(this.#owedSeconds + 0.001 * elapsed, 0.1);
        this.#lastMs = now;
        const budget = Math.min(FRAME_BUDGET_MS.most, Math.max(FRAME_BUDGET_MS.least, FRAME_BUDGET_MS.share * elapsed));
        const before = this.#simulation.profile;
        let stepCount = 0;
        if (!paused && !this.#rests())
            while (this.#owedSeconds >= this.#scene.timeStep && this.#frame < until && performance.now() - now < budget) {
                this.#step();
                this.#owedSeconds -= this.#scene.timeStep;
                ++stepCount;
            }
        return this.#look(arrays, before, stepCount, performance.now() - now, paused);
    }

    /** One step, for a cloth that is paused. */
    stepOnce(arrays: FrameArrays | undefined): Look {
        const before = this.#simulation.profile;
        const begin = performance.now();
        this.#step();
        return this.#look(arrays, before, 1, performance.now() - begin, true);
    }

    get collider(): ColliderState {
        return this.#simulation.collider;
    }

    grab(particle: number, target: Triple): void {
        if (particle >= this.#simulation.particleCount) return;
        // The hand has the same size on fine and coarse cloths, but holds the neighbours at least.
        const reach = Math.max(HAND * this.body.radius, 1.05 * longestEdgeAt(particle, this.#cloth.faces, this.#simulation.positions));
        this.hand.grab(this.#simulation, particle, target, reach);
    }

    /** The pointer's line, for the ball. */
    point(from: Triple, to: Triple): void {
        this.#ball.aim(this.exactMap, this.collider, from, to);
    }

    hold(offset: Triple): void {
        const { bottom, floor, up } = this.body;
        const least = this.#act.deepest ?? floor - bottom;
        const k = AXES.indexOf(up);
        // The model may be lower already by its own motion.
        const own = this.#act.motion ? this.collider.position[k] - this.shake.offset[k] : 0;
        this.shake.hold(offset, k, least - own);
    }

    get #frame(): number {
        return this.#earlierFrames + this.#simulation.frame;
    }

    #step(): void {
        const simulation = this.#simulation;
        const { radius } = this.body;
        const seconds = this.#frame * this.#scene.timeStep;
        this.#moveModel();
        const wind = this.#windAt(seconds);
        if (wind.some((part) => part !== 0)) simulation.blow(wind, 4);
        this.#act.steer?.(simulation, seconds, this.#scene.timeStep);
        this.hand.pull(simulation, this.#scene.timeStep, FASTEST * radius);
        if (simulation.colliderCount > BALL) this.#ball.move(simulation, this.exactMap, BALL, this.#scene.timeStep);
        simulation.step();
    }

    /** By itself, and by the visitor's hand. */
    #moveModel(): void {
        const { timeStep } = this.#scene;
        const { radius, up } = this.body;
        const own = this.#act.motion?.(this.#ownSeconds) ?? motionAt(this.#settings.motion, UNIT[up], this.#ownSeconds, this.exactMap.centre, this.#simulation.collider);
        const held = this.shake.advance(timeStep, FASTEST * radius);
        const still: Triple = [0, 0, 0];
        const { linear, angular } = this.shake.holds ? { linear: still, angular: still } : own;
        if (!this.shake.holds) this.#ownSeconds += timeStep;
        this.#simulation.setColliderVelocity(linear.map((part, k) => part + held[k]), angular);
        if (!this.shake.holds) this.#deformModel();
    }

    #deformModel(): void {
        const { surfaces, map } = this.#settings;
        if (!this.#act.shape || !surfaces || map !== 'exact') return;
        this.#shapeSeconds += this.#scene.timeStep; // where surfaces were off meanwhile, it goes on from the shape that it had
        this.#shape = this.#act.shape(this.#shapeSeconds);
        this.#simulation.setColliderVertices(this.#shape);
    }

    #shapeNews(): { shape: ModelShape } | undefined {
        if (!this.#shape) return undefined;
        const vertices = this.#shape.slice();
        return { shape: { vertices, normals: normalsOf(vertices, this.#faces) } };
    }

    #windAt(seconds: number): Triple {
        const own = this.#act.wind?.(seconds) ?? [0, 0, 0];
        const visitors = this.#settings.wind > 0 ? this.#gust(seconds) : [0, 0, 0];
        return own.map((part, k) => part * this.body.radius + visitors[k]) as Triple;
    }

    /** From the side, in gusts: a steady wind would hold the cloth like a wall. A function of the frame, so that a link reproduces it. */
    #gust(seconds: number): Triple {
        const speed = this.#settings.wind * this.body.radius * (0.75 + 0.25 * Math.sin(2.1 * seconds) * Math.sin(0.8 * seconds));
        const across: Record<Axis, Triple> = { x: [0, 0.94, 0.34], y: [0.34, 0, 0.94], z: [0.94, 0.34, 0] };
        return across[this.body.up].map((part) => speed * part) as Triple;
    }

    /** Nothing moves the cloth any more, so the simulation may stop. */
    #rests(): boolean {
        const { motion, wind, hand } = this.#settings;
        const seconds = this.#frame * this.#scene.timeStep;
        const isMoved = this.hand.holds || this.shake.moves(this.body.radius) || (hand === 'ball' && this.#ball.isLed);
        return this.#simulation.atRest && motion === 'still' && wind === 0 && !isMoved && seconds >= this.#act.lasts;
    }

    #look(arrays: FrameArrays | undefined, before: SimulationProfile, stepCount: number, ms: number, paused: boolean): Look {
        const simulation = this.#simulation;
        const filled = fitted(arrays, simulation.particleCount);
        filled.positions.set(simulation.positions);
        if (this.#columns) sheetNormals(filled.positions, this.#columns, filled.normals);
        else surfaceNormals(filled.positions, this.#cloth.faces, filled.normals);
        if (this.#settings.colour === 'depth') measureDepths(simulation, this.#cloth.thickness, this.#contacts, filled.depths);
        const wrong = this.#wrongOf(filled.positions);
        const after = simulation.profile;
        const perStep = 1000 / Math.max(1, stepCount);
        const figures: Figures = {
            frame: this.#frame,
            paused,
            atRest: this.#rests(),
            stepSeconds: this.#scene.timeStep,
            stepMs: stepCount > 0 ? ms / stepCount : 0,
            constraintMs: perStep * (after.constraintSeconds - before.constraintSeconds),
            collisionMs: perStep * (after.collisionSeconds - before.collisionSeconds),
            ...(this.#report.closed && { inside: wrong.length }),
            stepCount,
        };
        return { arrays: filled, figures, wrong, ...this.#shapeNews(), ...(simulation.colliderCount > BALL && { ball: simulation.colliderAt(BALL).position }) };
    }

    /** The particles inside, where there is an inside. */
    #wrongOf(positions: Float32Array): Uint32Array<ArrayBuffer> {
        if (!this.#report.closed) return new Uint32Array(0);
        return this.#shape ? this.#judge.wrongNow(this.#simulation) : this.#judge.wrongOf(positions, this.#simulation.collider);
    }

    #continue(): void {
        const scene = this.#echinus.parseScene(sceneFor(this.#settings, this.body, this.#act, { falls: true }));
        const simulation = unlessRefused(scene, () => this.#simulation.continueWith(scene, this.#clothMaps));
        this.#earlierFrames += this.#simulation.frame;
        this.#simulation.delete();
        this.#scene.delete();
        this.#scene = scene;
        this.#simulation = simulation;
        this.#cloth = { ...this.#cloth, thickness: this.#act.thickness(this.#settings, this.body) };
    }

    #mend(): void {
        const { mesh, report } = this.#mesh.repair();
        this.#mesh.delete();
        this.#mesh = mesh;
        this.#mendedFaces = report.duplicateFacesDropped + report.doubledPatchFacesDropped;
        this.#flippedParts = report.componentsFlipped;
    }

    #dropCloth(): void {
        this.hand.release();
        this.#simulation?.delete();
        this.#scene?.delete();
        this.#judge?.delete();
        this.#contacts?.delete();
    }
}

/** Uses a scene, and deletes it if that fails. */
function unlessRefused<T>(scene: Scene, act: () => T): T {
    try {
        return act();
    } catch (error) {
        scene.delete();
        throw error;
    }
}

function bodyOf(mesh: Mesh, map: ExactMap, up: Axis, act: Act): Body {
    const { vertices } = mesh;
    const k = AXES.indexOf(up);
    const top = furthestAlong(UNIT[up], vertices)[k], bottom = furthestAlong(UNIT[up].map((part) => -part) as Triple, vertices)[k];
    const { centre, radius } = act.body ?? map;
    // Room for a cloth that hangs over a flat model.
    const floor = act.floor ?? bottom - Math.max(0, 0.65 * radius - (top - bottom));
    return { centre, radius, up, top, bottom, floor };
}

function buildGround(echinus: Echinus, body: Body): ExactMap {
    const box = echinus.makeBox(groundSize(body));
    const map = echinus.buildMap(box, { kind: 'exact' });
    box.delete();
    return map;
}

function normalsOf(vertices: Float32Array, faces: Uint32Array): Float32Array<ArrayBuffer> {
    const normals = new Float32Array(vertices.length);
    surfaceNormals(vertices, faces, normals);
    return normals;
}

function longestEdgeAt(particle: number, faces: Uint32Array, positions: Float32Array): number {
    let longest = 0;
    for (let corner = faces.indexOf(particle); corner >= 0; corner = faces.indexOf(particle, corner + 1))
        for (let k = 0; k < 3; ++k) {
            const other = faces[corner - (corner % 3) + k];
            longest = Math.max(longest, Math.hypot(...[0, 1, 2].map((c) => positions[3 * other + c] - positions[3 * particle + c])));
        }
    return longest;
}

/** The part of a garment that the page needs. */
const onFabric = ({ weave, tints, hem }: Garment): Partial<ClothNews> => ({ weave, ...(tints && { tints }), ...(hem && { hem }) });

/** Places on a square sheet, in radii of the model. */
function weaveOf(columns: number): Float32Array<ArrayBuffer> {
    const weave = new Float32Array(2 * columns * columns);
    for (let i = 0; i < columns * columns; ++i) weave.set([(SIZE * (i % columns)) / (columns - 1), (SIZE * Math.floor(i / columns)) / (columns - 1)], 2 * i);
    return weave;
}

function fitted(arrays: FrameArrays | undefined, particleCount: number): FrameArrays {
    if (arrays?.depths.length === particleCount) return arrays;
    return {
        positions: new Float32Array(3 * particleCount),
        normals: new Float32Array(3 * particleCount),
        depths: new Float32Array(particleCount),
    };
}
