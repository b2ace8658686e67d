// Two cloths side by side, and what the view of the map says of the two maps.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { SMALL, hasHorse, picture, startBrowser, untilFrame } from './support.mjs';

let browser;
before(async () => (browser = await startBrowser()));
after(() => browser?.stop());

const half = (page, side) => page.locator(`#half-${side} span`).textContent();
const untilWrong = (page) => page.waitForFunction(() => document.getElementById('half-right').className === 'bad', null, { timeout: 90_000 });

test('beside surfaces, particles alone let faces be cut, which both halves count', async () => {
    const page = await browser.open('#model=torus&particles=400&thickness=0.1&beside=particles', SMALL);
    await untilWrong(page);
    assert.match(await page.locator('#half-right').textContent(), /^Particles only.*cut/);
    assert.match(await half(page, 'left'), /^none inside/);
    await picture(page, 'beside_particles');
    await page.locator('input[name=beside][value=nothing]').check();
    assert.ok(!(await page.locator('#halves').isVisible()));
    const frame = await page.evaluate(() => Number(document.body.dataset.frame));
    await untilFrame(page, frame + 8);
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test("beside the exact map, the paper's lets particles in", { skip: !hasHorse && 'the horse is not installed' }, async () => {
    const page = await browser.open('#particles=2500&thickness=0.1&beside=map', { viewport: { width: 700, height: 420 } });
    await untilWrong(page);
    assert.match(await page.locator('#half-right').textContent(), /paper’s map/);
    assert.doesNotMatch(await half(page, 'left'), /\d/);
    await picture(page, 'beside_map');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('both halves keep step, pause together and are pulled together', async () => {
    const page = await browser.open('#model=torus&particles=400&beside=particles', SMALL);
    await page.waitForFunction(() => document.getElementById('half-right').textContent.includes('one inside'), null, { timeout: 60_000 });
    await untilFrame(page, 15);
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    await page.mouse.move(x + 0.75 * width, y + 0.5 * height);
    await page.mouse.down();
    assert.ok(await page.locator('#canvas.dragging').isVisible(), 'the cloth of the right half is held');
    await page.mouse.up();
    await page.keyboard.press('Space');
    await page.waitForFunction(() => document.body.dataset.paused === 'true');
    await page.keyboard.press('c');
    await page.waitForFunction(() => !location.hash.includes('beside'));
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test("the view of the paper's map says how many points near the surface are on another side", async () => {
    const page = await browser.open('#model=torus&view=map&map=distance&directions=2500&particles=100', SMALL);
    await page.waitForFunction(() => /within 0\.02\u2009R of the surface/.test(document.getElementById('legend').textContent));
    const [near, everywhere] = (await page.locator('#legend').textContent()).match(/[\d.]+(?=\u2009%)/g).map(Number);
    assert.ok(near > everywhere && near > 0, `${near} % and ${everywhere} %`);
    await browser.close(page);
});

test('what the view of one map shows goes when the other comes', async () => {
    const page = await browser.open('#model=torus&view=map&particles=100', SMALL);
    await page.waitForFunction(() => /side/.test(document.getElementById('ray').textContent));
    const seen = await page.evaluate(() => {
        const texts = [];
        new MutationObserver(() => texts.push(document.getElementById('ray').textContent)).observe(document.getElementById('ray'), { childList: true, characterData: true, subtree: true });
        globalThis.rays = texts;
        return texts.length;
    });
    assert.equal(seen, 0);
    await page.keyboard.press('x');
    await page.waitForFunction(() => globalThis.rays.length >= 2);
    assert.equal(await page.evaluate(() => globalThis.rays[0]), 'Point at the surface.');
    assert.ok(!(await page.locator('#figure-step').isVisible()), 'figures of the cloth are not shown with the map');
    await browser.close(page);
});
