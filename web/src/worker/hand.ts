import type { Simulation } from 'echinus';
import type { Triple } from '../protocol';

/**
 * A pointer that holds a particle and its near neighbours. It sets their velocities, so sticks still pull at them and
 * the model still stops them: no particle can be dragged into it.
 */
export class Hand {
    #held: { particle: number; offset: Triple }[] = [];
    #target: Triple = [0, 0, 0];

    get holds(): boolean {
        return this.#held.length > 0;
    }

    /** @param reach  holds the particles within it of the one that is grabbed */
    grab(simulation: Simulation, particle: number, target: Triple, reach: number): void {
        const { positions } = simulation;
        this.#held = [];
        this.#target = target;
        for (let i = 0; i < simulation.particleCount; ++i) {
            const offset = [0, 1, 2].map((k) => positions[3 * i + k] - positions[3 * particle + k]) as Triple;
            if (Math.hypot(...offset) <= reach) this.#held.push({ particle: i, offset });
        }
    }
    drag(target: Triple): void {
        this.#target = target;
    }
    release(): void {
        this.#held = [];
    }

    /** Call before each step. @param limit  largest speed, units per second */
    pull(simulation: Simulation, timeStep: number, limit: number): void {
        const { positions } = simulation;
        for (const { particle, offset } of this.#held) {
            // Reaches the target in five time steps: quick to the eye, and soft enough for the sticks to follow.
            const velocity = [0, 1, 2].map((k) => (this.#target[k] + offset[k] - positions[3 * particle + k]) / (5 * timeStep));
            const speed = Math.hypot(...velocity);
            const share = speed > limit ? limit / speed : 1;
            simulation.setParticleVelocity(particle, velocity.map((part) => share * part));
        }
    }
}
