import { columnsOf } from '../cloth_scene';
import { type Act, garmentOf } from './act';
import { stackOf } from './sheet_mesh';

const COUNT = 10, SIZE = 1.9;
/** Between two layers at the start, and how much each is turned against the one below. */
const APART = 0.07, TURN = Math.PI / 20;

const columnsOfLayer = (particles: number): number => columnsOf(particles / COUNT);

/** Ten sheets fall on a ball, each on the one before it. */
export function layers(): Act {
    return {
        body: { centre: [0, 0, 0.15], radius: 1.3, up: 'z' },
        floor: -1.15,
        lasts: 0,
        thickness: ({ thickness, particles }) => (0.6 * thickness * SIZE) / (columnsOfLayer(particles) - 1),
        scene: (_, { top }) => ({ cloth: { mesh: 'layers', bending: 'sticks', position: [0, 0, top + 0.12] } }),
        cloth: (echinus, { particles }) => garmentOf(echinus, stackOf({ count: COUNT, columns: columnsOfLayer(particles), size: SIZE, apart: APART, turn: TURN })),
    };
}
