// The cloth under the visitor's hand.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { SMALL, figure, hasHorse, picture, startBrowser, untilFrame } from './support.mjs';

let browser;
before(async () => (browser = await startBrowser()));
after(() => browser?.stop());

// By the page's own worker, without drawing.
for (const [model, particles, mostFrames] of [['torus', 900, 1500], ['horse', 2500, 200]])
    test(`the cloth falls on the ${model}${model === 'torus' ? ' and comes to rest' : ''}, and in no frame is a particle inside`, { skip: model === 'horse' && !hasHorse && 'the horse is not installed' }, async () => {
        const page = await browser.open('#model=sphere&particles=100&view=map', SMALL);
        await page.locator('#map-figures td').first().waitFor();
        const { frames, mostInside, atRest } = await page.evaluate(fallInWorker, { model, particles, mostFrames });
        assert.equal(mostInside, 0);
        assert.ok(atRest || model !== 'torus', `still moving after ${frames} frames`);
        assert.ok(frames > 125, `${frames} frames are too few for a fall`);
        await browser.close(page);
    });

/** Runs in the page. @returns once the cloth is at rest or has moved for too long */
async function fallInWorker({ model, particles, mostFrames }) {
    const script = performance.getEntriesByType('resource').find(({ name }) => /worker-[^/]*\.js$/.test(name)).name;
    const worker = new Worker(script, { type: 'module' });
    const settings = { model, view: 'cloth', map: 'exact', cells: 'auto', particles, cloths: 1, friction: 0.5, surfaces: false, self: false, thickness: 0.5, wind: 0, motion: 'still', up: 'auto', mend: true, colour: 'fabric' };
    let mostInside = 0;
    return new Promise((resolve, reject) => {
        worker.onmessage = ({ data }) => {
            if (data.kind === 'failed') reject(new Error(data.sentence));
            if (data.kind === 'frame') {
                const { frame, inside, atRest } = data.figures;
                mostInside = Math.max(mostInside, inside);
                if (atRest || frame >= mostFrames) {
                    worker.terminate();
                    return resolve({ frames: frame, mostInside, atRest });
                }
            }
            if (data.kind === 'frame' || data.kind === 'cloth') worker.postMessage({ kind: 'step' });
        };
        worker.postMessage({ kind: 'open', settings, page: document.baseURI });
    });
}

test('a pause holds the cloth, a step moves it by one frame, and it can be dropped again', async () => {
    const page = await browser.open('#model=sphere&particles=400', SMALL);
    await untilFrame(page, 20);
    await page.keyboard.press('Space');
    assert.equal(await page.locator('#pause').textContent(), 'Resume');
    await page.waitForFunction(() => document.body.dataset.paused === 'true'); // frames under way have arrived
    const frame = () => page.evaluate(() => Number(document.body.dataset.frame));
    const held = await frame();
    await page.waitForTimeout(300);
    assert.equal(await frame(), held);
    await page.locator('#step').click();
    await page.waitForFunction((next) => Number(document.body.dataset.frame) === next, held + 1);
    await page.locator('#restart').click();
    await page.waitForFunction((before) => Number(document.body.dataset.frame) < before, held);
    await browser.close(page);
});

for (const motion of ['turning', 'swinging'])
    test(`no particle gets into a model that is ${motion} in the wind`, async () => {
        const page = await browser.open(`#model=torus&particles=900&motion=${motion}&wind=6`, SMALL);
        await untilFrame(page, 75);
        assert.equal(await figure(page, 'inside'), '0');
        assert.deepEqual(page.complaints, []);
        await browser.close(page);
    });

/** The cloth's vertices, as saved. */
async function clothOf(page) {
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#save-mesh').click()]);
    const text = await readFile(await download.path(), 'utf8');
    return text.slice(text.indexOf('o cloth'), text.indexOf('o model')).match(/^v .*$/gm).map((line) => line.split(' ').slice(1).map(Number));
}

for (const map of ['exact', 'distance'])
    test(`a pull moves a cloth on the ${map} map, and wakes it where it was at rest`, async () => {
        const page = await browser.open(`#model=torus&particles=400&map=${map}`, SMALL);
        // With the paper's map the cloth may tremble forever.
        await page.waitForFunction((least) => document.body.dataset.rest === 'true' || Number(document.body.dataset.frame) >= least, map === 'exact' ? 1e9 : 375, { timeout: 120_000 });
        const before = await clothOf(page);
        const { x, y, width, height } = await page.locator('#canvas').boundingBox();
        await page.mouse.move(x + 0.5 * width, y + 0.5 * height);
        await page.mouse.down();
        assert.ok(await page.locator('#canvas.dragging').isVisible());
        await page.mouse.move(x + 0.5 * width, y + 0.9 * height, { steps: 4 });
        // By the cloth's own clock, so that drawing speed does not matter.
        await untilFrame(page, 30 + (await page.evaluate(() => Number(document.body.dataset.frame))));
        await page.waitForTimeout(400); // until the figures are updated
        if (map === 'exact') assert.equal(await figure(page, 'inside'), '0', 'no particle is dragged into the model');
        await picture(page, `dragged_${map}`);
        await page.mouse.up();
        await page.waitForFunction(() => !document.querySelector('#canvas.dragging'));
        const moved = (await clothOf(page)).map((point, i) => Math.hypot(...point.map((c, k) => c - before[i][k])));
        assert.ok(Math.max(...moved) > 0.1, `by at most ${Math.max(...moved)}`);
        assert.deepEqual(page.complaints, []);
        await browser.close(page);
    });

