import type { FromWorker, ToWorker } from './protocol';

/** The page's end of the worker, which begins at once: it has enough to do until there is somebody to listen. */
export class Client {
    #early: FromWorker[] = [];
    #hear: (message: FromWorker) => void = (message) => this.#early.push(message);
    #worker: Worker | undefined = this.#start();

    listen(hear: (message: FromWorker) => void): void {
        this.#hear = hear;
        this.#early.forEach(hear);
        this.#early = [];
    }

    /** After a fault, this begins a new worker with a new module: not the fault itself, or one that does not load would begin for ever. */
    tell(message: ToWorker, transfer: Transferable[] = []): void {
        this.#worker ??= this.#start();
        this.#worker.postMessage(message, transfer);
    }

    stop(): void {
        this.#worker?.terminate();
        this.#worker = undefined;
    }

    #start(): Worker {
        const worker = new Worker(new URL('./worker/worker.ts', import.meta.url), { type: 'module' });
        worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.#hear(data);
        worker.onerror = ({ message }) => {
            this.stop();
            const sentence = message ? `the simulation has stopped (${message})` : 'the simulation did not start: a part of this page could not be loaded';
            this.#hear({ kind: 'failed', sentence, code: 'Crashed' });
        };
        return worker;
    }
}
