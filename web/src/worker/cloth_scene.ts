import type { Placement, SceneDescription, Shape } from 'echinus';
import { AXES, type Axis, UNIT } from '../axes';
import type { Triple } from '../protocol';
import type { Settings } from '../settings';
import type { Act } from './acts/act';
import { ballOf } from './ball';

/** What a scene is measured by. */
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

/** The rotation from z, the cloth's own up, to another axis. */
const FROM_Z: Record<Axis, { axis: [number, number, number]; degrees: number } | undefined> = {
    x: { axis: [0, 1, 0], degrees: 90 },
    y: { axis: [1, 0, 0], degrees: -90 },
    z: undefined,
};

export const columnsOf = (particles: number): number => Math.max(2, Math.round(Math.sqrt(particles)));

/** Edge of the square cloth, in radii of the model. */
export const SIZE = 2.25;

/** By the distance between neighbouring particles: a finer cloth lies closer, and as few of its faces are cut. */
export const thicknessOf = (settings: Settings, body: Body, act: Act | undefined): number =>
    act ? act.thickness(settings, body) : (settings.thickness * SIZE * body.radius) / (columnsOf(settings.particles) - 1);

/**
 * What happens on the model: the act, or else a cloth above it. Gravity scales with the model's radius, so the cloth falls
 * equally fast on a model in millimetres and on one in metres.
 * @param falls  the cloth has begun to fall, by other settings
 */
export function sceneFor(settings: Settings, body: Body, act: Act | undefined, { falls } = { falls: false }): SceneDescription {
    const { radius } = body;
    const thickness = thicknessOf(settings, body, act);
    const surfaces = settings.map === 'exact' && settings.surfaces; // the paper's map has no faces
    const own = act ? act.scene(settings, body) : { cloth: sheetAbove(settings, body, thickness) };
    return {
        colliders: [{ model: MODEL }, floorOf(body), ...(settings.hand === 'ball' ? [ballOf(body)] : [])],
        ...own,
        ...(own.cloth && { cloth: { thickness, ...own.cloth } }),
        material: { friction: settings.friction, ...own.material },
        gravity: UNIT[body.up].map((part) => -9.81 * radius * part) as [number, number, number],
        surface_collision: surfaces,
        self_collision: surfaces && settings.self,
        untangle: surfaces && falls, // it may intersect where particles alone have collided
        at_rest: { distance: 0.001 * radius, speed: 0.1 * radius },
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

function sheetAbove({ particles }: Settings, { centre, radius, top, up }: Body, thickness: number): SceneDescription['cloth'] {
    const position = [...centre] as [number, number, number];
    position[AXES.indexOf(up)] = top + 0.08 * radius + thickness;
    const columns = columnsOf(particles);
    const rotation = FROM_Z[up];
    return { size: [SIZE * radius, SIZE * radius], particles: [columns, columns], position, ...(rotation && { rotation }) };
}
