// The page written by `echinus simulate --html`, opened from the disk in Chromium.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { figure, picture, startBrowser } from './support.mjs';

const inProject = (path) => fileURLToPath(new URL(`../../${path}`, import.meta.url));
const program = inProject('build/release/tools/echinus');
const player = inProject('build/web/player.html');
const skip = !existsSync(program) && 'build/release/tools/echinus is not built';
const SMALL = { viewport: { width: 900, height: 480 } };

/** Writes out/web/NAME.html and gives its address. */
function record(name, scene, ...options) {
    mkdirSync(inProject('out/web'), { recursive: true });
    const page = inProject(`out/web/${name}.html`);
    execFileSync(program, ['simulate', scene, '--html', page, '--player', player, ...options], { stdio: ['ignore', 'ignore', 'inherit'] });
    return pathToFileURL(page).href;
}

let browser, torus, horse;
before(async () => {
    if (skip) return;
    torus = record('recorded_torus', inProject('scenes/torus_small.json'));
    if (existsSync(inProject('models/horse.3ds'))) horse = record('recorded_horse', inProject('scenes/horse.json'), '--particles', '900');
    browser = await startBrowser();
});
after(() => browser?.stop());

const frameOf = (page) => page.evaluate(() => Number(document.body.dataset.frame));
const untilPlayed = (page, frame) => page.waitForFunction((least) => Number(document.body.dataset.frame) >= least, frame, { timeout: 60_000 });
const lastOf = async (page) => Number(await page.locator('#scrub').getAttribute('max'));
/** Moves the slider and waits until its frame is drawn. */
async function scrubTo(page, frame) {
    await untilRead(page);
    await page.locator('#scrub').fill(String(frame));
    await page.waitForFunction((wanted) => Number(document.body.dataset.frame) === wanted, frame);
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}
/** Waits until all frames have been read from the page. */
const untilRead = (page) => page.waitForFunction(() => document.body.dataset.read === 'true');

test('a recorded page plays from the disk with an empty console', { skip }, async () => {
    const page = await browser.open(torus, SMALL);
    await untilPlayed(page, 20);
    assert.equal(await figure(page, 'inside'), '0');
    assert.equal(await figure(page, 'particles'), '900');
    assert.match(await page.locator('#about').textContent(), /torus.*faces of the cloth.*machine/);
    await picture(page, 'player_falling');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a recording all of whose frames were judged shows the pairs of faces that intersect, and another does not', { skip }, async () => {
    const judged = record('recorded_judged', inProject('scenes/torus_small.json'), '--frames', '120', '--judge', 'all');
    const page = await browser.open(judged, SMALL);
    await untilPlayed(page, 10);
    for (const name of ['pairs', 'own-pairs']) assert.equal(await figure(page, name), '0');
    await page.goto(torus);
    await untilPlayed(page, 1);
    assert.ok(!(await page.locator('#figure-pairs').isVisible()));
    await browser.close(page);
});

test('it requests nothing but itself', { skip }, async () => {
    const page = await browser.open(torus, SMALL);
    const asked = [];
    page.on('request', (request) => asked.push(request.url()));
    await page.reload();
    await untilPlayed(page, 5);
    assert.deepEqual(asked.filter((url) => !url.startsWith('data:')), [torus]);
    await browser.close(page);
});

test('a visitor can pause, step, go to any frame, and start over', { skip }, async () => {
    const page = await browser.open(torus, SMALL);
    await untilPlayed(page, 5);
    await page.keyboard.press('Space');
    await page.waitForFunction(() => document.getElementById('pause').textContent === 'Play');
    const held = await frameOf(page);
    await page.waitForTimeout(300);
    assert.equal(await frameOf(page), held);
    await page.locator('#step').click();
    await page.waitForFunction((next) => Number(document.body.dataset.frame) === next, held + 1);
    await page.keyboard.press('ArrowLeft');
    await page.waitForFunction((before) => Number(document.body.dataset.frame) === before, held);
    const last = await lastOf(page);
    await scrubTo(page, last);
    await picture(page, 'player_end');
    await page.locator('#restart').click();
    await page.waitForFunction((end) => Number(document.body.dataset.frame) < end / 2, last);
    await browser.close(page);
});

test('between two recorded frames the cloth goes on, and a pause on a frame shows that frame', { skip }, async () => {
    const page = await browser.open(torus, SMALL);
    await page.locator('#speed').selectOption('0.1');
    await untilPlayed(page, 2);
    await page.waitForFunction(() => Number(document.body.dataset.share) > 0.1 && Number(document.body.dataset.share) < 0.9);
    await scrubTo(page, 10);
    assert.equal(await page.evaluate(() => document.body.dataset.share), '0.00');
    await browser.close(page);
});

test('at a higher speed it comes to the end, and stays there', { skip }, async () => {
    const page = await browser.open(torus, SMALL);
    await page.locator('#speed').selectOption('4');
    await page.waitForFunction(() => document.getElementById('pause').textContent === 'Play', null, { timeout: 60_000 });
    assert.equal(await frameOf(page), await lastOf(page));
    await browser.close(page);
});

