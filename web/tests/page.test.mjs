// The built page in Chromium: its first appearance, and what a visitor can save.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { SMALL, figure, hasHorse, numberOf, picture, startBrowser, untilFrame, untilRay } from './support.mjs';

/** For pictures that are only compared: software takes seconds for a large one. */
const TINY = { viewport: { width: 400, height: 260 } };

let browser;
before(async () => (browser = await startBrowser()));
after(() => browser?.stop());

test('the page opens with the cloth already falling and an empty console', async () => {
    const page = await browser.open('', { fresh: true });
    await untilFrame(page, 10);
    assert.equal(await figure(page, 'inside'), '0');
    assert.ok(numberOf(await figure(page, 'bytes')) > 0);
    assert.match(await page.locator('#subtitle').textContent(), hasHorse ? /^horse\.3ds, 7\u2009160 faces$/ : /^torus/);
    await picture(page, 'opened');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a picture of the opening example stands in until its model is there, and for no other example', async () => {
    const beforeLoad = () => (globalThis.Worker = class { postMessage() {} addEventListener() {} terminate() {} });
    const shows = async (link) => {
        const page = await browser.open(link, { ...TINY, beforeLoad });
        const poster = page.locator('#poster');
        await page.waitForFunction(() => document.getElementById('subtitle').textContent === 'Loading' && document.getElementById('poster').complete);
        const is = await poster.evaluate((picture) => !picture.hidden && picture.naturalWidth > 0);
        await browser.close(page);
        return is;
    };
    assert.ok(await shows(''));
    assert.ok(!(await shows('#model=flag')));
    const page = await browser.open('', TINY);
    await untilFrame(page, 1);
    assert.ok(!(await page.locator('#poster').isVisible()));
    await browser.close(page);
});

test('a page that carries the horse carries the notice and the text of its licence', { skip: !hasHorse && 'the horse is not installed' }, async () => {
    const page = await browser.open('#particles=100', SMALL);
    await untilFrame(page, 1);
    const notice = page.locator('#horse-notice a');
    assert.ok(await notice.isVisible());
    for (const file of ['models/NOTICE.txt', 'models/GPL-3.txt', 'LICENSES.txt']) assert.ok((await page.request.get(new URL(file, page.url()).href)).ok(), file);
    await browser.close(page);
});

test('a link restores the state that it was copied from', async () => {
    const page = await browser.open('#model=sphere&map=distance&particles=2500&friction=0.9&view=map', SMALL);
    await page.waitForFunction(() => document.getElementById('map-figures').textContent.includes('directions'));
    assert.equal(await page.locator('select[name=model]').inputValue(), 'sphere');
    assert.ok(await page.locator('input[name=map][value=distance]').isChecked());
    await page.locator('input[name=view][value=cloth]').check();
    await page.waitForFunction(() => location.hash === '#model=sphere&map=distance&particles=2500&friction=0.9');
    await browser.close(page);
});

test('a link contains the position of the camera, and a broken one gives the default view', async () => {
    const seen = async (link) => {
        const page = await browser.open(link, TINY);
        await untilRay(page);
        await page.waitForTimeout(500);
        if (await page.locator('#notice').isVisible()) await page.locator('#notice button').click(); // it lies over the picture
        const canvas = await page.locator('#canvas').screenshot();
        await browser.close(page);
        return canvas;
    };
    const usual = await seen('#model=torus&view=map');
    assert.ok(!usual.equals(await seen(`#model=torus&view=map&${await linkAfterTurning()}`)), 'the camera has moved');
    for (const broken of ['camera=40_20', 'camera=40_20_-3_0_0_0', 'constructor=1&__proto__=1', 'particles=1e-9&slice=NaN'])
        assert.ok(usual.equals(await seen(`#model=torus&view=map&${broken}`)), broken);
});

test('a window that changes its shape shows the model as one that had that shape', async () => {
    const sizes = [{ width: 800, height: 300 }, { width: 320, height: 480 }];
    const seen = async (page) => {
        await untilRay(page);
        await page.waitForTimeout(500);
        return page.locator('#canvas').screenshot();
    };
    const page = await browser.open('#model=torus&view=map', { viewport: sizes[1] });
    const narrow = await seen(page);
    await browser.close(page);
    const turned = await browser.open('#model=torus&view=map', { viewport: sizes[0] });
    await seen(turned);
    await turned.setViewportSize(sizes[1]);
    assert.ok(narrow.equals(await seen(turned)));
    assert.ok(!(await turned.evaluate(() => location.hash)).includes('camera'));
    await browser.close(turned);
});

