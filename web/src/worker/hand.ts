import type { Simulation } from 'echinus';
import type { Triple } from '../protocol';

/**
 * A pointer that holds a particle and its near neighbours. It sets their velocities, so the cloth still pulls at them and
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
            // Alone it would reach the target in a step; the cloth, which shares the motion, keeps it back.
            const velocity = [0, 1, 2].map((k) => (this.#target[k] + offset[k] - positions[3 * particle + k]) / timeStep);
            const speed = Math.hypot(...velocity);
            const share = speed > limit ? limit / speed : 1;
            simulation.setParticleVelocity(particle, velocity.map((part) => share * part));
        }
    }
}

/** How much of the way to where it is held the model goes in a second, to begin with. */
const RATE = 9;

/** The visitor's grip on the model, which follows it, and returns when it is let go. */
export class Shake {
    #wish: Triple = [0, 0, 0];
    #offset: Triple = [0, 0, 0];
    #held = false;

    /** @param offset  from where the model would be otherwise @param up  an axis @param least  along it */
    hold(offset: Triple, up: number, least: number): void {
        this.#held = true;
        this.#wish = offset.map((part, k) => (k === up ? Math.max(part, least) : part)) as Triple;
    }
    release(): void {
        this.#held = false;
        this.#wish = [0, 0, 0];
    }
    /** The model stands where it was at the start. */
    forget(): void {
        this.release();
        this.#offset = [0, 0, 0];
    }

    get holds(): boolean {
        return this.#held;
    }
    get offset(): Readonly<Triple> {
        return this.#offset;
    }
    /** @param unit  a length in which a thousandth is nothing */
    moves(unit: number): boolean {
        return this.#held || Math.hypot(...this.#offset) > 0.001 * unit;
    }

    /** The velocity for the next step. @param limit  largest speed, units per second */
    advance(timeStep: number, limit: number): Triple {
        const way = this.#wish.map((part, k) => part - this.#offset[k]);
        const share = Math.min(RATE, limit / (Math.hypot(...way) || 1));
        const velocity = way.map((part) => share * part) as Triple;
        this.#offset = this.#offset.map((part, k) => part + timeStep * velocity[k]) as Triple;
        return velocity;
    }
}
