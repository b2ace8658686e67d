import type { ColliderState, Echinus, ExactMap, Placement, Shape, Simulation } from 'echinus';
import { AXES, following, intoFrameOf, outOfFrameOf, UNIT } from '../frames';
import type { Triple } from '../protocol';
import type { Body } from './cloth_scene';

/** Of the ball and of what is kept free between it and the model for the cloth, in the model's radii. */
const RADIUS = 0.16, GAP = 0.05;
/** Radii per second. */
const FASTEST = 5;
/** How much of the way it goes in a second, to begin with. */
const RATE = 14;

export const ballRadius = ({ radius }: Body): number => RADIUS * radius;

/** The ball as a collider of a scene, beside the model. */
export function ballOf(body: Body): Placement & { model: Shape } {
    const beside = UNIT[following(body.up)[0]];
    return { model: { sphere: { radius: ballRadius(body), segments: [40, 20] } }, position: body.centre.map((part, k) => part + 2 * body.radius * beside[k]) };
}

/** A ball that follows the pointer over the model's surface, as a collider of its own. */
export class Ball {
    readonly #echinus: Echinus;
    readonly #body: Body;
    #map: ExactMap | undefined;
    #target: Triple | undefined;

    constructor(echinus: Echinus, body: Body) {
        this.#echinus = echinus;
        this.#body = body;
    }

    get map(): ExactMap {
        this.#map ??= this.#build();
        return this.#map;
    }
    get isLed(): boolean {
        return this.#target !== undefined;
    }

    #build(): ExactMap {
        const mesh = this.#echinus.makeSphere(ballRadius(this.#body), 40, 20);
        const map = this.#echinus.buildMap(mesh, { kind: 'exact' });
        mesh.delete();
        return map;
    }

    /** Along the pointer's line: before the model, or where the line passes its centre. */
    aim(model: ExactMap, collider: ColliderState, from: Triple, to: Triple): void {
        const ends = new Float32Array([...from, ...to]);
        intoFrameOf(collider, ends, ends);
        const { found, fraction } = model.sweep(ends.subarray(0, 3), ends.subarray(3, 6));
        const way = to.map((part, k) => part - from[k]);
        const length = Math.hypot(...way);
        const { centre, radius } = this.#body;
        const share = found ? fraction - ((RADIUS + GAP) * radius) / length : way.reduce((sum, part, k) => sum + part * (centre[k] - from[k]), 0) / (length * length);
        this.#target = from.map((part, k) => part + share * way[k]) as Triple;
    }

    /** Call before each step. @param index  of the ball among the colliders */
    move(simulation: Simulation, model: ExactMap, index: number, timeStep: number): void {
        const { position } = simulation.colliderAt(index);
        const { radius } = this.#body;
        const target = this.#target ?? position;
        const way = target.map((part, k) => part - position[k]);
        const share = Math.min(RATE * timeStep, (FASTEST * radius * timeStep) / (Math.hypot(...way) || 1));
        const next = new Float32Array(position.map((part, k) => part + share * way[k]));
        keepOff(model, simulation.collider, next, (RADIUS + GAP) * radius);
        const k = AXES.indexOf(this.#body.up);
        next[k] = Math.max(next[k], this.#body.floor + (RADIUS + GAP) * radius);
        simulation.setColliderVelocity([...next].map((part, k) => (part - position[k]) / timeStep), [0, 0, 0], index);
    }

    delete(): void {
        this.#map?.delete();
    }
}

/** Moves a point out of the model and its surroundings. */
function keepOff(model: ExactMap, collider: ColliderState, point: Float32Array, distance: number): void {
    intoFrameOf(collider, point, point);
    const { found, normal, depth } = model.contact(point, distance);
    if (found) for (let k = 0; k < 3; ++k) point[k] += (distance + depth) * normal[k];
    outOfFrameOf(collider, point);
}
