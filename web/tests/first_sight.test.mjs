// What a newcomer sees: what this is, that it is well, and what can be opened.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { SMALL, figure, hasHorse, picture, startBrowser, untilFrame } from './support.mjs';

let browser;
before(async () => (browser = await startBrowser()));
after(() => browser?.stop());

const untilHeadline = (page, pattern) =>
    page.waitForFunction((source) => new RegExp(source).test(document.getElementById('headline').textContent), pattern.source, { timeout: 60_000 });

test('the headline says what there is, that nothing intersects, and what the map took', async () => {
    const page = await browser.open('#model=torus&particles=900', SMALL);
    await untilHeadline(page, /^900 particles, no face cuts the model or the cloth itself, map of [\d.]+\u202fkB built in [\d.]+\u202fms/);
    assert.ok(await page.locator('#headline .good').isVisible());
    await page.locator('input[name=map][value=distance]').check();
    await untilHeadline(page, /the paper’s map of/);
    await browser.close(page);
});

test('the headline in the view of the map is about the map of the model that is shown', async () => {
    const page = await browser.open('#model=torus&view=map', SMALL);
    await untilHeadline(page, /^An exact map of [\d.]+\u202fkB built in [\d.]+\u202fms$/);
    const torus = await page.locator('#headline').textContent();
    await page.locator('select[name=model]').selectOption('sphere');
    await page.waitForFunction((before) => /^An exact map of/.test(document.getElementById('headline').textContent) && document.getElementById('headline').textContent !== before, torus);
    assert.equal(await page.locator('#headline').textContent(), `An exact map of ${(await figure(page, 'bytes')).replaceAll('\u2009', '\u202f')} built in ${(await figure(page, 'build')).replaceAll('\u2009', '\u202f')}`);
    await browser.close(page);
});

test('the headline is not green where self-collision or surface collision is off, and says so', async () => {
    const page = await browser.open('#model=torus&particles=400&self=false', SMALL);
    await untilHeadline(page, /^400 particles, no face cuts the model, self-collision is off/);
    assert.equal(await page.locator('#headline .good').count(), 0);
    await page.locator('input[name=surfaces]').uncheck();
    await untilHeadline(page, /only particles collide/);
    assert.equal(await page.locator('#headline .good').count(), 0);
    await browser.close(page);
});

test('the headline is red where the cloth cuts itself in spite of self-collision', async () => {
    const page = await browser.open('#model=torus&particles=400', { ...SMALL, beforeLoad: cutItself });
    await untilHeadline(page, /^400 particles, 3 pairs of its own faces cut each other/);
    assert.ok(await page.locator('#headline .bad').isVisible());
    await browser.close(page);
});

/** Runs in the page: the worker that counts intersecting faces finds three pairs. */
function cutItself() {
    const Usual = globalThis.Worker;
    globalThis.Worker = class extends Usual {
        set onmessage(hear) {
            super.onmessage = ({ data }) => hear({ data: 'own' in data ? { ...data, own: 3 } : data });
        }
    };
}

test('the headline names slow motion', async () => {
    const page = await browser.open('#model=torus&particles=400', { ...SMALL, beforeLoad: () => {
        const now = performance.now.bind(performance);
        performance.now = () => 20 * now(); // the simulation, in its worker, has the usual clock
    } });
    await untilHeadline(page, /, \d+\u00d7 slow motion$/);
    await page.keyboard.press('Space');
    await page.waitForFunction(() => !/slow motion/.test(document.getElementById('headline').textContent));
    await browser.close(page);
});

test('the headline says what is wrong when something is', async () => {
    const page = await browser.open('#model=torus&particles=400&thickness=0.1&surfaces=false', SMALL);
    await untilHeadline(page, /^400 particles, \d+ pairs? of faces cut, only particles collide/);
    await browser.close(page);
});

