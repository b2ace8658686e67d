// The view of the map.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { SMALL, figure, hasHorse, numberOf, picture, shareOfProcessor, startBrowser, untilFrame, untilRay } from './support.mjs';

let browser;
before(async () => (browser = await startBrowser()));
after(() => browser?.stop());

// The first build in a fresh page, including the browser's compilation. To pass on a busy machine, the best of a few
// pages counts, times the share of its runnable time that the worker had the processor.
test("the horse's map is built in under 50 ms", { skip: !hasHorse && 'the horse is not installed' }, async () => {
    const times = [];
    for (let turn = 0; turn < 6 && !(Math.min(...times) < 50); ++turn) {
        const page = await browser.open('#particles=100', { viewport: { width: 390, height: 300 }, fresh: true });
        await untilFrame(page, 1);
        times.push(Math.round(numberOf(await figure(page, 'build')) * shareOfProcessor('DedicatedWorker')));
        await browser.close(page);
    }
    assert.ok(Math.min(...times) < 50, `${times.join(', ')} ms`);
});

test('the map is shown in colours with its figures, and built again when asked', async () => {
    const page = await browser.open('#view=map');
    await untilRay(page);
    await page.waitForTimeout(500);
    await picture(page, 'map');
    // Once the browser has optimised the code, by wall-clock time.
    for (let turn = 0; turn < 8; ++turn) {
        await page.evaluate(() => (document.getElementById('figure-build').textContent = ''));
        await page.locator('#rebuild').click();
        await page.waitForFunction(() => document.getElementById('figure-build').textContent !== '');
        if (numberOf(await figure(page, 'build')) < 50) break;
    }
    assert.ok(numberOf(await figure(page, 'build')) < 50, await figure(page, 'build'));
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

/** Waits until the table of the map's figures shows this value for this name. */
const untilRow = (page, name, value) =>
    page.waitForFunction(
        ([n, v]) => [...document.querySelectorAll('#map-figures tr')].some((r) => r.cells[0].textContent === n && r.cells[1].textContent === v), [name, value]);

test('the requested number of cells of the exact map is shown', async () => {
    const page = await browser.open('#model=torus&view=map&shown=cells&cells=64&slice=0.2&particles=100', SMALL);
    await untilRow(page, 'cells', '512');
    await untilRay(page);
    assert.match(await page.locator('#legend').textContent(), /cell/);
    await picture(page, 'cells');
    await page.locator('select[name=cells]').selectOption('256');
    await untilRow(page, 'cells', '2\u2009048');
    await page.locator('select[name=shown]').selectOption('surface');
    assert.match(await page.locator('#legend').textContent(), /query/);
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test("the paper's map follows its options, and one key switches to the other map", async () => {
    const page = await browser.open('#model=torus&view=map&map=distance&directions=2500&particles=100', SMALL);
    await untilRow(page, 'directions', '2\u2009500');
    await page.locator('select[name=grid]').selectOption('cube');
    await untilRow(page, 'directions', '2\u2009400'); // six squares of 20 x 20
    await page.keyboard.press('x');
    await page.locator('#map-figures tr', { hasText: 'bands' }).waitFor();
    assert.ok(await page.locator('input[name=map][value=exact]').isChecked());
    await page.keyboard.press('x');
    await untilRow(page, 'directions', '2\u2009400');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('the worker gives each face one colour, by its value, and its normal', async () => {
    const page = await browser.open('#model=torus&particles=100', SMALL);
    await untilFrame(page, 1);
    const { faceCount, surface, cells } = await page.evaluate(coloursOfWorker);
    assert.equal(surface.faces, faceCount);
    assert.ok(cells.faces >= 8);
    for (const { colours, oneEach, unit, brightest, darkest } of [surface, cells]) {
        assert.ok(oneEach && unit);
        assert.ok(colours > 2, `${colours} colours`);
        // The ends of the scale, 0xfff7bc and 0x662506: the second is of the largest value.
        assert.ok(brightest > darkest && Math.abs(darkest - 0.1329) < 1e-3, `${brightest} ${darkest}`);
    }
    await browser.close(page);
});

/** Runs in the page: what a worker of its own answers about the map of a torus. */
async function coloursOfWorker() {
    const script = performance.getEntriesByType('resource').find(({ name }) => /worker-[^/]*\.js$/.test(name)).name;
    const worker = new Worker(script, { type: 'module' });
    const settings = { model: 'torus', view: 'map', map: 'exact', cells: 'auto', particles: 100, cloths: 1, friction: 0.5, surfaces: false, self: false, thickness: 0.5, wind: 0, motion: 'still', up: 'auto', mend: true, colour: 'fabric', hand: 'cloth' };
    const until = (kind) => new Promise((resolve, reject) => {
        worker.onmessage = ({ data }) => data.kind === kind ? resolve(data) : data.kind === 'failed' && reject(new Error(data.sentence));
    });
    const ask = (message, kind) => (worker.postMessage(message), until(kind));
    const { report } = await ask({ kind: 'open', turn: 1, settings, page: document.baseURI }, 'model');
    const summary = ({ faces: { positions, normals, colours } }) => {
        const reds = new Set();
        let oneEach = positions.length === colours.length, unit = positions.length === normals.length;
        for (let at = 0; at < colours.length; at += 3) {
            const first = at - (at % 9);
            reds.add(colours[at]);
            for (let k = 0; k < 3; ++k) oneEach &&= colours[at + k] === colours[first + k];
            unit &&= Math.abs(Math.hypot(...normals.subarray(at, at + 3)) - 1) < 1e-5;
        }
        return { faces: positions.length / 9, colours: reds.size, oneEach, unit, brightest: Math.max(...reds), darkest: Math.min(...reds) };
    };
    const surface = summary(await ask({ kind: 'surface' }, 'surface'));
    const cells = summary(await ask({ kind: 'cells' }, 'cells'));
    worker.terminate();
    return { faceCount: report.faceCount, surface, cells };
}

test('the ray goes through the point under the pointer', async () => {
    const page = await browser.open('#model=sphere&view=map&particles=100', SMALL);
    await untilRay(page);
    const first = await page.locator('#ray').textContent();
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    await page.mouse.move(x + 0.45 * width, y + 0.6 * height);
    await page.waitForFunction((before) => document.getElementById('ray').textContent !== before, first);
    assert.match(await page.locator('#ray').textContent(), /^Inside from 0\.000 to (0\.9|1\.0)/);
    await browser.close(page);
});

test("the paper's map is shown in layers, cut open, with the points where it differs", async () => {
    const page = await browser.open('#view=map&map=distance&slice=0.1');
    await page.waitForFunction(() => document.getElementById('legend').textContent.includes('layer'));
    await untilRay(page);
    await page.waitForTimeout(500);
    const layers = (await page.locator('#legend').textContent()).match(/layer \d/g);
    assert.deepEqual(layers, layers.map((_, k) => `layer ${k + 1}`));
    assert.ok(layers.length > (hasHorse ? 2 : 1), `${layers.length} layers`);
    await picture(page, 'map_distance');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});
