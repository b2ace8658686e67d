import type { ColliderState } from 'echinus';
import type { Cuts, ModelNews, PairsQuestion } from './protocol';

/** The worker computes for at most this share of the time. */
const MOST_SHARE = 0.2;
const LEAST_PERIOD_MS = 250;
/** The first cloth falls before the worker is loaded. */
const FIRST_FRAME = 24;

/** Asks a worker now and then which faces of the cloth intersect, one question at a time. */
export class Pairs {
    #worker: Worker | undefined;
    #failed = false;
    #model: ModelNews | undefined;
    #modelToTell: ModelNews | undefined;
    #waits = false;
    #next = 0;
    /** The last question. */
    #asked = '';
    /** @param cuts  those of the cloth with the number of the last question */
    #hear: (cuts: Cuts) => void;

    constructor(hear: (cuts: Cuts) => void) {
        this.#hear = hear;
    }

    set model(model: ModelNews) {
        this.#model = this.#modelToTell = model;
    }

    /**
     * Asks about a cloth, unless it is too early for another question or this was the last one.
     * @param number  of the cloth @param frame  of the cloth @param shape  the model's vertices, where it has deformed
     */
    consider(number: number, frame: number, positions: Float32Array, faces: Uint32Array, collider: ColliderState, shape: Float32Array | undefined): void {
        const question = `${number} ${frame}`;
        if (this.#failed || this.#waits || !this.#model || performance.now() < this.#next || question === this.#asked) return;
        if (!this.#worker && frame < FIRST_FRAME) return;
        this.#worker ??= this.#start();
        this.#asked = question;
        this.#waits = true;
        const { position, rotation } = collider;
        const message: PairsQuestion = { number, positions: positions.slice(), faces, collider: { position, rotation }, ...(shape && { shape }), ...(this.#modelToTell && { model: { vertices: this.#modelToTell.vertices, faces: this.#modelToTell.faces } }) };
        this.#modelToTell = undefined;
        this.#worker.postMessage(message, [message.positions.buffer]);
    }

    stop(): void {
        this.#worker?.terminate();
        this.#failed = true;
    }

    #start(): Worker {
        const worker = new Worker(new URL('./worker/pairs.ts', import.meta.url), { type: 'module' });
        worker.onmessage = ({ data }: MessageEvent<Cuts>) => {
            this.#waits = false;
            this.#next = performance.now() + Math.max(LEAST_PERIOD_MS, data.ms * (1 / MOST_SHARE - 1));
            this.#hear(data);
        };
        // Without it the page only lacks the counts.
        worker.onerror = () => {
            this.#failed = true;
            worker.terminate();
        };
        return worker;
    }
}
