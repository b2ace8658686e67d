import { type Axis, AXES } from '../../frames';
import type { Triple } from '../../protocol';
import type { Settings } from '../../settings';
import { type Body, columnsOf } from '../cloth_scene';
import { type Act, garmentOf, stackOf } from './act';

/** Edge of a square sheet, in radii of the model. */
export const SIZE = 2.25;

/** The rotation from z, the cloth's own up, to another axis. */
const FROM_Z: Record<Axis, { axis: Triple; degrees: number } | undefined> = {
    x: { axis: [0, 1, 0], degrees: 90 },
    y: { axis: [1, 0, 0], degrees: -90 },
    z: undefined,
};

/** Between two sheets at the start, in radii, and how much each is turned against the one below: the corners of none lie on those of another. */
const APART = 0.06, TURN = Math.PI / 7;

const columnsOfSheet = ({ particles, cloths }: Settings): number => columnsOf(particles / cloths);

/** By the distance between neighbouring particles: a finer cloth lies closer, and as few of its faces are cut. */
const thicknessOf = (settings: Settings, { radius }: Body): number => (settings.thickness * SIZE * radius) / (columnsOfSheet(settings) - 1);

/** One sheet falls on the model, or several, each on the one before it. */
export function sheets(): Act {
    return {
        lasts: 0,
        thickness: thicknessOf,
        scene: (settings, body) => ({ cloth: aboveModel(settings, body) }),
        cloth(echinus, settings, body) {
            const { cloths: count } = settings;
            if (count === 1) return undefined;
            const apart = Math.max(APART * body.radius, 1.5 * thicknessOf(settings, body));
            return garmentOf(echinus, stackOf({ count, columns: columnsOfSheet(settings), size: SIZE * body.radius, apart, turn: TURN }), { unit: body.radius, hem: SIZE });
        },
    };
}

function aboveModel(settings: Settings, body: Body) {
    const { centre, radius, top, up } = body;
    const position = [...centre] as Triple;
    position[AXES.indexOf(up)] = top + 0.08 * radius + thicknessOf(settings, body);
    const rotation = FROM_Z[up], columns = columnsOfSheet(settings);
    return { position, ...(rotation && { rotation }), ...(settings.cloths === 1 ? sheetOf(columns, radius) : { mesh: 'sheets' }) };
}

const sheetOf = (columns: number, radius: number) => ({ size: [SIZE * radius, SIZE * radius] as [number, number], particles: [columns, columns] as [number, number] });

/** Of the ball's frame; apart: between two of them at the start, turn: of each against the one below. */
const LAYERS = { count: 5, size: 1.9, apart: 0.07, turn: Math.PI / 20 };

const columnsOfLayer = (particles: number): number => columnsOf(particles / LAYERS.count);

/** Five sheets fall on a ball, each on the one before it. */
export function layers(): Act {
    return {
        body: { centre: [0, 0, 0.15], radius: 1.3, up: 'z' },
        floor: -1.15,
        lasts: 0,
        thickness: ({ thickness, particles }) => (0.6 * thickness * LAYERS.size) / (columnsOfLayer(particles) - 1),
        scene: (_, { top }) => ({ cloth: { mesh: 'layers', position: [0, 0, top + 0.12] } }),
        cloth: (echinus, { particles }) => garmentOf(echinus, stackOf({ ...LAYERS, columns: columnsOfLayer(particles) })),
    };
}
