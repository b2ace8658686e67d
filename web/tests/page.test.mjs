// What a visitor sees and does, in Chromium, on the page as it is built.
import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { figure, numberOf, picture, startBrowser, untilFrame } from './support.mjs';

const hasHorse = existsSync(fileURLToPath(new URL('../dist/models/horse.3ds', import.meta.url)));
// Software draws these; small pages leave it time for the cloth.
const SMALL = { viewport: { width: 900, height: 480 } };
const OPEN_TETRAHEDRON = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n';

let browser;
before(async () => (browser = await startBrowser()));
after(() => browser?.stop());

const drop = (page, name, text) => page.locator('#file').setInputFiles({ name, mimeType: 'text/plain', buffer: Buffer.from(text) });
const untilReport = (page, words) => page.waitForFunction((part) => document.getElementById('report').textContent.includes(part), words);

test('the page opens with the cloth already falling, and its console has nothing to say', async () => {
    const page = await browser.open();
    await untilFrame(page, 40);
    assert.equal(await figure(page, 'inside'), '0');
    assert.ok(numberOf(await figure(page, 'bytes')) > 0);
    assert.match(await page.locator('#subtitle').textContent(), hasHorse ? /^horse\.3ds, 7\u2009160 faces$/ : /^torus/);
    await picture(page, 'opened');
    assert.deepEqual(page.complaints, []);
    await page.context().close();
});

test('a page that carries the horse carries the notice and the text of its licence', { skip: !hasHorse && 'the horse is not installed' }, async () => {
    const page = await browser.open('#particles=100', SMALL);
    await untilFrame(page, 1);
    const notice = page.locator('#horse-notice a');
    assert.ok(await notice.isVisible());
    for (const file of ['models/NOTICE.txt', 'models/GPL-3.txt', 'LICENSES.txt']) assert.ok((await page.request.get(new URL(file, page.url()).href)).ok(), file);
    await page.context().close();
});

test('the cloth comes to rest with no particle inside', async () => {
    const page = await browser.open('#model=torus&particles=900', SMALL);
    await page.waitForFunction(() => document.body.dataset.rest === 'true', null, { timeout: 120_000 });
    assert.equal(await figure(page, 'inside'), '0');
    await picture(page, 'rest');
    await page.context().close();
});

test('a pause holds the cloth, a step moves it by one frame, and it can be dropped again', async () => {
    const page = await browser.open('#model=sphere&particles=400', SMALL);
    await untilFrame(page, 20);
    await page.keyboard.press('Space');
    assert.equal(await page.locator('#pause').textContent(), 'Go on');
    await page.waitForFunction(() => document.body.dataset.paused === 'true'); // frames that were under way are here
    const frame = () => page.evaluate(() => Number(document.body.dataset.frame));
    const held = await frame();
    await page.waitForTimeout(300);
    assert.equal(await frame(), held);
    await page.locator('#step').click();
    await page.waitForFunction((next) => Number(document.body.dataset.frame) === next, held + 1);
    await page.locator('#restart').click();
    await page.waitForFunction((before) => Number(document.body.dataset.frame) < before, held);
    await page.context().close();
});

test('a broken file gives one sentence, and the page lives on', async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await untilFrame(page, 5);
    await drop(page, 'broken.obj', 'v 0 0 0\nf 1 2 9\n');
    await page.locator('#notice').waitFor();
    assert.match(await page.locator('#notice span').textContent(), /^broken\.obj.*2/);
    await picture(page, 'broken_file');
    const frame = await page.evaluate(() => Number(document.body.dataset.frame));
    await untilFrame(page, frame + 20);
    assert.match(await page.locator('#subtitle').textContent(), /^torus/);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
});

test('an open mesh is said to be open, and its border is counted', async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await untilFrame(page, 1);
    await drop(page, 'open.obj', OPEN_TETRAHEDRON);
    await untilReport(page, '3 border edges');
    assert.match(await page.locator('#report').textContent(), /Open/);
    await page.locator('input[name=map][value=distance]').check();
    await page.waitForFunction(() => document.getElementById('map-note').textContent.includes('paper') || !document.getElementById('notice').hidden);
    const frame = await page.evaluate(() => Number(document.body.dataset.frame));
    await page.locator('#restart').click();
    await untilFrame(page, Math.max(5, Math.min(20, frame)));
    await picture(page, 'open_mesh');
    await page.context().close();
});

/** A tetrahedron as the binary kind of glTF: a header, a JSON chunk, a chunk of numbers. */
function tetrahedronGlb() {
    const numbers = Buffer.concat([
        Buffer.from(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]).buffer),
        Buffer.from(new Uint16Array([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]).buffer),
    ]);
    const json = JSON.stringify({
        asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
        meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
        buffers: [{ byteLength: numbers.length }],
        bufferViews: [{ buffer: 0, byteOffset: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 24 }],
        accessors: [
            { bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 1] },
            { bufferView: 1, componentType: 5123, count: 12, type: 'SCALAR' },
        ],
    });
    const text = Buffer.from(json.padEnd(4 * Math.ceil(json.length / 4)));
    const words = (...values) => Buffer.from(new Uint32Array(values).buffer);
    return Buffer.concat([
        words(0x46546c67, 2, 28 + text.length + numbers.length), words(text.length, 0x4e4f534a), text, words(numbers.length, 0x004e4942), numbers,
    ]);
}