test('a finger pulls the cloth, and a finger beside it turns the view', async () => {
    const page = await browser.open('#model=torus&particles=400', { ...SMALL, hasTouch: true });
    await untilFrame(page, 75); // it lies on the model
    const before = await clothOf(page);
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    const session = await page.context().newCDPSession(page);
    const touch = (type, ...points) => session.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y]) => ({ x, y })) });
    await touch('touchStart', [x + 0.5 * width, y + 0.5 * height]);
    await page.locator('#canvas.dragging').waitFor();
    await touch('touchMove', [x + 0.5 * width, y + 0.9 * height]);
    await untilFrame(page, 15 + (await page.evaluate(() => Number(document.body.dataset.frame))));
    await touch('touchEnd');
    const moved = (await clothOf(page)).map((point, i) => Math.hypot(...point.map((c, k) => c - before[i][k])));
    assert.ok(Math.max(...moved) > 0.1, `by at most ${Math.max(...moved)}`);
    assert.equal(new URL(page.url()).hash, '#model=torus&particles=400', 'the view stood still');

    await touch('touchStart', [x + 0.1 * width, y + 0.6 * height]);
    await touch('touchMove', [x + 0.3 * width, y + 0.6 * height]);
    await touch('touchEnd');
    await page.waitForFunction(() => location.hash.includes('camera='));

    // Two fingers zoom, even where the first has grabbed the cloth.
    const far = Number(new URL(page.url()).hash.match(/camera=[^_]*_[^_]*_([0-9.]+)/)[1]);
    const [middle, level] = [x + 0.5 * width, y + 0.5 * height];
    await page.keyboard.press('r'); // the cloth was pulled away from there
    await page.waitForFunction(() => Number(document.body.dataset.frame) < 25);
    await untilFrame(page, 75);
    await touch('touchStart', [middle, level]);
    await page.locator('#canvas.dragging').waitFor();
    await touch('touchStart', [middle, level], [middle + 40, level]);
    await page.waitForFunction(() => !document.querySelector('#canvas.dragging'));
    await touch('touchMove', [middle - 40, level], [middle + 80, level]);
    await touch('touchEnd');
    await page.waitForFunction((least) => Number(location.hash.match(/camera=[^_]*_[^_]*_([0-9.]+)/)[1]) < least, 0.7 * far);
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('friction, thickness and wind change while the cloth falls on, and no particle gets inside', async () => {
    const page = await browser.open('#model=torus&particles=900', SMALL);
    let frame = 15;
    for (const [name, value] of [['thickness', 2], ['friction', 0], ['thickness', 0.1], ['wind', 5], ['friction', 1.5]]) {
        await untilFrame(page, (frame += 15));
        await page.locator(`input[name=${name}]`).fill(String(value));
    }
    await untilFrame(page, frame + 50);
    assert.equal(await figure(page, 'inside'), '0');
    assert.equal(new URL(page.url()).hash, '#model=torus&particles=900&friction=1.5&thickness=0.1&wind=5');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a cloth of 100 000 particles falls', async () => {
    const page = await browser.open('#model=torus&particles=100000', SMALL);
    await untilFrame(page, 3);
    assert.equal(await figure(page, 'inside'), '0');
    assert.equal((await clothOf(page)).length, 316 * 316); // the nearest square number
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

const untilCounted = (page) => page.waitForFunction(() => document.getElementById('figure-own-pairs').textContent !== '–', null, { timeout: 60_000 });

/** How many pixels of the picture have the colour of what is wrong. */
async function wrongPixels(page) {
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#save-picture').click()]);
    const bytes = [...(await readFile(await download.path()))];
    return page.evaluate(async (bytes) => {
        const image = await createImageBitmap(new Blob([new Uint8Array(bytes)], { type: 'image/png' }));
        const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
        context.drawImage(image, 0, 0);
        const { data } = context.getImageData(0, 0, image.width, image.height);
        let count = 0;
        for (let i = 0; i < data.length; i += 4) count += Math.abs(data[i] - 0x16) + Math.abs(data[i + 1] - 0xc5) + Math.abs(data[i + 2] - 0xf5) < 12 ? 1 : 0;
        return count;
    }, bytes);
}

test('faces that intersect are counted and glow, and once surfaces collide there are none', async () => {
    const page = await browser.open('#model=torus&particles=400&thickness=0.1&surfaces=false&self=false', SMALL);
    await page.waitForFunction(() => Number(document.getElementById('figure-pairs').textContent) > 0, null, { timeout: 60_000 });
    await picture(page, 'cut');
    assert.ok((await wrongPixels(page)) > 20);
    await page.locator('input[name=self]').check();
    assert.ok(await page.locator('input[name=surfaces]').isChecked(), 'a cloth that collides with itself does with the model');
    assert.match(await page.locator('#map-note').textContent(), /No face of the cloth passes through/);
    await page.waitForFunction(() => ['figure-pairs', 'figure-own-pairs'].every((id) => document.getElementById(id).textContent === '0'), null, { timeout: 60_000 });
    await untilFrame(page, 15 + (await page.evaluate(() => Number(document.body.dataset.frame))));
    assert.equal(await page.locator('#notice').isVisible(), false);
    assert.equal(await wrongPixels(page), 0);
    await picture(page, 'untangled');
    await page.locator('input[name=surfaces]').uncheck();
    assert.ok(!(await page.locator('input[name=self]').isChecked()));
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('no face of a cloth whose surfaces collide intersects while it falls, is pulled and changes its thickness', async () => {
    const page = await browser.open('#model=torus&particles=900&surfaces=true&self=true', SMALL);
    await page.evaluate(() => {
        globalThis.counts = new Set();
        for (const id of ['figure-pairs', 'figure-own-pairs']) {
            const cell = document.getElementById(id);
            new MutationObserver(() => globalThis.counts.add(cell.textContent)).observe(cell, { childList: true, characterData: true, subtree: true });
        }
    });
    await untilFrame(page, 38);
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    await page.mouse.move(x + 0.5 * width, y + 0.5 * height);
    await page.mouse.down();
    await page.mouse.move(x + 0.5 * width, y + 0.9 * height, { steps: 4 });
    await untilFrame(page, 75);
    await page.mouse.up();
    await page.locator('input[name=thickness]').fill('1');
    await untilFrame(page, 112);
    await untilCounted(page);
    await page.waitForTimeout(500);
    assert.deepEqual(await page.evaluate(() => [...globalThis.counts].filter((count) => count !== '–')), ['0']);
    assert.equal(await figure(page, 'inside'), '0');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('several cloths fall on the model and on each other, and none gets through another', async () => {
    const page = await browser.open('#model=torus&particles=1200', SMALL);
    await untilFrame(page, 1);
    await page.locator('input[name=cloths]').fill('3');
    await page.locator('#remark', { hasText: '3 cloths start again, with 1\u2009200 particles in total.' }).waitFor();
    assert.ok(await page.locator('input[name=self]').isChecked());
    await page.waitForFunction(() => Number(document.body.dataset.frame) > 75, null, { timeout: 120_000 });
    await untilCounted(page);
    await picture(page, 'three_cloths');
    for (const name of ['inside', 'pairs', 'own-pairs']) assert.equal(await figure(page, name), '0', name);
    assert.match(page.url(), /cloths=3/);
    assert.deepEqual(page.complaints, []);
    await page.locator('select[name=model]').selectOption('flag');
    await page.waitForFunction(() => document.getElementById('cloths').hidden);
    await browser.close(page);
});

test('the pointer is a hand over the cloth alone, and holds while it pulls', async () => {
    const page = await browser.open('#model=torus&particles=900', SMALL);
    await untilFrame(page, 60);
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    const cursorAt = async (across, down) => {
        await page.mouse.move(x + across * width, y + down * height);
        await page.waitForTimeout(150); // it looks now and then
        await page.mouse.move(x + across * width + 1, y + down * height);
        return page.evaluate(() => getComputedStyle(document.getElementById('canvas')).cursor);
    };
    assert.equal(await cursorAt(0.5, 0.5), 'grab');
    await page.mouse.down();
    assert.equal(await page.evaluate(() => getComputedStyle(document.getElementById('canvas')).cursor), 'grabbing');
    await page.mouse.up();
    assert.notEqual(await cursorAt(0.03, 0.1), 'grab');
    await browser.close(page);
});

test('the depth of contact is shown in colours with a legend', async () => {
    const page = await browser.open('#model=torus&particles=2500&colour=depth&map=distance', SMALL);
    await untilFrame(page, 40);
    assert.ok(await page.locator('#depth-legend').isVisible());
    await picture(page, 'depth');
    await page.locator('select[name=colour]').selectOption('fabric');
    assert.ok(!(await page.locator('#depth-legend').isVisible()));
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});
