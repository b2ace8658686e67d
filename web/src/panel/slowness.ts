/** The mean over less time would flicker. */
const PERIOD_MS = 2000;
/** Less is not visible. */
const LEAST = 1.25;

/** Measures how much slower than in life the cloth moves, by the time that is simulated and the time that passes meanwhile. */
export class Slowness {
    #since: number | undefined;
    #simulatedMs = 0;
    #times: number | undefined;

    constructor() {
        document.addEventListener('visibilitychange', () => this.forget()); // a hidden page does not simulate
    }

    /** How many times slower than in life; undefined where it is not visibly slower, or not yet known. */
    get times(): number | undefined {
        return this.#times;
    }

    /** Call for each frame that may simulate. */
    add(seconds: number, now = performance.now()): void {
        this.#since ??= now;
        this.#simulatedMs += 1000 * seconds;
        const passed = now - this.#since;
        if (passed < PERIOD_MS || this.#simulatedMs === 0) return;
        const times = passed / this.#simulatedMs;
        this.#times = times >= LEAST ? times : undefined;
        this.#since = now;
        this.#simulatedMs = 0;
    }

    /** The cloth stands still, or is another one. */
    forget(): void {
        this.#since = undefined;
        this.#simulatedMs = 0;
        this.#times = undefined;
    }
}
