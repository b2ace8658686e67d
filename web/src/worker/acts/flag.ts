import { columnsOf } from '../cloth_scene';
import { type Act, garmentOf, sheetMesh } from './act';
import { lathe } from './solids';

const RADIUS = 0.035, FOOT = -1.25, TOP = 1;
const WIDTH = 1.65, HEIGHT = 1.0;
/** Of the flag's upper edge, and from the pole's surface. */
const LEVEL = 0.9, GAP = 0.03;

/** A pole with a ball at its top. */
export const pole = () =>
    lathe(
        [[0, FOOT], [2.4 * RADIUS, FOOT], [RADIUS, FOOT + 0.05], ...Array.from({ length: 12 }, (_, i) => [RADIUS, FOOT + 0.1 + (i * (TOP - FOOT - 0.1)) / 11] as const),
            ...[-0.8, -0.4, 0, 0.4, 0.8].map((s) => [2 * RADIUS * Math.cos(s * 1.2), TOP + 2.2 * RADIUS * (1 + Math.sin(s * 1.2))] as const), [0, TOP + 4.5 * RADIUS]],
        20,
    );

const rowsOf = (particles: number): number => Math.max(3, Math.round(columnsOf(particles) * Math.sqrt(HEIGHT / WIDTH)));
const columnCount = (particles: number): number => Math.max(3, Math.round(columnsOf(particles) * Math.sqrt(WIDTH / HEIGHT)));

/** A flag on a pole, in gusts. */
export function flag(): Act {
    return {
        body: { centre: [0.45, 0, 0.05], radius: 1.35, up: 'z' },
        floor: FOOT,
        lasts: Infinity,
        thickness: ({ thickness, particles }) => (0.8 * thickness * WIDTH) / (columnCount(particles) - 1),
        scene: ({ particles }) => ({
            cloth: { mesh: 'flag', attachments: Array.from({ length: rowsOf(particles) }, (_, row) => row * columnCount(particles)) },
        }),
        cloth: (echinus, { particles }) =>
            garmentOf(echinus, sheetMesh(columnCount(particles), rowsOf(particles), [WIDTH, HEIGHT], (u, v) => [RADIUS + GAP + u * WIDTH, 0.05 * u * Math.sin(9 * u), LEVEL - v * HEIGHT])),
        wind: (seconds) => {
            const turn = 0.5 * Math.sin(1.9 * seconds) + 0.35 * Math.sin(4.3 * seconds + 1) + 0.2 * Math.sin(7.1 * seconds);
            const speed = 4.5 + 1.2 * Math.sin(0.9 * seconds);
            return [speed * Math.cos(turn), speed * Math.sin(turn), 0.35 * Math.sin(3.1 * seconds)];
        },
    };
}
