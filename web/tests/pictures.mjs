// Takes the pictures of the page's gallery, and the card that others show of a link to it, from the built page: web/pictures/.
// Software draws them here, which takes a while. Run by scripts/web --pictures.
import { mkdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { startBrowser, untilFrame } from './support.mjs';

const folder = fileURLToPath(new URL('../pictures/', import.meta.url));
mkdirSync(`${folder}gallery`, { recursive: true });

/** Each moment in time steps. */
const MOMENTS = { horse: 330, torus: 330, figure: 460, organ: 300, ring: 760, flag: 420, layers: 300, beside: 330 };

const browser = await startBrowser();

/** Quickly to the moment in the light look; the picture is taken in the fine one. */
async function take(link, moment, size, path, quality) {
    const page = await browser.open(`#${link}`, { viewport: { width: size.width + 360, height: size.height + 200 } });
    page.setDefaultTimeout(600_000);
    await page.waitForFunction((least) => Number(document.body.dataset.frame) >= least, moment, { timeout: 600_000 });
    await page.keyboard.press('Space');
    await page.waitForFunction(() => document.body.dataset.paused === 'true');
    await page.locator('select[name=look]').selectOption('fine');
    await page.addStyleTag({ content: `body { display: block } #stage { width: ${size.width}px; height: ${size.height}px } #bar, #figures, #panel, header, #halves { display: none !important }` });
    for (let picture = 0; picture < 4; ++picture) await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(drawn)));
    await page.locator('#stage').screenshot({ path, type: 'jpeg', quality });
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
await browser.stop();
