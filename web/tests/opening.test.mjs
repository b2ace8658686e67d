// The open model, and the one that the panel shows, when requests come faster than their answers, or fail.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { tetrahedra } from './meshes.mjs';
import { SMALL, hasHorse, startBrowser, untilFrame } from './support.mjs';

const GOOD = tetrahedra()['t.obj'];
const BROKEN = 'v 0 0 0\nf 1 2 9\n';
const OPEN = GOOD.slice(0, GOOD.lastIndexOf('f '));
const LINK = '#model=torus&particles=400';

let browser;
before(async () => (browser = await startBrowser()));
after(() => browser?.stop());

const openPage = async () => {
    const page = await browser.open(LINK, SMALL);
    page.setDefaultTimeout(8000);
    await untilFrame(page, 1);
    return page;
};
const untilTitle = (page, words) => page.waitForFunction((part) => document.getElementById('subtitle').textContent.startsWith(part), words);
const untilChosen = (page, name) => page.waitForFunction((text) => document.querySelector('select[name=model]').selectedOptions[0]?.textContent === text, name);
const notice = (page) => page.locator('#notice span').textContent();

/** Drops all files before the page can receive any answer. */
const drop = (page, files) =>
    page.evaluate((files) => {
        for (const [name, text] of files) {
            const dataTransfer = new DataTransfer();
            dataTransfer.items.add(new File([text], name));
            document.getElementById('canvas').dispatchEvent(new DragEvent('drop', { bubbles: true, cancelable: true, dataTransfer }));
        }
    }, files);

test('after a good file and a broken one right behind it, the good one is open and shown in the panel', async () => {
    const page = await openPage();
    await drop(page, [['good.obj', GOOD], ['broken.obj', BROKEN]]);
    await page.locator('#notice').waitFor();
    assert.match(await notice(page), /^broken\.obj/);
    await untilChosen(page, 'good.obj');
    await untilTitle(page, 'good.obj, 4 faces');
    await page.locator('input[name=mend]').uncheck();
    await untilTitle(page, 'good.obj, 4 faces');
    assert.equal(await page.locator('select[name=model] option:checked').textContent(), 'good.obj');
    assert.match(await page.evaluate(() => location.hash), /mend=false/);
    await browser.close(page);
});

test('of a large file and a small one right behind it, the small one stays', async () => {
    const page = await openPage();
    await page.evaluate(() => {
        globalThis.titles = [];
        const title = document.getElementById('subtitle');
        new MutationObserver(() => globalThis.titles.push(title.textContent)).observe(title, { childList: true, characterData: true, subtree: true });
    });
    await drop(page, [['large.obj', '# nothing\n'.repeat(1_000_000) + GOOD], ['small.obj', GOOD]]);
    await page.waitForFunction(() => ['large', 'small'].every((name) => globalThis.titles.includes(`${name}.obj, 4 faces`)));
    await untilChosen(page, 'small.obj');
    assert.match(await page.locator('#subtitle').textContent(), /^small\.obj/);
    await browser.close(page);
});

test('a link to a sample closes the file that is open', async () => {
    const page = await openPage();
    await drop(page, [['good.obj', GOOD]]);
    await untilTitle(page, 'good.obj, 4 faces');
    await page.evaluate(() => (location.hash = '#model=sphere&particles=400'));
    await untilTitle(page, 'sphere');
    assert.equal(await page.locator('select[name=model]').inputValue(), 'sphere');
    await browser.close(page);
});

test('whoever goes back to a file finds it open; after the page is loaded again it says that the file is not', async () => {
    const page = await openPage();
    await drop(page, [['good.obj', GOOD]]);
    await untilTitle(page, 'good.obj, 4 faces');
    await page.goBack();
    await untilTitle(page, 'torus');
    await page.goForward();
    await untilTitle(page, 'good.obj, 4 faces');
    await page.locator('#gallery a', { hasText: 'flag' }).click();
    await untilTitle(page, 'flag');
    await page.goBack();
    await untilTitle(page, 'good.obj, 4 faces');
    await untilChosen(page, 'good.obj');
    await page.goForward();
    await untilTitle(page, 'flag');
    await page.goBack();
    await untilTitle(page, 'good.obj, 4 faces');
    await page.reload();
    await untilTitle(page, 'torus');
    assert.match(await notice(page), /^good\.obj was open here\./);
    await browser.close(page);
});

test('a link that asks for what the page does not have opens the rest and says so', async () => {
    const page = await browser.open('#model=hors&particles=400&thickness=thin&wind=99&beside=map&colour=fabric&__proto__=1', SMALL);
    await untilFrame(page, 1);
    assert.equal(await notice(page), 'The page cannot take these parts of the link: model=hors, thickness=thin, wind=99 (but 10), __proto__=1.');
    await page.evaluate(() => (location.hash = '#model=torus&particles=400'));
    await untilTitle(page, 'torus');
    assert.ok(!(await page.locator('#notice').isVisible()));
    for (const [wrong, named] of [['thickness=NaN', 'thickness=NaN'], ['beside=particles&map=distance', 'map=distance (but exact)'], ['self=true&surfaces=false', 'self=true (but false)']]) {
        await page.evaluate((part) => (location.hash = `#model=torus&particles=400&${part}`), wrong);
        await page.waitForFunction((words) => document.querySelector('#notice span').textContent === `The page cannot take these parts of the link: ${words}.`, named);
        assert.ok(await page.locator('#notice').isVisible());
    }
    await browser.close(page);
});