test('a GLB file is opened', async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await untilFrame(page, 1);
    await drop(page, 'tetrahedron.glb', tetrahedronGlb());
    await untilReport(page, '4 faces, 4 vertices, one part');
    assert.match(await page.locator('#report').textContent(), /Closed/);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
});

test('nobody gets into a model that swings in the wind', async () => {
    const page = await browser.open('#model=torus&particles=900&motion=swinging&wind=6', SMALL);
    await untilFrame(page, 300);
    assert.equal(await figure(page, 'inside'), '0');
    assert.deepEqual(page.complaints, []);
    await page.context().close();
});

test('a link gives the state that it was copied from', async () => {
    const page = await browser.open('#model=sphere&map=distance&particles=2500&friction=0.9&view=map', SMALL);
    await page.waitForFunction(() => document.getElementById('map-figures').textContent.includes('directions'));
    assert.equal(await page.locator('select[name=model]').inputValue(), 'sphere');
    assert.ok(await page.locator('input[name=map][value=distance]').isChecked());
    await page.locator('input[name=view][value=cloth]').check();
    await page.waitForFunction(() => location.hash === '#model=sphere&map=distance&particles=2500&friction=0.9');
    await page.context().close();
});

test('the saved mesh is an OBJ file of the cloth and the model', async () => {
    const page = await browser.open('#model=sphere&particles=400', SMALL);
    await untilFrame(page, 2);
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#save-mesh').click()]);
    const text = await readFile(await download.path(), 'utf8');
    const { length } = text.match(/^v /gm);
    assert.equal(length, 400 + (await page.evaluate(() => Number(/faces, ([\d\u2009]+) vertices/.exec(document.getElementById('report').textContent)[1].replace('\u2009', '')))));
    await page.context().close();
});

test('the saved picture is a PNG file of the canvas', async () => {
    const page = await browser.open('#model=sphere&particles=400', SMALL);
    await untilFrame(page, 2);
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#save-picture').click()]);
    const bytes = await readFile(await download.path());
    const { width, height } = await page.locator('#canvas').boundingBox();
    assert.equal(bytes.toString('latin1', 1, 4), 'PNG');
    assert.deepEqual([bytes.readUInt32BE(16), bytes.readUInt32BE(20)], [Math.round(width), Math.round(height)]);
    await page.context().close();
});

test('the map is shown in colours with its figures', async () => {
    const page = await browser.open('#view=map');
    await page.waitForFunction(() => document.getElementById('ray').textContent.includes('side'));
    await page.waitForTimeout(500);
    await picture(page, 'map');
    // The first build of all includes the browser's compiling.
    for (let turn = 0; turn < 8; ++turn) {
        await page.evaluate(() => (document.getElementById('figure-build').textContent = ''));
        await page.locator('#rebuild').click();
        await page.waitForFunction(() => document.getElementById('figure-build').textContent !== '');
        if (numberOf(await figure(page, 'build')) < 50) break;
    }
    assert.ok(numberOf(await figure(page, 'build')) < 50, await figure(page, 'build'));
    assert.deepEqual(page.complaints, []);
    await page.context().close();
});

test('a narrow screen shows everything without scrolling sideways', async () => {
    const page = await browser.open('#particles=2500', { viewport: { width: 390, height: 844 }, hasTouch: true });
    await untilFrame(page, 30);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await picture(page, 'narrow');
    await page.context().close();
});

test('a pull wakes a cloth at rest, and nobody is dragged into the model', async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await page.waitForFunction(() => document.body.dataset.rest === 'true', null, { timeout: 120_000 });
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    const frame = await page.evaluate(() => Number(document.body.dataset.frame));
    await page.mouse.move(x + 0.5 * width, y + 0.5 * height);
    await page.mouse.down();
    assert.ok(await page.locator('#canvas.dragging').isVisible());
    await page.mouse.move(x + 0.5 * width, y + 0.9 * height, { steps: 4 });
    await untilFrame(page, frame + 60);
    await page.waitForTimeout(400); // until the figures are written again
    assert.equal(await figure(page, 'inside'), '0');
    await picture(page, 'dragged');
    await page.mouse.up();
    await page.waitForFunction(() => !document.querySelector('#canvas.dragging'));
    await page.context().close();
});

test("the paper's map is shown in layers, cut open, with the points where it differs", async () => {
    const page = await browser.open('#view=map&map=distance&slice=0.1');
    await page.waitForFunction(() => document.getElementById('legend').textContent.includes('layer 2') || document.getElementById('legend').textContent.includes('layer 1'));
    await page.waitForTimeout(500);
    await picture(page, 'map_distance');
    assert.deepEqual(page.complaints, []);
    await page.context().close();
});

test('in the dark the page is dark', async () => {
    const page = await browser.open('#model=torus&particles=2500&colour=distance', { colorScheme: 'dark' });
    await untilFrame(page, 160);
    assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), 'rgb(27, 29, 33)');
    await picture(page, 'dark');
    await page.context().close();
});

test('a browser without vectors is told what it lacks', async () => {
    const page = await browser.open('', { ...SMALL, beforeLoad: () => (WebAssembly.validate = () => false) });
    await page.locator('.lacking').waitFor();
    assert.match(await page.locator('.lacking').textContent(), /needs WebAssembly SIMD/);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
});
