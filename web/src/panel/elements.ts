import { SCALE, WRONG } from '../view/colours';

/** Numbers as the page writes them. */
const grouped = new Intl.NumberFormat('en', { maximumFractionDigits: 0 });

/** 10 000: thin spaces, which no country reads as a decimal point. */
export const count = (value: number): string => grouped.format(value).replaceAll(',', '\u2009');

/** 1 face, 2 faces. */
export const numbered = (value: number, one: string, many: string): string => `${count(value)} ${value === 1 ? one : many}`;

export function milliseconds(value: number): string {
    return `${value.toFixed(value < 10 ? 2 : value < 100 ? 1 : 0)}\u2009ms`;
}

export function bytes(value: number): string {
    return value < 1e6 ? `${(value / 1e3).toFixed(value < 1e5 ? 1 : 0)}\u2009kB` : `${(value / 1e6).toFixed(1)}\u2009MB`;
}

/** In two digits, since rates of small cloths are rough. */
export function perSecond(value: number): string {
    const [unit, name] = value >= 1e6 ? [1e6, 'M'] : [1e3, 'k'];
    return `${Number((value / unit).toPrecision(2))}\u2009${name}`;
}

/** The element of index.html with this id. */
export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
    const element = document.getElementById(id);
    if (!element) throw new Error(`index.html has no element "${id}"`);
    return element as T;
}

/** Does the visitor's system ask for little motion? */
export const prefersStillness = (): boolean => matchMedia('(prefers-reduced-motion: reduce)').matches;

export function make(tag: string, text: string, className = ''): HTMLElement {
    const element = document.createElement(tag);
    element.textContent = text;
    element.className = className;
    return element;
}

export function swatch(colour: number): HTMLElement {
    const element = make('span', '', 'swatch');
    element.style.background = css(colour);
    return element;
}

/** The palette's scale, from light to dark. */
export function scaleBar(): HTMLElement {
    const bar = make('div', '', 'scale');
    bar.style.background = `linear-gradient(to right, ${SCALE.map(css).join(', ')})`;
    return bar;
}

const css = (colour: number): string => `#${colour.toString(16).padStart(6, '0')}`;

/** A number that should be 0, as a figure. @param instead  what the figure says where there is no number */
export function writeCount(id: string, number: number | undefined, instead = '\u2013'): void {
    const cell = byId(id);
    cell.textContent = number === undefined ? instead : count(number);
    cell.parentElement!.classList.toggle('some', number !== undefined && number > 0);
    cell.parentElement!.classList.toggle('none', number === 0);
}

/** The legend of the cloth's colours: depth in the layer of contact, as measured by the worker (worker/judge.ts). */
export function fillDepthLegend(): void {
    const ends = make('div', '', 'ends');
    ends.append(make('span', 'no contact'), make('span', 'at the thickness'), make('span', 'on the surface'));
    const inside = make('span', 'inside');
    inside.prepend(swatch(WRONG));
    byId('depth-legend').replaceChildren(scaleBar(), ends, inside);
}
