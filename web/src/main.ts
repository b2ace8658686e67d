/** Starts the page, or shows why it cannot. */
import { missingFeatures } from 'echinus';
import { Client } from './client';
import { byId, make } from './panel/elements';

/** Replaces the whole page by a sentence, a picture of what there would be, and the way to the documents. */
function sayInstead(words: string): void {
    const picture = Object.assign(document.createElement('img'), { src: './card.jpg', alt: 'A red cloth lies over a ring, with folds and a woven border', width: 600, height: 315 });
    const links = make('p', '');
    for (const [name, address] of [['README', './documents/index.html'], ['Documents', './documents/docs.html']]) links.append(Object.assign(document.createElement('a'), { textContent: name, href: address }), ' ');
    const page = document.createElement('div');
    page.className = 'lacking';
    page.setAttribute('role', 'alert');
    page.append(make('h1', 'Echinus'), make('p', words), picture, links);
    document.body.replaceChildren(page);
    document.body.style.display = 'block';
}

const sayWhatIsMissing = (features: string[]) =>
    sayInstead(`This page needs ${features.join(' and ')}, which this browser lacks. Chrome and Edge from 95, Firefox from 100 and Safari from 16.4 have what it needs.`);

async function begin(): Promise<void> {
    byId('subtitle').textContent = 'Loading';
    byId('poster').hidden = location.hash.length > 1; // another example
    const missing = missingFeatures();
    if (missing.length > 0) return sayWhatIsMissing(missing);
    const client = new Client(); // loads the module while three.js is loading
    const app = await import('./app').catch(() => undefined);
    // The context of the page's only canvas, which three.js shares, since creating one is slow without a graphics card.
    // Only now, since it would delay the worker's start.
    if (app && document.querySelector('canvas')!.getContext('webgl2')) return app.begin(client);
    client.stop();
    if (app) sayWhatIsMissing(['WebGL 2']);
    else sayInstead('A part of this page could not be loaded: load the page again.');
}

void begin();
