/** Begins the page, or says what this browser lacks. */
import { missingFeatures } from 'echinus';
import { Client } from './client';

const missing = missingFeatures();
if (missing.length === 0) {
    const client = new Client(); // loads the module while three.js is on its way
    const { begin } = await import('./app');
    // Of the page's one canvas, since a context takes long where there is no graphics card: three.js gets the same. Only
    // now, since the worker does not begin while this waits.
    if (document.querySelector('canvas')!.getContext('webgl2')) begin(client);
    else missing.push('WebGL 2');
}
if (missing.length > 0) {
    const sentence = document.createElement('p');
    sentence.textContent = `This page needs ${missing.join(' and ')}, which this browser lacks. Chrome and Edge from 95, Firefox from 100 and Safari from 16.4 have what it needs.`;
    const title = document.createElement('h1');
    title.textContent = 'Echinus';
    const page = document.createElement('div');
    page.className = 'lacking';
    page.setAttribute('role', 'alert');
    page.append(title, sentence);
    document.body.replaceChildren(page);
    document.body.style.display = 'block';
}
