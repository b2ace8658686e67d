import { SAMPLES, type Sample, type Settings, fromLink, toLink } from './settings';
import { byId, make } from './panel/elements';

interface Example {
    /** Of its picture. */
    name: string;
    title: string;
    caption: string;
    link: string;
    model: Sample;
}

/** The examples of the gallery; scripts/web --pictures takes their pictures. */
const EXAMPLES: readonly Example[] = [
    { name: 'horse', title: 'A cloth on a horse', caption: 'no ear comes through', link: '', model: 'horse' },
    { name: 'torus', title: 'A cloth on a torus', caption: 'with 2\u2009500 particles', link: 'model=torus&particles=2500', model: 'torus' },
    { name: 'figure', title: 'A skirt, dancing', caption: 'on a figure that moves', link: 'model=figure', model: 'figure' },
    { name: 'organ', title: 'A soft organ', caption: 'push it with the probe', link: 'model=organ&hand=model', model: 'organ' },
    { name: 'ring', title: 'Through a ring', caption: 'pulled through, and released', link: 'model=ring', model: 'ring' },
    { name: 'flag', title: 'A flag in the wind', caption: 'shake its pole', link: 'model=flag', model: 'flag' },
    { name: 'layers', title: 'Five layers', caption: 'no layer through another', link: 'model=layers&particles=1000', model: 'layers' },
    { name: 'beside', title: 'Exact or approximate', caption: 'two maps, side by side', link: 'beside=map', model: 'horse' },
];

export function fillGallery(): void {
    const tiles = EXAMPLES.filter(({ model }) => SAMPLES.includes(model)).map(({ name, title, caption, link }) => {
        const tile = make('a', '', 'tile') as HTMLAnchorElement;
        tile.href = `#${link}`;
        fill(tile, `./gallery/${name}.jpg`, title, caption);
        return tile;
    });
    const own = make('label', '', 'tile own') as HTMLLabelElement;
    own.htmlFor = 'file';
    fill(own, undefined, 'Your own file', 'or drop it on the page');
    byId('gallery').replaceChildren(...tiles, own);
}

/** Marks the example that the page shows, if it is one of them. */
export function showChosen(settings: Settings | undefined): void {
    const now = settings && toLink({ ...settings, camera: '', view: 'cloth' });
    for (const tile of byId('gallery').querySelectorAll<HTMLAnchorElement>('a')) tile.classList.toggle('chosen', now === toLink(fromLink(tile.hash)));
}

function fill(tile: HTMLElement, address: string | undefined, title: string, caption: string): void {
    if (address) {
        const picture = document.createElement('img');
        Object.assign(picture, { src: address, alt: '', width: 120, height: 90, loading: 'lazy', decoding: 'async' });
        tile.append(picture);
    } else tile.append(make('i', '+'));
    tile.append(make('span', title), make('small', caption));
}
