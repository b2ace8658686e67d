import { type Cuts, type Figures, type MapNews, type ModelNews, isInsideOut } from '../protocol';
import type { Counts } from '../side';
import { FAULT } from '../view/colours';
import { byId, bytes, count, make, milliseconds, numbered, swatch, writeCount } from './elements';
import { remark } from './notice';
import { Slowness } from './slowness';

/** How often the figures are updated: flickering numbers are unreadable. */
const PERIOD_MS = 250;

/** The averaged quantities. */
type Sums = Record<'stepMs' | 'constraintMs' | 'collisionMs', number>;
const NOTHING: Readonly<Sums> = { stepMs: 0, constraintMs: 0, collisionMs: 0 };

/** The strip of figures. Times are means over the steps since the last update. */
export class FigureStrip {
    #drawn = 0;
    #since = performance.now();
    #steps = 0;
    #sums: Sums = { ...NOTHING };
    #mostInside: number | undefined = 0;
    #stepSeconds = 0;
    #countsOwn: boolean | undefined;
    readonly slowness = new Slowness();

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
        if (figures.paused || figures.atRest) this.slowness.forget();
        else this.slowness.add(figures.stepCount * figures.stepSeconds);
    }

    /** A new cloth, of which nothing is known yet: what was counted of the one before is not its own. */
    forgetCounts(): void {
        this.#forgetSteps();
        this.slowness.forget();
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

/** A cloth or a soft body, what is counted of it, and what keeps it from intersecting. */
export interface Cloth {
    /** The half of the picture that the words are about, where there are two. */
    place: string;
    particles: number;
    soft: boolean;
    counts: Counts;
    /** Surfaces collide with the model, and with each other. */
    surfaces: boolean;
    self: boolean;
    /** How many times slower than in life it moves, where it does. */
    slowness: number | undefined;
}

/** One sentence with the page's own figures: what is there, whether it intersects anything, what is off, the map, and the pace. Of the map alone, where no cloth is seen. */
export function showHeadline(map: MapNews, cloth?: Cloth): void {
    const ofMap = `map of ${bytes(map.byteCount)} built in ${milliseconds(map.buildMs)}`;
    const isExact = map.kind === 'exact';
    const parts = cloth
        ? [
              make('span', `${cloth.place}${count(cloth.particles)} ${cloth.soft ? 'particles of a soft body' : 'particles'}, `),
              verdict(cloth),
              make('span', whatIsOff(cloth)),
              make('span', `, ${isExact ? '' : 'the paper\u2019s '}${ofMap}`),
              make('span', cloth.slowness ? `, ${cloth.slowness.toFixed(cloth.slowness < 9.5 ? 1 : 0)}\u00d7 slow motion` : ''),
          ]
        : [make('span', `${isExact ? 'An exact' : 'The paper\u2019s'} ${ofMap}`)];
    // At a thin space a line may end, and a number must not.
    for (const part of parts) part.textContent = part.textContent!.replaceAll('\u2009', '\u202f');
    if (byId('headline').textContent !== parts.map(({ textContent }) => textContent).join('')) byId('headline').replaceChildren(...parts);
}

/** Green is for a cloth that all of collision keeps from intersecting, and that does not intersect. */
function verdict({ counts, self, soft }: Cloth): HTMLElement {
    const wrong = wrongsOf(counts, self);
    if (wrong.length > 0) return make('span', wrong.join(' and '), 'bad');
    if (counts.withModel === undefined) return make('span', counts.inside === undefined ? 'falling' : 'none inside the model');
    if (!self) return make('span', 'no face cuts the model');
    return make('span', `no face cuts the model or the ${soft ? 'body' : 'cloth'} itself`, 'good');
}

function whatIsOff({ counts: { own = 0 }, surfaces, self }: Cloth): string {
    if (self) return '';
    const pairs = own > 0 ? ` (${numbered(own, 'pair', 'pairs')} of its own faces cut each other)` : '';
    return surfaces ? `, self-collision is off${pairs}` : `, only particles collide${pairs}`;
}

/** The faults of a cloth in words. @param self  whether it is kept off itself */
function wrongsOf({ inside = 0, withModel = 0, own = 0 }: Counts, self: boolean): string[] {
    return [
        ...(inside > 0 ? [`${count(inside)} inside the model`] : []),
        ...(withModel > 0 ? [`${numbered(withModel, 'pair', 'pairs')} of faces cut`] : []),
        ...(self && own > 0 ? [`${numbered(own, 'pair', 'pairs')} of its own faces cut each other`] : []),
    ];
}

/** Beneath a half of the picture. */
export function showHalf(id: 'half-left' | 'half-right', title: string, counts: Counts): void {
    const half = byId(id);
    const { inside = 0, withModel } = counts;
    half.querySelector('strong')!.textContent = title;
    const cut = withModel === undefined ? '' : withModel === 0 ? ', none cut' : `, ${numbered(withModel, 'pair', 'pairs')} of faces cut`;
    half.querySelector('span')!.textContent = `${inside === 0 ? 'none' : count(inside)} inside${cut}`;
    half.className = wrongsOf(counts, false).length > 0 ? 'bad' : 'good';
}

/** The mesh report: closed or not, and each fault with the colour that marks it on the model. */
export function showReport({ report, mendedFaces, flippedParts, certainShare }: ModelNews): void {
    const parts = report.componentCount === 1 ? 'one part' : `${count(report.componentCount)} parts`;
    const lines = [
        make('p', `${numbered(report.faceCount, 'face', 'faces')}, ${numbered(report.vertexCount, 'vertex', 'vertices')}, ${parts}`),
        make('p', report.closed ? 'Closed: inside or outside is exact' : 'Open: inside or outside is a guess near the holes', report.closed ? 'good' : 'bad'),
        ...(report.closed ? [] : [make('p', whatOpenMeans(certainShare), 'note')]),
        ...(isInsideOut(report) ? [make('p', 'Inside out: the faces point inwards', 'bad')] : []),
        ...faultLine(report.borderEdges.count, 'border edge', 'border edges', FAULT.borderEdges),
        ...faultLine(report.nonmanifoldEdges.count, 'edge of more than two faces', 'edges of more than two faces', FAULT.nonmanifoldEdges),
        ...faultLine(report.misorientedEdges.count, 'edge of faces with opposite orientation', 'edges of faces with opposite orientation', FAULT.misorientedEdges),
        ...faultLine(report.duplicateFaces.count, 'duplicate face', 'duplicate faces', FAULT.faces),
        ...faultLine(report.degenerateFaces.count, 'face without area', 'faces without area', FAULT.faces),
    ];
    if (mendedFaces > 0) lines.push(make('p', `${numbered(mendedFaces, 'duplicate face', 'duplicate faces')} removed`));
    if (flippedParts > 0) lines.push(make('p', `${numbered(flippedParts, 'inside-out part', 'inside-out parts')} reversed`));
    byId('report').replaceChildren(...lines);
}

/** For visitors who do not know the term. */
function whatOpenMeans(certainShare: number): string {
    const share = `${(100 * certainShare).toFixed(certainShare > 0.995 && certainShare < 1 ? 2 : 0)}\u2009%`;
    return `The faces do not enclose a solid. The answer is certain in ${share} of the bounding sphere. Surface collision keeps the faces of the cloth off the model all the same. All answers are certain once the holes are closed, in a modelling program or by "echinus mesh repair".`;
}

function faultLine(number: number, one: string, many: string, colour: number): HTMLElement[] {
    if (number === 0) return [];
    const line = make('p', numbered(number, one, many));
    line.prepend(swatch(colour));
    return [line];
}
