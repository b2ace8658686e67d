import { columnsOf } from '../cloth_scene';
import type { Act } from './act';
import { sheetMesh } from './sheet_mesh';

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
        cloth(echinus, { particles }) {
            const columns = columnsOfLayer(particles);
            const vertices: number[] = [], faces: number[] = [], weave: number[] = [], tints: number[] = [];
            for (let layer = 0; layer < COUNT; ++layer) {
                const [c, s] = [Math.cos(TURN * layer), Math.sin(TURN * layer)];
                const sheet = sheetMesh(columns, columns, [SIZE, SIZE], (u, v) => {
                    const [x, y] = [(u - 0.5) * SIZE, (v - 0.5) * SIZE];
                    return [c * x - s * y, s * x + c * y, layer * APART];
                });
                const first = vertices.length / 3;
                vertices.push(...sheet.vertices);
                faces.push(...sheet.faces.map((corner) => first + corner));
                weave.push(...sheet.weave);
                for (let i = 0; i < columns * columns; ++i) tints.push(layer / (COUNT - 1));
            }
            return { mesh: echinus.makeMesh(vertices, faces), weave: new Float32Array(weave), tints: new Float32Array(tints) };
        },
    };
}
