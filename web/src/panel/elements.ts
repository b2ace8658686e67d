import { SCALE } from '../view/colours';
import { count } from './numbers';

/** The element of index.html with this id. */
export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
    const element = document.getElementById(id);
    if (!element) throw new Error(`index.html has no element "${id}"`);
    return element as T;
}

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