test('whoever chooses a sample from the list finds the file by going back', async () => {
    const page = await openPage();
    await drop(page, [['good.obj', GOOD]]);
    await untilTitle(page, 'good.obj, 4 faces');
    await page.locator('select[name=model]').selectOption('sphere');
    await untilTitle(page, 'sphere');
    await page.goBack();
    await untilTitle(page, 'good.obj, 4 faces');
    await browser.close(page);
});

test('a server without the horse gets a torus instead, and the page says so', { skip: !hasHorse && 'the horse is not installed' }, async () => {
    const page = await browser.open('about:blank', { ...SMALL, fresh: true });
    await page.route('**/horse.3ds', (route) => route.fulfill({ status: 404 }));
    await page.goto(browser.address);
    await untilTitle(page, 'torus');
    assert.equal(await notice(page), 'horse.3ds: the server answers with status 404. The page shows a torus instead.');
    await browser.close(page);
});

test('a change made while a broken file is read takes effect, and the panel shows it', async () => {
    const page = await openPage();
    await page.evaluate(changeOnOpening);
    await drop(page, [['broken.obj', BROKEN]]);
    await page.locator('#notice').waitFor();
    await untilChosen(page, 'Torus');
    assert.match(await page.locator('#subtitle').textContent(), /^torus/);
    assert.equal(await page.evaluate(() => location.hash), '#model=torus&particles=2500');
    assert.equal(await page.locator('label:has([name=particles]) output').textContent(), '2\u2009500');
    await page.waitForFunction(() => document.body.dataset.rest === 'false');
    let count;
    for (let turn = 0; turn < 20 && count !== 2500; ++turn) count = await particlesIn(page);
    assert.equal(count, 2500);
    await browser.close(page);
});

/** Runs in the page: sets 2500 particles as soon as a file has gone to the worker, before its answer can arrive. */
function changeOnOpening() {
    const title = document.getElementById('subtitle');
    const input = document.querySelector('[name=particles]');
    const observer = new MutationObserver(() => {
        observer.disconnect();
        input.value = Math.log(2500 / 100) / Math.log(1000);
        for (const event of ['input', 'change']) input.dispatchEvent(new Event(event, { bubbles: true }));
    });
    observer.observe(title, { childList: true });
}

/** As many as the saved mesh has; undefined where the page says that there is no cloth yet. */
async function particlesIn(page) {
    const saved = page.waitForEvent('download', { timeout: 2000 }).catch(() => undefined);
    await page.locator('#save-mesh').click();
    const download = await saved;
    if (!download) return undefined;
    const text = await readFile(await download.path(), 'utf8');
    return text.slice(text.indexOf('o cloth'), text.indexOf('o model')).match(/^v /gm).length;
}

test('a worker that does not load is reported once, and not restarted endlessly', async () => {
    const page = await browser.open(LINK, { ...SMALL, beforeLoad: withoutWorker });
    await page.locator('#notice').waitFor();
    assert.match(await notice(page), /^The simulation did not start/);
    await page.waitForTimeout(500);
    const begun = await page.evaluate(() => globalThis.workersBegun);
    assert.ok(begun <= 2, `${begun} workers`); // one may fail before the page listens
    assert.equal(await page.locator('#subtitle').textContent(), '');
    await browser.close(page);
});

/** Runs in the page: makes the worker's script unavailable. */
function withoutWorker() {
    globalThis.workersBegun = 0;
    globalThis.Worker = class extends Worker {
        constructor(_, options) {
            super(new URL('missing.js', document.baseURI), options);
            ++globalThis.workersBegun;
        }
    };
}

test('only closed meshes get the note that no particle gets through', async () => {
    const page = await openPage();
    await page.locator('input[name=surfaces]').uncheck();
    assert.match(await page.locator('#map-note').textContent(), /No particle passes through/);
    await drop(page, [['open.obj', OPEN]]);
    await untilTitle(page, 'open.obj, 3 faces');
    assert.match(await page.locator('#map-note').textContent(), /The mesh is open/);
    assert.doesNotMatch(await page.locator('#map-note').textContent(), /No particle passes through/);
    await browser.close(page);
});

test('the notice about a broken file disappears when a sample is opened', async () => {
    const page = await openPage();
    await drop(page, [['broken.obj', BROKEN]]);
    await page.locator('#notice').waitFor();
    await page.locator('select[name=model]').selectOption('sphere');
    await untilTitle(page, 'sphere');
    assert.ok(!(await page.locator('#notice').isVisible()));
    await browser.close(page);
});