test('settings are folded away, and unfold', async () => {
    const page = await browser.open('#model=torus&particles=100', { ...SMALL, folded: true });
    await untilFrame(page, 1);
    const friction = page.locator('input[name=friction]');
    assert.ok(!(await friction.isVisible()));
    assert.ok(await page.locator('#about').isVisible() && await page.locator('#gallery').isVisible());
    await page.locator('summary', { hasText: 'Collision' }).click();
    assert.ok(await friction.isVisible());
    await browser.close(page);
});

test('links lead to documents that are there, and others see a card of a link to the page', async () => {
    const page = await browser.open('#model=torus&particles=100', SMALL);
    for (const link of await page.locator('#about a').all()) {
        const answer = await page.request.get(new URL(await link.getAttribute('href'), page.url()).href);
        assert.ok(answer.ok() && (await answer.body()).length > 1000, await link.getAttribute('href'));
    }
    const card = new URL(await page.locator('meta[property="og:image"]').getAttribute('content'), page.url()).href;
    const bytes = await (await page.request.get(card)).body();
    assert.deepEqual([...bytes.subarray(0, 2)], [0xff, 0xd8], 'a JPEG file');
    assert.ok(bytes.length < 120_000, `${bytes.length} bytes`);
    assert.match(await page.locator('meta[name=description]').getAttribute('content'), /cloth/i);
    await browser.close(page);
});

test('software draws the light look, and a link may ask for the fine one, in the light and in the dark', async () => {
    for (const colorScheme of ['light', 'dark']) {
        const page = await browser.open('#model=torus&particles=900&look=fine', { viewport: { width: 480, height: 320 }, colorScheme });
        await untilFrame(page, 20);
        assert.equal(await page.evaluate(() => document.body.dataset.look), 'fine');
        await picture(page, `fine_${colorScheme}`);
        await page.locator('select[name=look]').selectOption('auto');
        await page.waitForFunction(() => document.body.dataset.look === 'light');
        assert.deepEqual(page.complaints, []);
        await browser.close(page);
    }
});

test('the fine look casts the shadow of the model on the ground', async () => {
    const darkest = async (look) => {
        const page = await browser.open(`#model=sphere&particles=100&look=${look}&camera=35_25_6_0_0_0`, { viewport: { width: 960, height: 560 } });
        await untilFrame(page, 10);
        await page.keyboard.press('Space');
        await page.waitForTimeout(500);
        const shot = (await page.locator('#canvas').screenshot()).toString('base64');
        const brightness = await page.evaluate(darkestBesideModel, shot);
        await browser.close(page);
        return brightness;
    };
    const [fine, light] = [await darkest('fine'), await darkest('light')];
    assert.ok(fine < 0.93 * light, `${fine} and ${light}`);
});

/** Runs in the page: how bright the darkest places in the lower right of a picture are. */
async function darkestBesideModel(data) {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context.drawImage(image, 0, 0);
    const [x, y] = [Math.round(0.74 * image.width), Math.round(0.5 * image.height)];
    const { data: bytes } = context.getImageData(x, y, image.width - x, image.height - y);
    const sums = [];
    for (let i = 0; i < bytes.length; i += 4) sums.push(bytes[i] + bytes[i + 1] + bytes[i + 2]);
    return sums.sort((a, b) => a - b)[Math.round(0.03 * sums.length)];
}

