import { furthestAlong } from './axes';
import { byId } from './panel/elements';
import type { ModelNews, ToWorker, Triple } from './protocol';
import type { Settings } from './settings';

export interface TourWishes {
    model(): ModelNews | undefined;
    choose<K extends keyof Settings>(key: K, value: Settings[K]): void;
    tell(message: ToWorker): void;
}

/** How long a stop lasts. */
const STOP_MS = 6500;
/** How often the moving part of a stop moves. */
const STEP_MS = 50;

interface Stop {
    words: string;
    /** At the beginning. */
    enter?(tour: TourWishes): void;
    /** @param share  of the stop that has passed */
    move?(tour: TourWishes, share: number): void;
}

const STOPS: readonly Stop[] = [
    {
        words: 'A model, as its map has it. The map is built once, in milliseconds, and takes a few dozen bytes a face.',
        enter: (tour) => {
            tour.choose('map', 'exact'); // the paper's has no cells
            tour.choose('view', 'map');
            tour.tell({ kind: 'slice', height: 1 });
        },
    },
    {
        words: 'One ray from the centre outwards. It is thick where it is inside the model: the ray alone answers for every point on it.',
        move: (tour, share) => tour.tell({ kind: 'ray', direction: around(tour.model()!, 0.35 * share) }),
    },
    {
        words: 'Many directions share a cell, outlined here. It knows between which distances surface may lie: its bands, in blue. Outside of them the answer needs no test at all.',
        enter: (tour) => tour.tell({ kind: 'ray', direction: around(tour.model()!, 0.35) }),
    },
    {
        words: 'Cut open: the map\u2019s answers on a plane, red inside. They are decided in whole numbers, so they are exact.',
        move: (tour, share) => tour.tell({ kind: 'slice', height: 0.9 - 1.6 * share }),
    },
    {
        words: 'A cloth asks about each of its particles, many times a second, and each that would be inside is put back the shortest way. Now pull at it.',
        enter: (tour) => {
            tour.tell({ kind: 'slice', height: 1 });
            tour.choose('view', 'cloth');
            tour.tell({ kind: 'restart' });
        },
    },
];

/** Turned from the way to the highest vertex. @param share  of a full turn */
function around({ vertices, centre, up }: ModelNews, share: number): Triple {
    const top = furthestAlong(up, vertices).map((part, k) => part - centre[k]) as Triple;
    const axis = 'xyz'.indexOf(up), [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    const [c, s] = [Math.cos(2 * Math.PI * share), Math.sin(2 * Math.PI * share)];
    const turned: Triple = [...top];
    turned[axis] = top[axis] * (1 - share);
    turned[u] = c * top[u] - s * top[v] + 0.2 * share * top[axis];
    turned[v] = s * top[u] + c * top[v];
    return turned;
}

/** Half a minute on how it works. Enter goes on, Escape ends it. */
export class Tour {
    readonly #wishes: TourWishes;
    #stop = -1;
    #timer = 0;
    #since = 0;

    constructor(wishes: TourWishes) {
        this.#wishes = wishes;
        byId('tour-next').addEventListener('click', () => this.next());
        byId('tour-end').addEventListener('click', () => this.end());
    }

    get runs(): boolean {
        return this.#stop >= 0;
    }

    begin(): void {
        if (!this.#wishes.model()) return;
        this.#stop = -1;
        this.#goOn();
    }
    next(): void {
        if (this.runs) this.#goOn();
    }
    end(): void {
        if (!this.runs) return;
        clearInterval(this.#timer);
        this.#stop = -1;
        byId('tour').hidden = true;
        this.#wishes.tell({ kind: 'slice', height: 1 });
        this.#wishes.choose('view', 'cloth');
    }

    #goOn(): void {
        clearInterval(this.#timer);
        const stop = STOPS[++this.#stop];
        if (!stop) return this.end();
        byId('tour').hidden = false;
        byId('tour').querySelector('p')!.textContent = stop.words;
        byId('tour').dataset.stop = String(this.#stop); // the tests read this
        stop.enter?.(this.#wishes);
        this.#since = performance.now();
        this.#timer = window.setInterval(() => this.#move(stop), STEP_MS);
    }

    #move(stop: Stop): void {
        const share = (performance.now() - this.#since) / STOP_MS;
        if (share >= 1) this.#goOn();
        else if (this.#wishes.model()) stop.move?.(this.#wishes, share);
    }
}
