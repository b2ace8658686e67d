import type { FromWorker, ToWorker } from './protocol';

/** The page's end of the worker, which begins at once: it has enough to do until there is somebody to listen. */
export class Client {
    #early: FromWorker[] = [];
    #hear: (message: FromWorker) => void = (message) => this.#early.push(message);
    #worker = this.#start();

    listen(hear: (message: FromWorker) => void): void {
        this.#hear = hear;
        this.#early.forEach(hear);
        this.#early = [];
    }

    tell(message: ToWorker, transfer: Transferable[] = []): void {
        this.#worker.postMessage(message, transfer);
    }

    /** A new worker with a new module, when the old one has stopped by a fault of its own. */
    restart(): void {
        this.#worker.terminate();
        this.#worker = this.#start();
    }

    #start(): Worker {
        const worker = new Worker(new URL('./worker/worker.ts', import.meta.url), { type: 'module' });
        worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.#hear(data);
        worker.onerror = (event) => this.#hear({ kind: 'failed', sentence: `the simulation has stopped (${event.message || 'its worker did not start'})`, code: 'Crashed' });
        return worker;
    }
}