test('in no window words or buttons lie over the model', async () => {
    const windows = [[700, 500], [900, 600], [1400, 900], [390, 844], [1000, 640, 'particles'], [844, 390, 'particles'], [320, 568, 'particles']];
    for (const [width, height, beside = 'nothing'] of windows) {
        const page = await browser.open(`#model=torus&particles=400&beside=${beside}`, { viewport: { width, height } });
        await untilFrame(page, 20);
        await page.locator('#remark').waitFor({ state: 'hidden' });
        const covers = await page.evaluate(() => {
            const picture = document.getElementById('canvas').getBoundingClientRect();
            return ['header', '#halves', '#transport', '#hands', '#hint', '#figures', '#panel'].filter((selector) => {
                const { width, height, left, right, top, bottom } = document.querySelector(selector).getBoundingClientRect();
                return width * height > 0 && left < picture.right - 1 && right > picture.left + 1 && top < picture.bottom - 1 && bottom > picture.top + 1;
            });
        });
        assert.deepEqual(covers, [], `${width} x ${height}`);
        const cut = await page.evaluate(() => {
            const { right } = document.getElementById('figures').getBoundingClientRect();
            return [...document.querySelectorAll('#figures dd, #figures dt')].filter((cell) => {
                const words = document.createRange();
                words.selectNodeContents(cell);
                const next = cell.parentElement.nextElementSibling?.getBoundingClientRect();
                const end = next && next.left > cell.getBoundingClientRect().left ? next.left : right;
                return words.getBoundingClientRect().right > end;
            }).map((cell) => cell.textContent);
        });
        assert.deepEqual(cut, [], `figures cut off or over each other at ${width} x ${height}`);
        await picture(page, `window_${width}`);
        await browser.close(page);
    }
});

test('on a small phone the picture stays in sight and leaves more than half of the window to the rest', async () => {
    const page = await browser.open('#model=torus&particles=100', { viewport: { width: 320, height: 568 } });
    await untilFrame(page, 1);
    await page.evaluate(() => scrollTo({ top: document.body.scrollHeight }));
    const covered = await page.evaluate(() => Math.max(...['stage', 'bar'].map((id) => document.getElementById(id).getBoundingClientRect().bottom)));
    assert.ok(covered > 100 && covered < 0.5 * 568, `${covered} pixels`);
    await page.keyboard.press('t');
    await page.waitForFunction(() => document.getElementById('tour-end').getBoundingClientRect().bottom <= innerHeight);
    await browser.close(page);
});

test('in the light and in the dark the chosen tab stands out, and its word is legible', async () => {
    for (const colorScheme of ['light', 'dark']) {
        const page = await browser.open('#model=torus&particles=100', { ...SMALL, colorScheme });
        await untilFrame(page, 1);
        const { edge, word } = await page.evaluate(() => {
            const luminance = (colour) => {
                const parts = colour.match(/[\d.]+/g).slice(0, 3).map((part) => (part / 255 <= 0.04 ? part / 255 / 12.92 : ((part / 255 + 0.055) / 1.055) ** 2.4));
                return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2];
            };
            const contrast = (a, b) => (Math.max(luminance(a), luminance(b)) + 0.05) / (Math.min(luminance(a), luminance(b)) + 0.05);
            const chosen = getComputedStyle(document.querySelector('.tabs input:checked + span'));
            const around = getComputedStyle(document.querySelector('.tabs'));
            return { edge: contrast(chosen.backgroundColor, around.backgroundColor), word: contrast(chosen.color, chosen.backgroundColor) };
        });
        assert.ok(edge > (colorScheme === 'dark' ? 1.4 : 1.1) && word > 4.5, `${colorScheme}: ${edge} and ${word}`);
        await browser.close(page);
    }
});

// The examples of the gallery, with few particles: software draws them.
const FEW = { figure: 600, organ: 1500, ring: 400, flag: 400, layers: 800 };
for (const [model, particles] of Object.entries(FEW))
    test(`the example "${model}" runs, and nothing gets through`, async () => {
        const page = await browser.open(`#model=${model}&particles=${particles}`, { viewport: { width: 600, height: 400 } });
        page.setDefaultTimeout(120_000);
        await page.waitForFunction(() => Number(document.body.dataset.frame) >= 60);
        await untilHeadline(page, /no face cuts the model/);
        assert.deepEqual(page.complaints, []);
        await picture(page, `example_${model}`);
        await browser.close(page);
    });

