// Files that a visitor opens.
import assert from 'node:assert/strict';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { gltfNumbers, gltfTetrahedron, tetrahedra, torusStl } from './meshes.mjs';
import { SMALL, picture, startBrowser, untilFrame, watchPauses } from './support.mjs';

const CLOSED = tetrahedra()['t.obj'];
const OPEN_TETRAHEDRON = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n';

let browser;
before(async () => (browser = await startBrowser()));
after(() => browser?.stop());

const choose = (page, name, content) => page.locator('#file').setInputFiles({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(content) });
/** The sentence about a file that cannot be opened. */
const refusal = async (page, name, content) => {
    await choose(page, name, content);
    await page.locator('#notice').waitFor();
    return page.locator('#notice span').textContent();
};
const untilReport = (page, words) => page.waitForFunction((part) => document.getElementById('report').textContent.includes(part), words, { timeout: 120_000 });
const untilTitle = (page, words) => page.waitForFunction((part) => document.getElementById('subtitle').textContent.startsWith(part), words);

test('OBJ, PLY, STL, OFF and GLB files are opened', async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await untilFrame(page, 1);
    for (const [name, content] of Object.entries(tetrahedra())) {
        await choose(page, name, content);
        await untilTitle(page, `${name}, 4 faces`);
        assert.match(await page.locator('#report').textContent(), /^4 faces, 4 vertices, one partClosed/, name);
        assert.equal(await page.locator('select[name=model] option:checked').textContent(), name);
    }
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a file that is dropped on the page is opened', async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await untilFrame(page, 1);
    const transfer = await page.evaluateHandle((text) => {
        const transfer = new DataTransfer();
        transfer.items.add(new File([text], 'dropped.off'));
        return transfer;
    }, tetrahedra()['t.off']);
    await page.dispatchEvent('#canvas', 'dragover', { dataTransfer: transfer });
    assert.ok(await page.locator('#drop').isVisible());
    await page.dispatchEvent('#canvas', 'drop', { dataTransfer: transfer });
    await untilTitle(page, 'dropped.off, 4 faces');
    assert.ok(!(await page.locator('#drop').isVisible()));
    await browser.close(page);
});

test('the page keeps drawing while a file of 50 MB is opened, and then shows the model', async () => {
    const folder = await mkdtemp(join(tmpdir(), 'echinus-'));
    try {
        const file = join(folder, 'large.stl');
        await writeFile(file, torusStl(1000, 500));
        const page = await browser.open('#model=torus&particles=100', SMALL);
        await untilFrame(page, 20);
        await page.evaluate(watchPauses);
        const begin = performance.now();
        await page.locator('#file').setInputFiles(file);
        await untilReport(page, '1\u2009000\u2009000 faces');
        const opening = performance.now() - begin;
        const longest = await page.evaluate(() => globalThis.longestPause);
        // About 0.4 of 8.5 seconds; both take longer where other work shares the processor.
        assert.ok(longest < Math.max(1500, opening / 6), `a pause of ${longest} ms in ${opening} ms`);
        assert.match(await page.locator('#report').textContent(), /500\u2009000 vertices, one partClosed/);
        assert.deepEqual(page.complaints, []);
        await browser.close(page);
    } finally {
        await rm(folder, { recursive: true });
    }
});

