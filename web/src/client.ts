import type { FromWorker, ToWorker } from './protocol';

/** The page's connection to the worker, which starts at once: it has work to do before the page is ready to listen. */
export class Client {
    #early: FromWorker[] = [];
    #hear: (message: FromWorker) => void = (message) => this.#early.push(message);
    #worker: Worker | undefined = this.#start();

    listen(hear: (message: FromWorker) => void): void {
        this.#hear = hear;
        this.#early.forEach(hear);
        this.#early = [];
    }

    /** After a fault, only the next message starts a new worker: a module that fails to load would otherwise restart endlessly. */
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
            const sentence = message ? `The simulation has stopped (${message}).` : 'The simulation did not start: a part of this page could not be loaded.';
            this.#hear({ kind: 'failed', sentence, code: 'Crashed' });
        };
        return worker;
    }
}