/** After a visitor has turned the view, the address contains the camera, and opening that address restores it. */
async function linkAfterTurning() {
    const page = await browser.open('#model=torus&view=map', SMALL);
    await untilRay(page);
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    await page.mouse.move(x + 0.5 * width, y + 0.5 * height);
    await page.mouse.down();
    await page.mouse.move(x + 0.8 * width, y + 0.4 * height, { steps: 3 });
    await page.mouse.up();
    await page.waitForFunction(() => location.hash.includes('camera='));
    await page.waitForTimeout(1000); // damping ends
    const hash = await page.evaluate(() => location.hash);
    await browser.close(page);
    const again = await browser.open(hash, SMALL);
    await untilRay(again);
    await again.waitForTimeout(500);
    assert.equal(await again.evaluate(() => location.hash), hash);
    await browser.close(again);
    return hash.split('&').at(-1);
}

test('a button leads back to the whole model', async () => {
    const page = await browser.open('#model=torus&view=map&camera=10_80_1_0_0_0', SMALL);
    await untilRay(page);
    await page.locator('#whole-view').click();
    await page.waitForFunction(() => location.hash === '#model=torus&view=map');
    assert.ok(!(await page.locator('#whole-view').isVisible()));
    await browser.close(page);
});

test('a choice that is not available is not shown as in force', { skip: !hasHorse && 'the horse is not installed' }, async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await untilFrame(page, 1);
    await page.context().route('**/horse.3ds', (route) => route.fulfill({ status: 404 }));
    await page.locator('select[name=model]').selectOption('horse');
    await page.locator('#notice').waitFor();
    assert.match(await page.locator('#notice span').textContent(), /^horse\.3ds.*404/);
    assert.equal(await page.locator('select[name=model]').inputValue(), 'torus');
    assert.match(await page.locator('#subtitle').textContent(), /^torus/);
    assert.equal(await page.evaluate(() => location.hash), '#model=torus&particles=400');
    await browser.close(page);
});

test('the link that is copied is the one of the address', async () => {
    const page = await browser.open('#model=torus&particles=400', { ...SMALL, permissions: ['clipboard-read', 'clipboard-write'] });
    await untilFrame(page, 1);
    await page.locator('input[name=friction]').fill('0.8');
    await page.locator('#copy-link').click();
    await page.locator('#remark', { hasText: 'The link is copied.' }).waitFor();
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), page.url());
    assert.match(page.url(), /#model=torus&particles=400&friction=0\.8$/);
    await browser.close(page);
});

test('keys pause, step and drop the cloth and change the view and the map, and a list keeps its own', async () => {
    const page = await browser.open('#model=sphere&particles=400', SMALL);
    await untilFrame(page, 20);
    const pausing = () => page.locator('#pause').textContent();
    const frame = () => page.evaluate(() => Number(document.body.dataset.frame));
    const untilLink = (part, there) => page.waitForFunction(([part, there]) => location.hash.includes(part) === there, [part, there]);
    await page.keyboard.press('s');
    assert.equal(await pausing(), 'Resume');
    await page.waitForFunction(() => document.body.dataset.paused === 'true');
    const held = await frame();
    await page.keyboard.press('S');
    await page.waitForFunction((next) => Number(document.body.dataset.frame) === next, held + 1);
    await page.keyboard.press('r');
    await page.waitForFunction((before) => Number(document.body.dataset.frame) < before, held);
    assert.equal(await pausing(), 'Pause');
    await page.keyboard.press('m');
    await untilLink('view=map', true);
    await page.keyboard.press('Space');
    assert.equal(await pausing(), 'Pause', 'a cloth that is not in sight is left alone');
    await page.keyboard.press('x');
    await untilLink('map=distance', true);
    await page.keyboard.press('ArrowLeft');
    await untilLink('camera=', true);
    await page.keyboard.press('m');
    await untilLink('view=map', false);

    await page.locator('select[name=model]').focus();
    await page.keyboard.press('m');
    await page.locator('input[name=friction]').focus();
    await page.keyboard.press('Space');
    assert.equal(await pausing(), 'Resume', 'a slider has no use for space');
    assert.ok(!page.url().includes('view=map'), 'and a list has for letters');
    await browser.close(page);
});

test('a list gives the keys back once the pointer has chosen from it', async () => {
    const page = await browser.open('#model=sphere&particles=100', SMALL);
    await untilFrame(page, 1);
    const colour = page.locator('select[name=colour]');
    await colour.dispatchEvent('pointerdown');
    await colour.focus();
    await colour.selectOption('depth');
    await page.keyboard.press('Space');
    assert.equal(await page.locator('#pause').textContent(), 'Resume');
    await colour.focus();
    await page.keyboard.press('ArrowUp');
    assert.ok(await colour.evaluate((list) => list === document.activeElement), 'keys that move in a list stay in it');
    await browser.close(page);
});

