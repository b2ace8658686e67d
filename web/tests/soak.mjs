// Leaves each example of the gallery running for a while, and says what it did to the memory: that of the page, and that of the whole browser.
// Fails where anything is counted that should not be, or the console complains, or the memory grows. Run by scripts/web --soak [SECONDS [NAME...]]
import { readFileSync, readdirSync } from 'node:fs';
import { startBrowser, untilFrame } from './support.mjs';

const [seconds = 60, ...wanted] = process.argv.slice(2);
/** Each is looked at so often. */
const LOOKS = 12;
/** Between the middle of the first half of the looks and that of the second; less may be what a collector has left. */
const MOST_MB = 30;

/** Resident megabytes of this process's children and theirs. */
function residentMb() {
    const parents = new Map(), pages = new Map();
    for (const process of readdirSync('/proc').filter((name) => /^\d+$/.test(name)))
        try {
            const stat = readFileSync(`/proc/${process}/stat`, 'utf8');
            parents.set(Number(process), Number(stat.slice(stat.lastIndexOf(')') + 2).split(' ')[1]));
            // Without what is shared: a Chromium of many processes shares its code.
            const [, resident, shared] = readFileSync(`/proc/${process}/statm`, 'utf8').split(' ').map(Number);
            pages.set(Number(process), resident - shared);
        } catch {
            // it has ended meanwhile
        }
    let sum = 0;
    for (const [number, count] of pages) {
        let parent = parents.get(number);
        while (parent && parent !== process.pid) parent = parents.get(parent);
        if (parent) sum += count;
    }
    return (sum * 4096) / 1e6;
}

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

/** Runs in the page: keeps all that the counts have been. */
function keepCounts() {
    globalThis.counts = { inside: new Set(), pairs: new Set(), 'own-pairs': new Set() };
    for (const [name, seen] of Object.entries(globalThis.counts)) {
        const cell = document.getElementById(`figure-${name}`);
        const note = () => seen.add(cell.textContent);
        note();
        new MutationObserver(note).observe(cell, { childList: true, characterData: true, subtree: true });
    }
}

async function soak(browser, name, link) {
    const page = await browser.open(`#${link}`, { viewport: { width: 600, height: 400 }, fresh: true });
    page.setDefaultTimeout(300_000);
    await page.waitForFunction(() => document.body.dataset.frame >= 30);
    await page.evaluate(keepCounts);
    const session = await page.context().newCDPSession(page);
    const heaps = [], residents = [];
    for (let look = 0; look < LOOKS; ++look) {
        await page.waitForTimeout((1000 * seconds) / LOOKS);
        // A cloth that rests is not stepped: it falls again.
        if (look % 3 === 2) await page.evaluate(() => document.body.dataset.rest === 'true' && document.getElementById('restart').click());
        await session.send('HeapProfiler.collectGarbage');
        heaps.push((await session.send('Runtime.getHeapUsage')).usedSize / 1e6);
        residents.push(residentMb());
    }
    const counts = await page.evaluate(() => Object.fromEntries(Object.entries(globalThis.counts).map(([name, seen]) => [name, [...seen].filter((text) => text !== '–')])));
    const self = !link.includes('self=false') && !link.includes('surfaces=false'), halves = link.includes('beside');
    const half = LOOKS / 2, growth = (values) => median(values.slice(half)) - median(values.slice(0, half));
    const faults = [
        ...(counts.inside.some((text) => text !== '0') ? [`inside: ${counts.inside}`] : []),
        ...(counts.pairs.some((text) => text !== '0') ? [`cuts through the model: ${counts.pairs}`] : []),
        ...(self && counts['own-pairs'].some((text) => text !== '0') ? [`cuts through itself: ${counts['own-pairs']}`] : []),
        ...page.complaints,
        ...(growth(residents) > MOST_MB ? [`the memory grows: ${residents.map(Math.round)}`] : []),
    ];
    const frame = await page.evaluate(() => document.body.dataset.frame);
    console.log(`${name}: ${seconds} s, frame ${frame}${halves ? ' of the left half' : ''}; heap ${median(heaps.slice(0, half)).toFixed(1)} then ${median(heaps.slice(half)).toFixed(1)} MB, ` +
        `browser ${median(residents.slice(0, half)).toFixed(0)} then ${median(residents.slice(half)).toFixed(0)} MB; ${faults.length === 0 ? 'nothing wrong' : faults.join('; ')}`);
    await browser.close(page);
    return faults.length === 0;
}

const browser = await startBrowser();
const page = await browser.open('#model=torus&particles=100', { fresh: true });
await untilFrame(page, 1);
const links = await page.evaluate(() => [...document.querySelectorAll('#gallery a')].map((tile) => [tile.querySelector('img').src.match(/(\w+)\.jpg$/)[1], tile.hash.slice(1)]));
await page.context().close();
let well = true;
for (const [name, link] of links) if (wanted.length === 0 || wanted.includes(name)) well = (await soak(browser, name, link)) && well;
await browser.stop();
process.exitCode = well ? 0 : 1;
