// The visitor's ball, a model that is shaken, a clip, the tour, and what takes long.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { tetrahedra, torusStl } from './meshes.mjs';
import { SMALL, figure, picture, startBrowser, untilFrame } from './support.mjs';

let browser;
before(async () => (browser = await startBrowser()));
after(() => browser?.stop());

const frameOf = (page) => page.evaluate(() => Number(document.body.dataset.frame));

/** The vertices of an object of the saved mesh. */
async function verticesOf(page, name) {
    // Not by the mouse, which may hold something.
    const [download] = await Promise.all([page.waitForEvent('download'), page.evaluate(() => document.getElementById('save-mesh').click())]);
    const text = await readFile(await download.path(), 'utf8');
    const part = text.slice(text.indexOf(`o ${name}`)).split('\n').slice(1);
    const end = part.findIndex((line) => line.startsWith('o '));
    return part.slice(0, end < 0 ? part.length : end).filter((line) => line.startsWith('v ')).map((line) => line.split(' ').slice(1).map(Number));
}

test('a ball follows the pointer, pushes the cloth, and gets no particle into the model', async () => {
    const page = await browser.open('#model=torus&particles=900', SMALL);
    await untilFrame(page, 50);
    const before = await verticesOf(page, 'cloth');
    await page.locator('input[name=hand][value=ball]').check();
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    for (const [across, down] of [[0.3, 0.55], [0.45, 0.5], [0.5, 0.55], [0.6, 0.6]]) {
        await page.mouse.move(x + across * width, y + down * height);
        await untilFrame(page, 15 + (await frameOf(page)));
    }
    await picture(page, 'ball');
    const after = await verticesOf(page, 'cloth');
    const moved = after.map((point, i) => Math.hypot(...point.map((c, k) => c - before[i][k])));
    assert.ok(Math.max(...moved) > 0.1, `by at most ${Math.max(...moved)}`);
    assert.equal(await figure(page, 'inside'), '0');
    await page.locator('input[name=hand][value=cloth]').check();
    await untilFrame(page, 8 + (await frameOf(page)));
    assert.equal(await page.locator('#notice').isVisible(), false);
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a model that is shaken moves, takes the cloth along, and comes back', async () => {
    const page = await browser.open('#model=torus&particles=900&hand=model', SMALL);
    await untilFrame(page, 50);
    const still = await verticesOf(page, 'model');
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    await page.mouse.move(x + 0.5 * width, y + 0.5 * height);
    await page.mouse.down();
    assert.ok(await page.locator('#canvas.dragging').isVisible());
    await page.mouse.move(x + 0.6 * width, y + 0.4 * height, { steps: 3 });
    await untilFrame(page, 22 + (await frameOf(page)));
    const away = (points) => Math.hypot(...points[0].map((c, k) => c - still[0][k]));
    assert.ok(away(await verticesOf(page, 'model')) > 0.2);
    await page.mouse.up();
    await untilFrame(page, 75 + (await frameOf(page)));
    assert.ok(away(await verticesOf(page, 'model')) < 0.02);
    assert.equal(await figure(page, 'inside'), '0');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a clip of the picture is saved', async () => {
    const page = await browser.open('#model=torus&particles=400', { viewport: { width: 600, height: 400 } });
    await untilFrame(page, 20);
    await page.locator('#record').click();
    await page.waitForFunction(() => document.getElementById('record').textContent.startsWith('Stop'));
    await page.waitForTimeout(1500);
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#record').click()]);
    const bytes = await readFile(await download.path());
    assert.match(download.suggestedFilename(), /^echinus\.(webm|mp4)$/);
    assert.equal(bytes.readUInt32BE(0), 0x1a45dfa3, 'a WebM file');
    assert.ok(bytes.length > 2000, `${bytes.length} bytes`);
    assert.equal(await page.locator('#record').textContent(), 'Record clip');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('opening a large file shows what is being done, and can be cancelled', async () => {
    const page = await browser.open('#model=sphere&particles=100', SMALL);
    await untilFrame(page, 5);
    await page.locator('#file').setInputFiles({ name: 'large.stl', mimeType: 'model/stl', buffer: torusStl(600, 400) });
    await page.locator('#progress').waitFor();
    assert.match(await page.locator('#progress span').textContent(), /^large\.stl: (reading|repairing|building the map|laying the cloth)$/);
    await page.locator('#progress button').click();
    await page.waitForFunction(() => document.getElementById('subtitle').textContent.startsWith('sphere'));
    await untilFrame(page, 10);
    assert.ok(!(await page.locator('#progress').isVisible()));
    assert.ok(!(await page.locator('#notice').isVisible()));
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

/** What is done next is cancelled as soon as it can be: how long it takes depends on the machine. */
const cancelAtOnce = (page) =>
    page.evaluate(() => {
        const progress = document.getElementById('progress');
        const seen = new MutationObserver(() => {
            if (progress.hidden) return;
            seen.disconnect();
            progress.querySelector('button').click();
        });
        seen.observe(progress, { attributes: true });
    });

test('mending that is cancelled is not chosen any more, and the file stays as it was', async () => {
    const page = await browser.open('#model=sphere&particles=100&mend=false', SMALL);
    page.setDefaultTimeout(120_000);
    await untilFrame(page, 1);
    await page.locator('#file').setInputFiles({ name: 'large.stl', mimeType: 'model/stl', buffer: torusStl(500, 300) });
    await page.waitForFunction(() => document.getElementById('subtitle').textContent.startsWith('large.stl, ') && document.getElementById('progress').hidden);
    await cancelAtOnce(page);
    await page.locator('input[name=mend]').click(); // check() would wait for what is taken back
    await page.waitForFunction(() => document.getElementById('remark').textContent === 'Cancelled.');
    await page.waitForFunction(() => location.hash.includes('mend=false') && document.getElementById('subtitle').textContent.startsWith('large.stl, '));
    assert.ok(!(await page.locator('input[name=mend]').isChecked()));
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('building a large map can be cancelled, and the model and the map before stay', async () => {
    const page = await browser.open('#model=sphere&particles=100', SMALL);
    page.setDefaultTimeout(120_000);
    await untilFrame(page, 1);
    await page.locator('#file').setInputFiles({ name: 'large.stl', mimeType: 'model/stl', buffer: torusStl(500, 300) });
    const untilOpen = () => page.waitForFunction(() => document.getElementById('subtitle').textContent.startsWith('large.stl, ') && document.getElementById('progress').hidden);
    await untilOpen();
    await cancelAtOnce(page);
    await page.locator('input[name=map][value=distance]').click(); // check() would wait for what is taken back
    await page.waitForFunction(() => document.getElementById('remark').textContent === 'Cancelled.');
    await untilOpen();
    assert.ok(!page.url().includes('map=distance'));
    assert.ok(await page.locator('input[name=map][value=exact]').isChecked());
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('an open model says what that means, and how much is certain', async () => {
    const page = await browser.open('#model=torus&particles=100', SMALL);
    await untilFrame(page, 1);
    const closed = tetrahedra()['t.obj'];
    await page.locator('#file').setInputFiles({ name: 'open.obj', mimeType: 'model/obj', buffer: Buffer.from(closed.slice(0, closed.lastIndexOf('f '))) });
    await page.waitForFunction(() => /Open: inside or outside/.test(document.getElementById('report').textContent));
    assert.match(await page.locator('#report').textContent(), /The answer is certain in \d+(\.\d+)?\u2009% of the bounding sphere.*once the holes are closed/);
    await page.waitForFunction(() => document.getElementById('figure-inside').textContent === 'no inside');
    await page.waitForFunction(() => !/inside/.test(document.getElementById('headline').textContent)); // its words change now and then
    await browser.close(page);
});

test('a file of random bytes is refused in legible words', async () => {
    const page = await browser.open('#model=torus&particles=100', SMALL);
    await untilFrame(page, 1);
    const bytes = Buffer.from(Array.from({ length: 300 }, (_, i) => (i * 7919 + 13) % 256));
    for (const name of ['random.glb', 'random.gltf', 'random.3ds', 'random.stl']) {
        await page.locator('#file').setInputFiles({ name, mimeType: 'application/octet-stream', buffer: bytes });
        await page.waitForFunction((start) => document.querySelector('#notice span').textContent.startsWith(start), name);
        assert.match(await page.locator('#notice span').textContent(), /^[\x20-\x7e\u2009]{10,240}$/, name);
    }
    await browser.close(page);
});

test('another number of particles says that the cloth starts again', async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await untilFrame(page, 20);
    await page.locator('input[name=particles]').fill('0.5');
    await page.locator('#remark', { hasText: 'starts again' }).waitFor();
    await browser.close(page);
});

test('the tour goes through the exact map by itself or by a key, and ends at the cloth', async () => {
    const page = await browser.open('#model=torus&particles=400&map=distance', SMALL);
    await untilFrame(page, 5);
    const untilStop = (stop) => page.waitForFunction((least) => Number(document.getElementById('tour').dataset.stop) >= least, stop);
    await page.keyboard.press('t');
    await untilStop(0);
    await page.waitForFunction(() => document.body.classList.contains('view-map') && document.body.classList.contains('map-exact'));
    assert.equal(new URL(page.url()).hash, '#model=torus&map=distance&particles=400', 'loaded again, the page is as before');
    await page.keyboard.press('Enter');
    await untilStop(1);
    await page.waitForTimeout(400);
    const [picturePlace, wordsPlace] = [await page.locator('#canvas').boundingBox(), await page.locator('#tour').boundingBox()];
    assert.ok(wordsPlace.y >= picturePlace.y + picturePlace.height - 1, 'its words are not over the model');
    await picture(page, 'tour');
    await page.locator('#tour-back').click();
    assert.equal(await page.locator('#tour-place').textContent(), '1 of 5');
    for (let stop = 0; stop < 2; ++stop) await page.locator('#tour-next').click();
    await untilStop(2);
    await untilStop(3); // by itself
    await page.waitForFunction(() => Number(document.querySelector('input[name=slice]').value) < 0.8); // the panel shows where it is cut
    assert.equal(await page.locator('#ray').textContent(), 'Point at the surface.', 'the ray has gone');
    await picture(page, 'tour_slice');
    await page.keyboard.press('Escape');
    assert.ok(!(await page.locator('#tour').isVisible()));
    await page.waitForFunction(() => location.hash === '#model=torus&map=distance&particles=400'); // as before
    assert.equal(await page.locator('input[name=slice]').inputValue(), '1');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a visitor pauses the tour, turns its pages meanwhile, and lets it go on', async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await untilFrame(page, 1);
    await page.locator('#tour-begin').click();
    const stop = () => page.locator('#tour').getAttribute('data-stop');
    await page.locator('#tour-pause').click();
    await page.waitForTimeout(8000); // longer than a stop lasts
    assert.equal(await stop(), '0');
    await page.locator('#tour-next').click();
    assert.equal(await page.locator('#tour-pause').textContent(), 'Resume');
    await page.waitForTimeout(8000);
    assert.equal(await stop(), '1');
    await page.locator('#tour-pause').click();
    await page.waitForFunction(() => document.getElementById('tour').dataset.stop === '2');
    await page.keyboard.press('Escape');
    await page.keyboard.press('t');
    assert.equal(await page.locator('#tour-pause').textContent(), 'Pause');
    await page.waitForFunction(() => document.getElementById('tour').dataset.stop === '1');
    await browser.close(page);
});

test('the last stop of the tour waits while the visitor pulls the cloth', async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await untilFrame(page, 5);
    await page.locator('#tour-begin').click();
    for (let stop = 0; stop < 4; ++stop) await page.keyboard.press('Enter');
    await page.waitForTimeout(8000); // longer than any other stop lasts
    assert.equal(await page.locator('#tour').getAttribute('data-stop'), '4');
    assert.equal(await page.locator('#tour-next').textContent(), 'Done');
    await page.locator('#tour-next').click();
    assert.ok(!(await page.locator('#tour').isVisible()));
    await browser.close(page);
});

test('the tour leaves no entry in the history when a key ends it, and a file that is dropped opens under the cloth', async () => {
    const page = await browser.open('#model=sphere&particles=400', SMALL);
    await untilFrame(page, 1);
    await page.evaluate(() => (location.hash = '#model=torus&particles=400'));
    await page.waitForFunction(() => document.getElementById('subtitle').textContent.startsWith('torus'));
    await page.keyboard.press('t');
    await page.keyboard.press('Escape');
    await page.waitForFunction(() => document.body.classList.contains('view-cloth'));
    await page.goBack();
    await page.waitForFunction(() => document.getElementById('subtitle').textContent.startsWith('sphere'));
    await page.keyboard.press('t');
    await page.locator('#tour').waitFor();
    await page.locator('#file').setInputFiles({ name: 't.obj', mimeType: 'model/obj', buffer: Buffer.from(tetrahedra()['t.obj']) });
    await page.waitForFunction(() => document.getElementById('subtitle').textContent.startsWith('t.obj') && document.body.classList.contains('view-cloth'));
    await page.goBack();
    await page.waitForFunction(() => document.getElementById('subtitle').textContent.startsWith('sphere'));
    await browser.close(page);
});

test('where the system asks for reduced motion the cloth waits, and the tour does not turn its pages', async () => {
    const page = await browser.open('#model=torus&particles=400', { ...SMALL, reducedMotion: 'reduce' });
    await page.waitForFunction(() => document.body.dataset.paused === 'true');
    await page.waitForTimeout(300);
    assert.equal(await frameOf(page), 0);
    await page.locator('#pause').click();
    await untilFrame(page, 2);
    await page.keyboard.press('t');
    await page.waitForTimeout(8000); // longer than a stop lasts otherwise
    assert.equal(await page.locator('#tour').getAttribute('data-stop'), '0');
    await browser.close(page);
});

test('a thin probe is held from a little beside it, too', async () => {
    const page = await browser.open('#model=organ&particles=1500&hand=model', SMALL);
    await untilFrame(page, 1);
    await page.keyboard.press('Space');
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    let held = 0;
    for (let across = -60; across <= 60; across += 5) {
        await page.mouse.move(x + 0.5 * width + across, y + 0.3 * height);
        await page.mouse.down();
        if (await page.locator('#canvas.dragging').isVisible()) ++held;
        await page.mouse.up();
    }
    assert.ok(held >= 5 && held < 15, `held at ${held} of 25 places, 5 pixels apart`);
    await browser.close(page);
});

test('the buttons of the pointer name what it pulls and moves', async () => {
    const page = await browser.open('#model=organ&particles=1500', SMALL);
    await page.waitForFunction(() => document.getElementById('subtitle').textContent.startsWith('organ'));
    assert.deepEqual(await page.locator('#hands span').allTextContents(), ['Pull organ', 'Push organ', 'Move probe']);
    await page.locator('select[name=model]').selectOption('sphere');
    await page.waitForFunction(() => document.getElementById('move').textContent === 'Move model');
    await browser.close(page);
});

test('the tour ends where the visitor goes elsewhere: back, to another example, to another view', async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await untilFrame(page, 5);
    await page.evaluate(() => (location.hash = '#model=sphere&particles=400'));
    const leaves = { back: () => page.goBack(), view: () => page.locator('input[name=view][value=cloth]').check(), tile: () => page.evaluate(() => document.querySelector('#gallery a[href*=flag]').click()) };
    for (const [name, leave] of Object.entries(leaves)) {
        await page.keyboard.press('t');
        await page.locator('#tour').waitFor();
        await leave();
        await page.locator('#tour').waitFor({ state: 'hidden' });
        await page.waitForFunction(() => document.body.classList.contains('view-cloth'));
        await page.waitForURL(name === 'tile' ? /#model=flag/ : /#model=sphere&particles=400$/);
    }
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});