test('a click on a figure says what it means, and the time of a step stands beside what it simulates', async () => {
    const page = await browser.open('#model=torus&particles=400', SMALL);
    await page.waitForFunction(() => /^\d+(\.\d+)?\u2009ms$/.test(document.getElementById('figure-step').textContent) && document.getElementById('name-step').textContent === 'a 16.7\u2009ms step takes');
    for (const figure of await page.locator('#figures > div:visible').all()) {
        await figure.click();
        assert.match(await page.locator('#remark').textContent(), new RegExp(`^${await figure.locator('dt').textContent()}: .{20}`));
    }
    await browser.close(page);
});

test('the saved mesh is an OBJ file of the cloth and the model', async () => {
    const page = await browser.open('#model=sphere&particles=400', SMALL);
    await untilFrame(page, 2);
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#save-mesh').click()]);
    const text = await readFile(await download.path(), 'utf8');
    const { length } = text.match(/^v /gm);
    assert.equal(length, 400 + (await page.evaluate(() => Number(/faces, ([\d\u2009]+) vertices/.exec(document.getElementById('report').textContent)[1].replace('\u2009', '')))));
    await browser.close(page);
});

test('the saved picture is a PNG file of the canvas', async () => {
    const page = await browser.open('#model=sphere&particles=400', SMALL);
    await untilFrame(page, 2);
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#save-picture').click()]);
    const bytes = await readFile(await download.path());
    const { width, height } = await page.locator('#canvas').boundingBox();
    assert.equal(bytes.toString('latin1', 1, 4), 'PNG');
    assert.deepEqual([bytes.readUInt32BE(16), bytes.readUInt32BE(20)], [Math.round(width), Math.round(height)]);
    await browser.close(page);
});

test('a narrow screen shows everything without scrolling sideways', async () => {
    const page = await browser.open('#particles=2500', { viewport: { width: 390, height: 844 }, hasTouch: true });
    await untilFrame(page, 8);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await picture(page, 'narrow');
    await browser.close(page);
});

test('in the dark the page is dark', async () => {
    const page = await browser.open('#model=torus&particles=2500&colour=depth', { colorScheme: 'dark' });
    await untilFrame(page, 40);
    assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), 'rgb(27, 29, 33)');
    await picture(page, 'dark');
    await browser.close(page);
});

test('a browser without vectors gets a message that names what it lacks', async () => {
    const page = await browser.open('', { ...SMALL, beforeLoad: () => (WebAssembly.validate = () => false) });
    await page.locator('.lacking').waitFor();
    assert.match(await page.locator('.lacking').textContent(), /needs WebAssembly SIMD/);
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a browser without WebGL gets a message', async () => {
    const page = await browser.open('', { ...SMALL, beforeLoad: () => (HTMLCanvasElement.prototype.getContext = () => null) });
    await page.locator('.lacking').waitFor();
    assert.match(await page.locator('.lacking').textContent(), /needs WebGL 2/);
    for (const link of await page.locator('.lacking a').all()) assert.ok((await page.request.get(new URL(await link.getAttribute('href'), page.url()).href)).ok());
    assert.ok(await page.locator('.lacking img').isVisible());
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a browser without JavaScript gets a sentence and the documents', async () => {
    const page = await browser.open('', { ...SMALL, javaScriptEnabled: false, folded: true });
    assert.match(await page.locator('#subtitle').textContent(), /needs JavaScript/);
    assert.ok(await page.locator('#subtitle a').first().isVisible());
    await browser.close(page);
});

test('the camera does not come so near that it is inside the cloth', async () => {
    const page = await browser.open('#model=sphere&particles=100', SMALL);
    await untilFrame(page, 1);
    for (let press = 0; press < 50; ++press) {
        await page.keyboard.press('+');
        await page.waitForTimeout(20);
    }
    await page.waitForFunction(() => /camera=[^_]*_[^_]*_1\.25_/.test(location.hash));
    await browser.close(page);
});

test('a part of the page that does not arrive is reported as missing', async () => {
    const page = await browser.open('about:blank', { ...SMALL, fresh: true });
    await page.route('**/assets/app-*.js', (route) => route.abort());
    await page.goto(browser.address);
    await page.locator('.lacking').waitFor();
    assert.match(await page.locator('.lacking').textContent(), /could not be loaded: load the page again/);
    await browser.close(page);
});
