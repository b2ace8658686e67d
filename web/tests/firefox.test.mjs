// The page in another browser: Debian's Firefox, where it is installed (scripts/setup --firefox).
import assert from 'node:assert/strict';
import { mkdirSync, writeFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { hasFirefox, startFirefox } from './firefox.mjs';
import { tetrahedra } from './meshes.mjs';
import { inProject, serve } from './support.mjs';

const skip = !hasFirefox && 'Firefox is not installed (scripts/setup --firefox)';

let server, address, page;
before(async () => {
    if (skip) return;
    ({ server, address } = await serve(keepComplaints));
    page = await startFirefox({ width: 900, height: 700 });
});
after(async () => {
    await page?.stop();
    server?.close();
});

/** Runs in the page before its own code. */
function keepComplaints() {
    window.complaints = [];
    for (const kind of ['error', 'warn']) {
        const own = console[kind];
        console[kind] = (...words) => (window.complaints.push(words.join(' ')), own(...words));
    }
    addEventListener('error', ({ message }) => window.complaints.push(message));
    addEventListener('unhandledrejection', ({ reason }) => window.complaints.push(String(reason)));
}

const frame = () => page.run(() => Number(document.body.dataset.frame));
const untilFrame = (least) => page.until((least) => Number(document.body.dataset.frame) >= least, least);
const picture = async (name) => {
    mkdirSync(inProject('out/web'), { recursive: true });
    writeFileSync(inProject(`out/web/${name}.png`), await page.picture());
};

test('in Firefox the page opens with a falling cloth, no face of which is through the model', { skip }, async () => {
    await page.open(`${address}#model=torus&particles=900`);
    await page.until(() => /no face cuts the model/.test(document.getElementById('headline').textContent));
    await untilFrame(15);
    assert.equal(await page.run(() => document.getElementById('figure-inside').textContent), '0');
    await picture('firefox');
    assert.deepEqual(await page.run(() => window.complaints), []);
});

test('in Firefox the mouse turns the view, and pulls the cloth', { skip }, async () => {
    const { x, y, width, height } = await page.run(() => document.getElementById('canvas').getBoundingClientRect().toJSON());
    const at = (across, down) => [x + across * width, y + down * height];
    await page.drag([at(0.05, 0.4), at(0.15, 0.42), at(0.3, 0.45)]);
    await page.until(() => location.hash.includes('camera='));
    await page.run(() => {
        window.dragged = false;
        new MutationObserver(() => (window.dragged ||= document.getElementById('canvas').classList.contains('dragging'))).observe(document.getElementById('canvas'), { attributes: true });
    });
    const before = await frame();
    await page.drag([at(0.5, 0.5), at(0.5, 0.6), at(0.5, 0.7)]);
    await page.until(() => window.dragged);
    await untilFrame(before + 8);
    assert.equal(await page.run(() => document.getElementById('figure-inside').textContent), '0');
    assert.deepEqual(await page.run(() => window.complaints), []);
});

test('in Firefox a file that is dropped on the page is opened, and its map is shown', { skip }, async () => {
    await page.run((text) => {
        const dataTransfer = new DataTransfer();
        dataTransfer.items.add(new File([text], 'dropped.off'));
        for (const type of ['dragover', 'drop']) document.getElementById('canvas').dispatchEvent(new DragEvent(type, { bubbles: true, cancelable: true, dataTransfer }));
    }, tetrahedra()['t.off']);
    await page.until(() => document.getElementById('subtitle').textContent.startsWith('dropped.off, 4 faces'));
    await untilFrame(20);
    await page.run(() => document.querySelector('input[name=view][value=map]').click());
    await page.until(() => document.getElementById('ray').textContent.includes('side'));
    await picture('firefox_map');
    assert.deepEqual(await page.run(() => window.complaints), []);
});

test('in Firefox the figure deforms with its skirt on it', { skip }, async () => {
    await page.open(`${address}#model=figure&particles=600`);
    await page.until(() => /no face cuts the model/.test(document.getElementById('headline').textContent));
    await untilFrame(30);
    await picture('firefox_figure');
    assert.match(await page.run(() => document.getElementById('headline').textContent), /no face cuts the model/);
    assert.deepEqual(await page.run(() => window.complaints), []);
});
