import type { ColliderState, Placement, SceneDescription, Shape } from 'echinus';
import { type Axis, AXES, UNIT } from '../frames';
import type { Triple } from '../protocol';
import { type Settings, collisionOf } from '../settings';
import type { Act } from './acts/act';
import { ballOf } from './ball';

/** The dimensions of a model, to which a scene is scaled. */
export interface Body {
    centre: readonly number[];
    radius: number;
    up: Axis;
    /** The highest vertex, along `up`, and the lowest. */
    top: number;
    bottom: number;
    /** The height of the ground. */
    floor: number;
}

export const columnsOf = (particles: number): number => Math.max(2, Math.round(Math.sqrt(particles)));

/**
 * Makes the scene around the model. Gravity scales with its radius, so the cloth falls equally fast on a model in millimetres and on one in metres.
 * @param falls  the cloth has begun to fall, by other settings
 */
export function sceneFor(settings: Settings, body: Body, act: Act, { falls } = { falls: false }): SceneDescription {
    const { radius } = body;
    const thickness = act.thickness(settings, body);
    const { surfaces, self } = collisionOf(settings);
    const own = act.scene(settings, body);
    return {
        colliders: [{ model: MODEL }, floorOf(body), ...(settings.hand === 'ball' ? [ballOf(body)] : [])],
        ...own,
        ...(own.cloth && { cloth: { thickness, ...own.cloth } }),
        material: { ...cottonBy(radius), friction: settings.friction, ...own.material },
        gravity: UNIT[body.up].map((part) => -9.81 * radius * part) as [number, number, number],
        collision: !surfaces ? 'particles' : self ? 'surfaces_and_self' : 'surfaces',
        untangle: surfaces && falls, // it may intersect where particles alone have collided
        at_rest: { distance: 0.001 * radius, speed: 0.1 * radius },
    };
}

/**
 * A cotton, as beside a model with a radius of 1 m. Where all lengths are R times as large and times are the same, density, stiffness and bending stiffness grow as 1, R^2 and R^4;
 * all of them divided by R, they stay within the library's ranges for more models.
 */
function cottonBy(radius: number) {
    const within = (value: number, least: number, most: number) => Math.min(most, Math.max(least, value));
    return {
        density: within(0.2 / radius, 1e-6, 1e6), // kg/m^2
        stretch_stiffness: within(1000 * radius, 1e-6, 1e9), // N/m
        shear_stiffness: within(400 * radius, 0, 1e9),
        bending_stiffness: within(1e-5 * radius ** 3, 0, 1e6), // N m
    };
}

/** A scene needs a name; the map of the model already exists. */
const MODEL = 'model.obj';

/** The ground, a box whose upper side it is: in radii its width and height. */
const GROUND = { width: 10, height: 0.5 };

export function groundSize({ radius, up }: Body): Triple {
    return AXES.map((axis) => radius * (axis === up ? GROUND.height : GROUND.width)) as Triple;
}
function floorOf(body: Body): Placement & { model: Shape } {
    const position = [...body.centre] as Triple;
    position[AXES.indexOf(body.up)] = body.floor - 0.5 * GROUND.height * body.radius;
    return { model: { box: { size: groundSize(body) } }, position };
}

const TURN = Math.PI / 5; // radians per second: once around in ten seconds
const SWING = { radians: 0.35, seconds: 4 };

/**
 * The model's velocities at a time: it turns about its centre, wherever its origin is.
 * @param up  unit
 */
export function motionAt(
    motion: Settings['motion'],
    up: Triple,
    seconds: number,
    centre: readonly number[],
    collider: ColliderState,
): { linear: Triple; angular: Triple } {
    const angular = angularVelocity(motion, up, seconds);
    const arm = rotated(collider.rotation, centre);
    const [x, y, z] = cross(angular, arm);
    return { linear: [-x, -y, -z], angular };
}

function angularVelocity(motion: Settings['motion'], up: Triple, seconds: number): Triple {
    switch (motion) {
        case 'still':
            return [0, 0, 0];
        case 'turning':
            return up.map((part) => TURN * part) as Triple;
        case 'swinging': {
            const rate = (2 * Math.PI) / SWING.seconds;
            const speed = SWING.radians * rate * Math.cos(rate * seconds);
            // About the axis after up: across the horse's length.
            return [up[2], up[0], up[1]].map((part) => speed * part) as Triple;
        }
    }
}

function rotated([w, x, y, z]: ColliderState['rotation'], v: readonly number[]): Triple {
    const axis: Triple = [x, y, z];
    const t = cross(axis, v).map((part) => 2 * part);
    const u = cross(axis, t);
    return [0, 1, 2].map((k) => v[k] + w * t[k] + u[k]) as Triple;
}

function cross(a: readonly number[], b: readonly number[]): Triple {
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
