// How long the built page takes, for docs/web.md: from the address to the first falling cloth and the horse's first
// map, in browsers that have never seen the page, ones that stand open and ones that begin with it; and a time step of
// 10 000 particles while they fall and come to rest, with surfaces that collide and without, beside the native
// program. Run by scripts/web --speed:  speed.mjs PROGRAM SCENE
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { figure, numberOf, startBrowser, untilFrame } from './support.mjs';

const [program, scene] = process.argv.slice(2);
const LOADS = 7;
/** Time steps; the first are still slow, as the browser is optimising the code. */
const [FIRST_STEP, LAST_STEP] = [75, 375];
/** A small picture, since rendering is by software. */
const TINY = { viewport: { width: 390, height: 300 } };

const mean = (values) => values.reduce((a, b) => a + b) / values.length;
const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
const all = (values) => values.map((value) => value.toFixed(0)).join(', ');

/** By then a new browser has finished its own start-up work: its drawing and hidden pages. */
const UNTIL_IT_STANDS_OPEN_MS = 3000;

/** @param wait  how long the browser has had an empty page open when it gets the address */
async function load(wait) {
    const browser = await startBrowser();
    const page = await browser.open('about:blank', TINY);
    await page.waitForTimeout(wait);
    const begin = performance.now();
    await page.goto(browser.address, { waitUntil: 'commit' });
    await untilFrame(page, 1);
    const times = { falling: performance.now() - begin, map: numberOf(await figure(page, 'build')) };
    await browser.stop();
    return times;
}

/** @param collision  the settings of a link */
async function stepInPage(collision) {
    const browser = await startBrowser();
    const page = await browser.open(`#particles=10000&${collision}`, TINY);
    const steps = [];
    for (let frame = FIRST_STEP; frame < LAST_STEP; frame += 25) {
        await untilFrame(page, frame);
        steps.push(numberOf(await figure(page, 'step')));
    }
    await browser.stop();
    return mean(steps);
}

/** @param collision  as the scene's key  @param environment  may choose the vector instructions */
function stepOfNative(collision, environment = {}) {
    const folder = mkdtempSync(join(tmpdir(), 'echinus-'));
    const options = ['simulate', scene, '-o', folder, '--frames', String(LAST_STEP), '--every', String(LAST_STEP), '--threads', '1', '--collision', collision];
    execFileSync(program, options, { env: { ...process.env, ...environment }, stdio: 'ignore' });
    const { ms_per_frame } = JSON.parse(readFileSync(join(folder, 'report.json'), 'utf8'));
    rmSync(folder, { recursive: true });
    return ms_per_frame.total;
}

const loads = { 'that stands open': [], 'that begins with it': [] };
for (let i = 0; i < LOADS; ++i) {
    loads['that stands open'].push(await load(UNTIL_IT_STANDS_OPEN_MS));
    loads['that begins with it'].push(await load(0));
}
for (const [browser, times] of Object.entries(loads))
    for (const [what, key] of [['first falling cloth', 'falling'], ["the horse's first map", 'map']]) {
        const ms = times.map((time) => time[key]);
        console.log(`${what}, in a browser ${browser}: ${median(ms).toFixed(0)} ms (${all(ms)})`);
    }
const step = {};
for (const collision of ['surfaces=false', 'surfaces=true&self=false', 'surfaces=true']) {
    step[collision] = await stepInPage(collision);
    console.log(`a time step, ${collision}: ${step[collision].toFixed(1)} ms; of real time ${(1000 / 60).toFixed(1)} ms, ${(step[collision] / step['surfaces=false']).toFixed(2)} times as long as particles alone`);
}
for (const [name, native, collision] of [
    ['scalar, particles alone', stepOfNative('particles', { ECHINUS_INSTRUCTION_SET: 'scalar' }), 'surfaces=false'],
    ['particles alone', stepOfNative('particles'), 'surfaces=false'],
    ['surfaces', stepOfNative('surfaces'), 'surfaces=true'],
])
    console.log(`native, ${name}: ${native.toFixed(1)} ms on ${scene}; the page takes ${(step[collision] / native).toFixed(2)} times as long`);
