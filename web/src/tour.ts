import { furthestAlong } from './frames';
import { byId, count, prefersStillness } from './panel/elements';
import type { ModelNews, Triple } from './protocol';
import type { Settings } from './settings';

interface TourWishes {
    model(): ModelNews | undefined;
    settings(): Settings;
    choose<K extends keyof Settings>(key: K, value: Settings[K]): void;
    restart(): void;
    /** Going back in the browser ends what begins now. */
    enter(): void;
    /** Leaves the browser's entry that enter() has made. */
    exit(): void;
    /** Shows the map along this way from its centre; undefined: along none. */
    showRay(direction: Triple | undefined): void;
    /** Cuts the map open at this height; the visitor's own setting stays. */
    cut(height: number): void;
    /** The directions in which the picture goes up and right. */
    picture(): { up: Triple; right: Triple };
}

/** How long a stop lasts. */
const STOP_MS = 6500;
/** How often the moving part of a stop moves. */
const STEP_MS = 50;

interface Stop {
    words: string | ((tour: TourWishes) => string);
    /** At the beginning. */
    enter?(tour: TourWishes): void;
    /** @param share  of the stop that has passed */
    move?(tour: TourWishes, share: number): void;
}

/** The last one waits for the visitor, who may be pulling the cloth. */
const STOPS: readonly Stop[] = [
    {
        words: (tour) => `This is the map of the model. The colour of a face shows how many faces a query near it may have to test: few of the ${count(tour.model()!.report.faceCount)}. The map is built once, in milliseconds.`,
        enter: (tour) => {
            tour.choose('map', 'exact'); // the paper's has no cells
            tour.choose('view', 'map');
            tour.cut(1);
            tour.showRay(undefined);
        },
    },
    {
        words: 'A ray leaves the centre. It is thick where it is inside the model. The crossings of the ray with the surface decide for all of its points whether they are inside or outside.',
        move: (tour, share) => tour.showRay(acrossPicture(tour, share)),
    },
    {
        words: 'Many directions share a cell; its outline is drawn here. The cell stores the distances at which there may be surface: its bands, in blue. Between the bands a query needs no test at all.',
        enter: (tour) => tour.showRay(acrossPicture(tour, 1)),
    },
    {
        words: 'A cut through the model shows the answers of the map on a plane: red is inside. The map decides by integer arithmetic, so the answers are exact.',
        enter: (tour) => tour.showRay(undefined),
        move: (tour, share) => tour.cut(0.9 - 1.6 * share),
    },
    {
        words: 'The simulation asks the map about the particles and the faces of the cloth in each step, and keeps them outside. Pull the cloth now.',
        enter: (tour) => {
            tour.cut(tour.settings().slice);
            tour.choose('view', 'cloth');
            tour.restart();
        },
    },
];

/** From the vertex that is highest in the picture to the one farthest right, so that the ray is seen from the side and meets the model at both ends. */
function acrossPicture(tour: TourWishes, share: number): Triple {
    const { vertices, centre } = tour.model()!;
    const { up, right } = tour.picture();
    const [from, to] = [up, right].map((direction) => unit(furthestAlong(direction, vertices).map((part, k) => part - centre[k])));
    return from.map((part, k) => (1 - share) * part + share * to[k]) as Triple;
}

function unit(vector: number[]): number[] {
    const length = Math.hypot(...vector) || 1;
    return vector.map((part) => part / length);
}

/** Half a minute on how it works. Enter goes on, Escape ends it. */
export class Tour {
    readonly #wishes: TourWishes;
    #stop = -1;
    #timer = 0;
    /** When the stop began, and how much of it had passed when the visitor paused it. */
    #since = 0;
    #passed = 0;
    #paused = false;
    /** The visitor's choice before the tour. */
    #before: Settings['map'] = 'exact';

    constructor(wishes: TourWishes) {
        this.#wishes = wishes;
        byId('tour-back').addEventListener('click', () => this.#goTo(this.#stop - 1));
        byId('tour-pause').addEventListener('click', () => this.#pause(!this.#paused));
        byId('tour-next').addEventListener('click', () => this.next());
        byId('tour-end').addEventListener('click', () => this.end());
    }

    get runs(): boolean {
        return this.#stop >= 0;
    }

    begin(): void {
        if (!this.#wishes.model()) return;
        if (!this.runs) {
            this.#before = this.#wishes.settings().map;
            this.#pause(false);
            this.#wishes.enter();
        }
        scrollTo({ top: 0 }); // on a small screen its button is far below the picture
        this.#goTo(0);
    }
    next(): void {
        if (this.runs) this.#goTo(this.#stop + 1);
    }
    end(): void {
        if (!this.runs) return;
        this.#wishes.exit();
        this.restore();
    }
    /** Back to the cloth, and to the visitor's own map. */
    restore(): void {
        if (!this.runs) return;
        this.leave();
        this.#wishes.choose('view', 'cloth');
        this.#wishes.choose('map', this.#before);
    }
    /** Where the visitor goes elsewhere. */
    leave(): void {
        if (!this.runs) return;
        clearInterval(this.#timer);
        this.#stop = -1;
        byId('tour').hidden = true;
        this.#wishes.cut(this.#wishes.settings().slice);
    }

    #goTo(number: number): void {
        clearInterval(this.#timer);
        const stop = STOPS[number];
        if (!stop) return this.end();
        const isLast = number === STOPS.length - 1;
        this.#stop = number;
        byId('tour').hidden = false;
        byId('tour').querySelector('p')!.textContent = typeof stop.words === 'string' ? stop.words : stop.words(this.#wishes);
        byId('tour').dataset.stop = String(number); // the tests read this
        byId('tour-place').textContent = `${number + 1} of ${STOPS.length}`;
        byId('tour-back').hidden = number === 0;
        byId('tour-pause').hidden = isLast || prefersStillness();
        byId('tour-next').textContent = isLast ? 'Done' : 'Next';
        byId('tour-end').hidden = isLast;
        stop.enter?.(this.#wishes);
        this.#passed = 0;
        if (prefersStillness() || this.#paused) stop.move?.(this.#wishes, 1);
        else if (!isLast) this.#run();
    }

    /** A stop that the visitor has paused waits, and so do those that follow, until the visitor resumes. */
    #pause(paused: boolean): void {
        this.#paused = paused;
        byId('tour-pause').textContent = paused ? 'Resume' : 'Pause';
        if (!this.runs) return;
        clearInterval(this.#timer);
        if (paused) this.#passed = performance.now() - this.#since;
        else this.#run();
    }

    #run(): void {
        this.#since = performance.now() - this.#passed;
        this.#timer = window.setInterval(() => this.#move(STOPS[this.#stop]), STEP_MS);
    }

    #move(stop: Stop): void {
        const share = (performance.now() - this.#since) / STOP_MS;
        if (share >= 1) this.next();
        else if (this.#wishes.model()) stop.move?.(this.#wishes, share);
    }
}