test('the saved picture shows the cloth', { skip }, async () => {
    const page = await browser.open(torus, SMALL);
    await untilPlayed(page, 2);
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#save-picture').click()]);
    const bytes = await readFile(await download.path());
    assert.equal(bytes.toString('latin1', 1, 4), 'PNG');
    assert.ok(bytes.length > 5000, `${bytes.length} bytes are an empty picture`);
    await browser.close(page);
});

test('a page that carries the horse carries its notice, and the licence of three.js', { skip: skip || (!existsSync(inProject('models/horse.3ds')) && 'the horse is not installed') }, async () => {
    const page = await browser.open(horse);
    await untilPlayed(page, 60);
    assert.match(await page.locator('#model-notice').textContent(), /glmark2-data, licence GPL-3/);
    assert.match(await page.locator('footer').textContent(), /three\.js authors/);
    await scrubTo(page, await lastOf(page));
    await picture(page, 'player_horse');
    assert.equal(await figure(page, 'inside'), '0');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a cloth of any shape is drawn', { skip }, async () => {
    const page = await browser.open(record('recorded_bag', inProject('scenes/bag.json'), '--frames', '140'), SMALL);
    await scrubTo(page, await lastOf(page));
    assert.match(await page.locator('#about').textContent(), /faces of the cloth\s*3.480/);
    assert.equal(await figure(page, 'inside'), '0');
    await picture(page, 'player_bag');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a thread is drawn, and falls', { skip }, async () => {
    const vertices = Array.from({ length: 41 }, (_, i) => `v ${-1.5 + 0.075 * i} 0.95 0.6`);
    const line = `l ${vertices.map((_, i) => i + 1).join(' ')}`;
    writeFileSync(inProject('out/web/thread.obj'), [...vertices, line].join('\n'));
    const scene = inProject('out/web/thread.json');
    writeFileSync(scene, JSON.stringify({ model: { torus: {} }, cloth: { mesh: 'thread.obj', thickness: 0.02 }, frame_limit: 60 }));
    const page = await browser.open(record('recorded_thread', scene), SMALL);
    await page.addStyleTag({ content: '#transport { opacity: 0 }' });
    const seenAt = async (frame) => {
        await scrubTo(page, frame);
        return page.locator('#canvas').screenshot();
    };
    const before = await seenAt(0);
    assert.ok(!before.equals(await seenAt(await lastOf(page))));
    await picture(page, 'player_thread');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a turning model is shown turning', { skip }, async () => {
    const scene = inProject('out/web/turning_box.json');
    const outOfSight = { size: [1, 1], particles: [2, 2], position: [0, 0, 50] };
    writeFileSync(scene, JSON.stringify({ model: { box: {} }, collider: { angular_velocity: [0, 0, 90] }, cloth: outOfSight, frame_limit: 120 }));
    const page = await browser.open(record('recorded_turning', scene), SMALL);
    await page.addStyleTag({ content: '#transport { opacity: 0 }' }); // its slider moves as well
    const seenAt = async (frame) => {
        await scrubTo(page, frame);
        return page.locator('#canvas').screenshot();
    };
    const before = await seenAt(0);
    assert.ok(!before.equals(await seenAt(await lastOf(page))));
    assert.ok(before.equals(await seenAt(0)));
    await picture(page, 'player_turning');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('names that contain markup are shown literally', { skip }, async () => {
    const scene = inProject('out/web/<img src=x onerror=alert(1)>.json');
    writeFileSync(scene, readFileSync(inProject('scenes/torus_small.json')));
    const page = await browser.open(record('recorded_name', scene, '--frames', '8'), SMALL);
    await untilPlayed(page, 1);
    assert.equal(await page.locator('#scene').textContent(), '<img src=x onerror=alert(1)>.json');
    assert.equal(await page.locator('#panel img').count(), 0);
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});

test('a narrow dark screen shows everything without scrolling sideways', { skip }, async () => {
    const page = await browser.open(torus, { viewport: { width: 390, height: 844 }, hasTouch: true, colorScheme: 'dark' });
    await untilPlayed(page, 40);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await picture(page, 'player_narrow');
    await browser.close(page);
});

test('damaged data and a player without a recording give one sentence each', { skip }, async () => {
    const damaged = inProject('out/web/recorded_damaged.html');
    const text = readFileSync(fileURLToPath(torus), 'utf8');
    const middle = text.indexOf('id="data">') + 200_000;
    writeFileSync(damaged, `${text.slice(0, middle)}AAAAAAAA${text.slice(middle + 80)}`);
    const page = await browser.open(pathToFileURL(damaged).href, SMALL);
    await page.waitForFunction(() => document.querySelector('#notice span').textContent.startsWith('The recording in this page cannot be read: '));
    await page.goto(pathToFileURL(player).href);
    await page.waitForFunction(() => document.querySelector('#notice span').textContent.startsWith('This page holds no recording.'));
    await browser.close(page);
});
