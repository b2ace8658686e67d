import type { Cuts, Figures, MapNews } from '../protocol';
import { byId, writeCount } from './elements';
import { remark } from './notice';
import { bytes, milliseconds, perSecond } from './numbers';

/** How often the figures are updated: flickering numbers are unreadable. */
const PERIOD_MS = 250;

/** The averaged quantities. */
type Sums = Record<'stepMs' | 'constraintMs' | 'collisionMs' | 'queriesPerSecond', number>;
const NOTHING: Readonly<Sums> = { stepMs: 0, constraintMs: 0, collisionMs: 0, queriesPerSecond: 0 };

/** The strip of figures. Times are means over the steps since the last update. */
export class FigureStrip {
    #drawn = 0;
    #since = performance.now();
    #steps = 0;
    #sums: Sums = { ...NOTHING };
    #mostInside: number | undefined = 0;
    #stepSeconds = 0;
    #countsOwn: boolean | undefined;

    constructor() {
        // A finger sees no titles.
        for (const figure of document.querySelectorAll<HTMLElement>('#figures > [title]')) figure.addEventListener('click', () => remark(`${figure.querySelector('dt')!.textContent}: ${figure.title}`));
    }

    countDrawing(): void {
        ++this.#drawn;
        const now = performance.now();
        if (now - this.#since < PERIOD_MS) return;
        byId('figure-fps').textContent = ((1000 * this.#drawn) / (now - this.#since)).toFixed(0);
        if (this.#steps > 0) this.#writeMeans();
        this.#drawn = 0;
        this.#since = now;
    }

    add(figures: Figures): void {
        this.#steps += figures.stepCount;
        this.#stepSeconds = figures.stepSeconds;
        for (const key of Object.keys(NOTHING) as (keyof Sums)[]) this.#sums[key] += figures.stepCount * figures[key];
        // The largest since the last update: a single frame with a particle inside must not go unnoticed.
        this.#mostInside = figures.inside === undefined ? undefined : Math.max(this.#mostInside ?? 0, figures.inside);
        if (figures.stepCount === 0) this.#writeInside();
    }

    /** A new cloth, of which nothing is known yet: what was counted of the one before is not its own. */
    forgetCounts(): void {
        this.#forgetSteps();
        writeCount('figure-inside', undefined);
        writeCount('figure-pairs', undefined);
        this.#writeOwn(undefined);
    }
    showCuts({ withModel, own }: Cuts): void {
        writeCount('figure-pairs', withModel);
        this.#writeOwn(own);
    }
    /** A cloth that need not keep off itself does nothing wrong. */
    set countsOwn(counts: boolean) {
        if (counts === this.#countsOwn) return;
        this.#countsOwn = counts;
        this.#writeOwn(undefined);
    }
    #writeOwn(own: number | undefined): void {
        if (this.#countsOwn) writeCount('figure-own-pairs', own);
        else writeCount('figure-own-pairs', undefined, 'off');
    }

    showMap({ byteCount, buildMs }: MapNews): void {
        byId('figure-bytes').textContent = bytes(byteCount);
        byId('figure-build').textContent = milliseconds(buildMs);
    }

    #writeMeans(): void {
        const mean = (key: keyof Sums) => this.#sums[key] / this.#steps;
        byId('name-step').textContent = `a ${milliseconds(1000 * this.#stepSeconds)} step takes`;
        byId('figure-step').textContent = milliseconds(mean('stepMs'));
        byId('figure-constraints').textContent = milliseconds(mean('constraintMs'));
        byId('figure-collision').textContent = milliseconds(mean('collisionMs'));
        byId('figure-queries').textContent = perSecond(mean('queriesPerSecond'));
        this.#writeInside();
        this.#forgetSteps();
    }

    #writeInside(): void {
        writeCount('figure-inside', this.#mostInside, 'no inside'); // of an open model
        this.#mostInside = 0;
    }
    #forgetSteps(): void {
        this.#steps = 0;
        this.#sums = { ...NOTHING };
        this.#mostInside = 0;
    }
}