test('a broken file gives one sentence, and the page continues as it was', async () => {
    const link = '#model=torus&particles=400&camera=30_20_4_0_0_0';
    const page = await browser.open(link, SMALL);
    await untilFrame(page, 5);
    await page.keyboard.press('Space');
    assert.match(await refusal(page, 'broken.obj', 'v 0 0 0\nf 1 2 9\n'), /^broken\.obj.*2/);
    await picture(page, 'broken_file');
    assert.equal(await page.locator('#pause').textContent(), 'Resume');
    assert.equal(new URL(page.url()).hash, link);
    await page.keyboard.press('Space');
    const frame = await page.evaluate(() => Number(document.body.dataset.frame));
    await untilFrame(page, frame + 20);
    assert.match(await page.locator('#subtitle').textContent(), /^torus/);
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

for (const [kind, name, content, sentence] of [
    ['of which no map can be made', 'point.obj', 'v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n', /^point\.obj: all vertices of the mesh lie on one point/],
    ['of which a part is missing', 'short.glb', 'glTF\x02\0\0\0\x14\0\0\0', /^short\.glb: cannot be read \(it is not a complete glTF 2\.0 file\)$/],
    ['of a kind that is not read', 'archive.zip', 'PK', /^archive\.zip: .*\.obj.*\.glb/],
])
    test(`a file ${kind} is refused by its name, with the reason`, async () => {
        const page = await browser.open('#model=torus&particles=100', SMALL);
        await untilFrame(page, 1);
        assert.match(await refusal(page, name, content), sentence);
        await browser.close(page);
    });

test('a closed mesh that is inside out is reported unless it is mended, and an open one is not', async () => {
    const page = await browser.open('#model=torus&particles=100&mend=false', SMALL);
    await untilFrame(page, 1);
    const turned = (obj) => obj.replace(/^f (\d) (\d) (\d)$/gm, 'f $1 $3 $2');
    const reports = [];
    for (const [name, obj] of Object.entries({ closed: CLOSED, closed_turned: turned(CLOSED), open: OPEN_TETRAHEDRON, open_turned: turned(OPEN_TETRAHEDRON) })) {
        await choose(page, `${name}.obj`, obj);
        await untilTitle(page, `${name}.obj`);
        reports.push(/Inside out/.test(await page.locator('#report').textContent()));
    }
    assert.deepEqual(reports, [false, true, false, false]);
    await browser.close(page);
});

/** Holds the cloth where it begins: both clicks reach the worker one after the other, before it computes another frame. */
async function holdAbove(page) {
    await page.evaluate(() => {
        document.getElementById('restart').click();
        document.getElementById('pause').click();
    });
    await page.waitForFunction(() => document.body.dataset.paused === 'true' && Number(document.body.dataset.frame) < 8);
}

test('an open mesh is reported with the number of its border edges', async () => {
    const page = await browser.open('#model=torus&particles=400&self=false', SMALL);
    await untilFrame(page, 1);
    await choose(page, 'open.obj', OPEN_TETRAHEDRON);
    await untilReport(page, '3 border edges');
    assert.match(await page.locator('#report').textContent(), /Open/);
    await page.locator('input[name=surfaces]').check(); // faces of the cloth that intersect would be red, too
    await untilFrame(page, 1);
    await holdAbove(page);
    for (let press = 0; press < 8; ++press) await page.keyboard.press('ArrowDown'); // from beside, where the cloth hides less
    await page.waitForTimeout(500);
    const red = await pixelsOf(page, FAULT_RED, LINE_RED);
    assert.ok(red > 15, `the border is drawn, where the cloth does not hide it: ${red} pixels`);
    await page.locator('input[name=map][value=distance]').check();
    await page.waitForFunction(() => document.getElementById('map-note').textContent.includes('paper') || !document.getElementById('notice').hidden);
    await page.locator('#restart').click();
    await page.waitForFunction(() => Number(document.body.dataset.frame) < 25);
    await untilFrame(page, 25);
    await picture(page, 'open_mesh');
    await page.locator('input[name=map][value=exact]').check();
    await choose(page, 'closed.off', tetrahedra()['t.off']);
    await untilReport(page, 'Closed');
    await page.waitForTimeout(500);
    assert.equal(await pixelsOf(page, FAULT_RED, LINE_RED), 0, 'no line is left, and the cloth is not taken for one');
    await browser.close(page);
});

test('a line of faults shows only faintly through the cloth that hides it', async () => {
    const page = await browser.open('#model=torus&particles=900', SMALL);
    await untilFrame(page, 1);
    const cup = 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 3 2\nf 1 4 3\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n';
    await page.locator('select[name=up]').selectOption('z');
    await choose(page, 'cup.obj', cup);
    await untilReport(page, '4 border edges');
    const red = () => pixelsOf(page, FAULT_RED, LINE_RED);
    const turn = async (key, count) => {
        for (let press = 0; press < count; ++press) await page.keyboard.press(key);
        await page.waitForTimeout(500);
    };
    await untilFrame(page, 10);
    await holdAbove(page);
    await turn('ArrowDown', 8);
    const beside = await red();
    await picture(page, 'faults_beside');
    await turn('ArrowUp', 19);
    await picture(page, 'faults_hidden');
    const above = await red();
    assert.ok(beside > 20 && above < 0.1 * beside, `${beside} pixels from beside, ${above} from above`);
    await browser.close(page);
});

test('the words for one face, one vertex and one edge are in the singular', async () => {
    const page = await browser.open('#model=torus&particles=100', SMALL);
    await untilFrame(page, 1);
    const closed = tetrahedra()['t.obj'];
    await choose(page, 'doubled.obj', `${closed}${closed.trim().split('\n').at(-1)}\n`);
    await untilReport(page, '1 duplicate face removed');
    await choose(page, 'one.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n');
    await untilTitle(page, 'one.obj, 1 face');
    assert.doesNotMatch(`${await page.locator('#subtitle').textContent()} ${await page.locator('#report').textContent()}`, /\b1 (faces|vertices|edges|parts|pairs)\b/);
    await browser.close(page);
});

test('the cloth on an open mesh can be pulled, however small the mesh is', async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await untilFrame(page, 1);
    await choose(page, 'small.obj', OPEN_TETRAHEDRON.replace(/^v .*$/gm, (line) => line.replace(/[\d.]+/g, (number) => String(0.01 * number))));
    await untilReport(page, '3 border edges');
    await page.waitForFunction(() => Number(document.body.dataset.frame) < 10);
    await page.keyboard.press('Space'); // above the model
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    // Down the middle of the picture: if its border were an obstacle, the far half of the cloth could not be grabbed.
    let held = 0;
    for (let part = 0.04; part < 0.6; part += 0.015) {
        await page.mouse.move(x + 0.5 * width, y + part * height);
        await page.mouse.down();
        if (await page.locator('#canvas.dragging').isVisible()) ++held;
        await page.mouse.up();
    }
    assert.ok(held >= 9, `at ${held} places`);
    await browser.close(page);
});

/** The fault colours of view/colours.ts. */
const FAULT_RED = [0xd1, 0x24, 0x2f];
/** How far from it thin lines are, whose rims are blended. The cloth's red is farther: from 44 on, it would be counted. */
const LINE_RED = 36;

/** The number of pixels in the model's picture with about this colour. Of lines, whose rims are blended, more tolerance finds most. */
async function pixelsOf(page, colour, tolerance = 12) {
    const png = (await page.locator('#canvas').screenshot()).toString('base64');
    return page.evaluate(async ([data, wanted, tolerance]) => {
        const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
        const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
        context.drawImage(image, 0, 0);
        const { data: bytes } = context.getImageData(0, 0, image.width, image.height);
        let found = 0;
        for (let i = 0; i < bytes.length; i += 4) if (wanted.every((part, k) => Math.abs(bytes[i + k] - part) < tolerance)) ++found;
        return found;
    }, [png, colour, tolerance]);
}

test('a glTF file is opened with the file that it refers to, and of several models the first one', async () => {
    const page = await browser.open('#model=torus&particles=100', SMALL);
    await untilFrame(page, 1);
    const file = (name, content) => ({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(content) });
    await page.locator('#file').setInputFiles([file('t.bin', gltfNumbers()), file('t.gltf', gltfTetrahedron({ buffer: 't.bin' }))]);
    await untilTitle(page, 't.gltf, 4 faces');
    assert.ok(!(await page.locator('#notice').isVisible()));
    await page.locator('#file').setInputFiles([file('a.obj', CLOSED), file('b.off', tetrahedra()['t.off'])]);
    await untilTitle(page, 'a.obj, 4 faces');
    assert.equal(await page.locator('#notice span').textContent(), 'The page opens one model at a time: a.obj, and not b.off.');
    await browser.close(page);
});

test('nothing is fetched for an opened file, which is shown without its pictures', async () => {
    const page = await browser.open('#model=torus&particles=100', SMALL);
    await untilFrame(page, 1);
    const asked = [];
    page.on('request', (request) => /elsewhere/.test(request.url()) && asked.push(request.url()));
    await choose(page, 'textured.gltf', gltfTetrahedron({ texture: 'http://127.0.0.1:9/elsewhere.png' }));
    await untilTitle(page, 'textured.gltf, 4 faces');
    assert.match(await refusal(page, 'parts.gltf', gltfTetrahedron({ buffer: 'elsewhere.bin' })), /^parts\.gltf: .*elsewhere\.bin.*\.glb/);
    assert.deepEqual(asked, []);
    await browser.close(page);
});
