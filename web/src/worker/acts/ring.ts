import type { Simulation } from 'echinus';
import { Hand } from '../hand';
import { columnsOf } from '../cloth_scene';
import type { Act } from './act';

export const RING = { major: 1, minor: 0.45 };

const SIZE = 2.3;
/** The kerchief hangs still, is pulled up through the ring, and let go. Seconds. */
const BEGIN = 0.4, END = 3.4, RELEASE = 4.8;
const LOW = -0.56, HIGH = 1.75;
/** The hand holds what is so near the middle: enough to carry all of the kerchief, at this speed at most. */
const GRIP = 0.25, FASTEST = 40;

/** A kerchief is pulled through a ring by its middle, and falls back. */
export function ring(): Act {
    const hand = new Hand();
    let held: Simulation | undefined;
    const height = (seconds: number) => LOW + (HIGH - LOW) * Math.min(1, Math.max(0, (seconds - BEGIN) / (END - BEGIN)));
    return {
        body: { centre: [0, 0, -0.15], radius: 1.75, up: 'z' },
        floor: -1.95,
        lasts: RELEASE,
        thickness: ({ thickness, particles }) => (thickness * SIZE) / (columnsOf(particles) - 1),
        scene: ({ particles }) => {
            const columns = columnsOf(particles);
            return { cloth: { size: [SIZE, SIZE], particles: [columns, columns], position: [0, 0, LOW] } };
        },
        steer(simulation, seconds, timeStep) {
            if (seconds >= RELEASE) return;
            if (held !== simulation) {
                held = simulation;
                const { positions } = simulation;
                hand.grab(simulation, middle(positions), [0, 0, height(seconds)], GRIP);
            }
            hand.drag([0, 0, height(seconds)]);
            hand.pull(simulation, timeStep, FASTEST);
        },
    };
}

/** The particle in the middle of a square sheet. */
function middle({ length }: Float32Array): number {
    const columns = Math.round(Math.sqrt(length / 3));
    return Math.floor(columns / 2) * columns + Math.floor(columns / 2);
}