test('the figure deforms and turns, and in no frame a face of its skirt is through it', async () => {
    const page = await browser.open('#model=figure&particles=600', { viewport: { width: 600, height: 400 } });
    page.setDefaultTimeout(120_000);
    await page.waitForFunction(() => performance.getEntriesByType('resource').some(({ name }) => /pairs-/.test(name)));
    const { most, shapes, atOnce, inside, ways } = await page.evaluate(danceInWorker, 150);
    assert.equal(most, 0, 'pairs of faces');
    assert.equal(inside, 0);
    assert.equal(shapes, 150, 'a shape with each step');
    assert.ok(atOnce < 0.06, `a vertex went ${atOnce} at once`);
    assert.ok(ways > 0.3, `no vertex went farther than ${ways}`);
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

/** Runs in the page: steps by a worker of its own, each judged by the page's other worker. */
async function danceInWorker(frames) {
    const scripts = performance.getEntriesByType('resource').map(({ name }) => name);
    const [worker, judge] = [/worker-[^/]*\.js$/, /pairs-[^/]*\.js$/].map((pattern) => new Worker(scripts.find((name) => pattern.test(name)), { type: 'module' }));
    const settings = { model: 'figure', view: 'cloth', map: 'exact', cells: 'auto', particles: 600, cloths: 1, friction: 0.5, surfaces: true, self: false, thickness: 0.5, wind: 0, motion: 'still', up: 'auto', mend: true, colour: 'fabric', hand: 'cloth' };
    const next = (from, kind) => new Promise((resolve, reject) => {
        from.onmessage = ({ data }) => data.kind === 'failed' ? reject(new Error(data.sentence)) : data.kind === kind && resolve(data);
    });
    const ask = (whom, message, kind) => (whom.postMessage(message), next(whom, kind));
    const { vertices, faces } = await ask(worker, { kind: 'open', turn: 1, settings, page: document.baseURI }, 'model');
    const cloth = await next(worker, 'cloth');
    let most = 0, shapes = 0, atOnce = 0, ways = 0, inside = 0, before = vertices;
    for (let frame = 1; frame <= frames; ++frame) {
        const { arrays, shape, collider, wrong } = await ask(worker, { kind: 'step' }, 'frame');
        inside += wrong.length;
        if (!shape) continue;
        ++shapes;
        for (let at = 0; at < vertices.length; at += 3) {
            const way = (from) => Math.hypot(...[0, 1, 2].map((k) => shape.vertices[at + k] - from[at + k]));
            atOnce = Math.max(atOnce, way(before));
            ways = Math.max(ways, way(vertices));
        }
        before = shape.vertices;
        const question = { number: 1, positions: arrays.positions, faces: cloth.faces, collider, shape: shape.vertices, ...(frame === 1 && { model: { vertices, faces } }) };
        const { withModel } = await ask(judge, question, undefined);
        most = Math.max(most, withModel);
    }
    for (const each of [worker, judge]) each.terminate();
    return { most, shapes, atOnce, inside, ways };
}

test('the gallery has a tile for each example, with a picture, and one for a file; a click opens it', async () => {
    const page = await browser.open('#model=torus&particles=100', SMALL);
    await untilFrame(page, 1);
    const tiles = page.locator('#gallery .tile');
    assert.equal(await tiles.count(), hasHorse ? 9 : 7);
    for (const image of await tiles.locator('img').all()) assert.ok((await page.request.get(new URL(await image.getAttribute('src'), page.url()).href)).ok());
    await page.locator('#gallery a', { hasText: 'flag' }).click();
    await page.waitForFunction(() => document.getElementById('subtitle').textContent.startsWith('flag'));
    assert.equal(await page.locator('#gallery .chosen span').textContent(), 'A flag in the wind');
    const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.locator('#gallery .own').click()]);
    assert.ok(chooser);
    await browser.close(page);
});

test('no picture of the gallery is large', () => {
    for (const name of ['horse', 'torus', 'figure', 'organ', 'ring', 'flag', 'layers', 'beside']) {
        const { length } = readFileSync(fileURLToPath(new URL(`../pictures/gallery/${name}.jpg`, import.meta.url)));
        assert.ok(length > 1500 && length < 16_000, `${name}: ${length} bytes`);
    }
});
