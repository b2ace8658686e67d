// Takes the pictures of the page's gallery, and the card that others show of a link to it, from the built page: web/pictures/. Then that of the
// page itself, docs/images/web.png, with that gallery: the page has to be built again in between where its pictures have changed.
// Software draws them here, which takes a while. Run by scripts/web --pictures.
import { mkdirSync } from 'node:fs';
import { hasHorse, inProject, startBrowser, untilFrame } from './support.mjs';

const folder = inProject('web/pictures/');
mkdirSync(`${folder}gallery`, { recursive: true });

/** Each moment in time steps. */
const MOMENTS = { horse: 83, torus: 83, figure: 230, organ: 75, ring: 190, flag: 80, layers: 75, beside: 83 };

const browser = await startBrowser();

/** Quickly to the moment in the light look; the picture is taken in the fine one. @param style  for the picture */
async function stopAt(link, moment, viewport, style) {
    const page = await browser.open(`#${link}`, { viewport, folded: true });
    page.setDefaultTimeout(600_000);
    await page.waitForFunction((least) => Number(document.body.dataset.frame) >= least, moment, { timeout: 600_000 });
    await page.keyboard.press('Space');
    await page.waitForFunction(() => document.body.dataset.paused === 'true');
    await page.locator('select[name=look]').evaluate((list) => {
        list.value = 'fine';
        list.dispatchEvent(new Event('input'));
    });
    await page.addStyleTag({ content: style });
    for (let picture = 0; picture < 4; ++picture) await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(drawn)));
    return page;
}

async function take(link, moment, { width, height }, path, quality) {
    const style = `body { display: block } #stage { width: ${width}px; height: ${height}px } #bar, #figures, #panel, header, #halves { display: none !important }`;
    const page = await stopAt(link, moment, { width: width + 360, height: height + 200 }, style);
    await page.locator('#stage').screenshot({ path, type: 'jpeg', quality });
    console.log(path);
    await browser.close(page);
}

/** Without the times that the page took: software draws it, perhaps beside other work. */
async function takePage(path) {
    const page = await stopAt('', MOMENTS.horse, { width: 1200, height: 760 }, '#figures .detail, #figures > :has(#figure-fps, #figure-build), #headline > span:nth-last-child(-n + 2) { display: none }');
    await page.screenshot({ path });
    console.log(path);
    await browser.close(page);
}

const wanted = process.argv.slice(2);
const page = await browser.open('#particles=100&model=torus');
await untilFrame(page, 1);
const links = await page.evaluate(() => [...document.querySelectorAll('#gallery a')].map((tile) => [tile.querySelector('img').src.match(/(\w+)\.jpg$/)[1], tile.hash.slice(1)]));
await browser.close(page);
for (const [name, link] of links) if (wanted.length === 0 || wanted.includes(name)) await take(link, MOMENTS[name], { width: 240, height: 180 }, `${folder}gallery/${name}.jpg`, 80);
if (wanted.length === 0 || wanted.includes('card')) await take('model=torus', MOMENTS.torus, { width: 1200, height: 630 }, `${folder}card.jpg`, 72);
if (hasHorse && (wanted.length === 0 || wanted.includes('page'))) await takePage(inProject('docs/images/web.png'));
await browser.stop();
