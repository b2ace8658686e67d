import type { SceneDescription } from 'echinus';
import { AXES, type Axis, UNIT } from '../axes';
import type { Settings } from '../settings';

/** The inputs of a scene besides the settings. */
export interface Body {
    centre: readonly number[];
    radius: number;
    up: Axis;
    /** The highest vertex, along `up`. */
    top: number;
}

/** The rotation from z, the cloth's own up, to another axis. */
const FROM_Z: Record<Axis, { axis: [number, number, number]; degrees: number } | undefined> = {
    x: { axis: [0, 1, 0], degrees: 90 },
    y: { axis: [1, 0, 0], degrees: -90 },
    z: undefined,
};

export const columnsOf = (particles: number): number => Math.max(2, Math.round(Math.sqrt(particles)));

/** Edge of the square cloth, in radii of the model. */
const SIZE = 2.25;

/** By the distance between neighbouring particles: a finer cloth lies closer, and as few of its faces are cut. */
export const thicknessOf = (settings: Settings, { radius }: Body): number =>
    (settings.thickness * SIZE * radius) / (columnsOf(settings.particles) - 1);

/**
 * A cloth above the model. Lengths and gravity scale with the model's radius, so the cloth falls equally fast on a
 * model in millimetres and on one in metres.
 * @param falls  the cloth has begun to fall, by other settings
 */
export function sceneFor(settings: Settings, body: Body, { falls } = { falls: false }): SceneDescription {
    const { radius } = body;
    const position = [...body.centre] as [number, number, number];
    const thickness = thicknessOf(settings, body);
    position[AXES.indexOf(body.up)] = body.top + 0.08 * radius + thickness;
    const columns = columnsOf(settings.particles);
    const rotation = FROM_Z[body.up];
    const surfaces = settings.map === 'exact' && settings.surfaces; // the paper's map has no faces
    return {
        model: 'model.obj', // a scene needs a name; its map already exists
        cloth: { size: [SIZE * radius, SIZE * radius], particles: [columns, columns], position, thickness, ...(rotation && { rotation }) },
        material: { friction: settings.friction },
        gravity: UNIT[body.up].map((part) => -9.81 * radius * part) as [number, number, number],
        surface_collision: surfaces,
        self_collision: surfaces && settings.self,
        untangle: surfaces && falls, // it may intersect where particles alone have collided
        at_rest: { distance: 0.001 * radius, speed: 0.1 * radius },
    };
}
