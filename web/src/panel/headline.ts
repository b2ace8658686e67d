import type { MapNews } from '../protocol';
import type { Counts } from '../side';
import { byId, make } from './elements';
import { bytes, count, milliseconds, numbered } from './numbers';

/** What falls, and what is counted of it. */
export interface Cloth {
    particles: number;
    soft: boolean;
    counts: Counts;
}

/** One sentence with the page's own figures: what is there, that nothing is wrong with it, and what that took. Of the map alone, where no cloth is seen. */
export function showHeadline(map: MapNews, cloth?: Cloth): void {
    const ofMap = `map of ${bytes(map.byteCount)} built in ${milliseconds(map.buildMs)}`;
    const isExact = map.kind === 'exact';
    const parts = cloth
        ? [
              make('span', `${count(cloth.particles)} ${cloth.soft ? 'particles of a soft body' : 'particles'}, `),
              verdict(cloth.counts),
              make('span', `, ${isExact ? 'a' : 'the paper\u2019s'} ${ofMap}`),
          ]
        : [make('span', `${isExact ? 'An exact' : 'The paper\u2019s'} ${ofMap}`)];
    // At a thin space a line may end, and a number must not.
    for (const part of parts) part.textContent = part.textContent!.replaceAll('\u2009', '\u202f');
    if (byId('headline').textContent !== parts.map(({ textContent }) => textContent).join('')) byId('headline').replaceChildren(...parts);
}

function verdict(counts: Counts): HTMLElement {
    const wrong = wrongsOf(counts);
    if (wrong.length > 0) return make('span', wrong.join(' and '), 'bad');
    if (counts.withModel !== undefined) return make('span', 'no face through the model', 'good');
    return counts.inside === undefined ? make('span', 'falling') : make('span', 'none inside the model', 'good');
}

/** What is wrong with a cloth, in words; nothing, where nothing is. */
function wrongsOf({ inside = 0, withModel = 0 }: Counts): string[] {
    return [
        ...(inside > 0 ? [`${count(inside)} inside the model`] : []),
        ...(withModel > 0 ? [`${count(withModel)} ${withModel === 1 ? 'pair of faces' : 'pairs of faces'} cut`] : []),
    ];
}

/** Beneath a half of the picture. */
export function showHalf(id: 'half-left' | 'half-right', title: string | undefined, counts: Counts): void {
    const half = byId(id);
    const { inside = 0, withModel } = counts;
    if (title) half.querySelector('strong')!.textContent = title;
    const cut = withModel === undefined ? '' : withModel === 0 ? ', none cut' : `, ${numbered(withModel, 'pair', 'pairs')} of faces cut`;
    half.querySelector('span')!.textContent = `${inside === 0 ? 'none' : count(inside)} inside${cut}`;
    half.className = wrongsOf(counts).length > 0 ? 'bad' : 'good';
}
