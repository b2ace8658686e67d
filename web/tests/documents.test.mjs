// The README and the pages of docs/, as scripts/web puts them beside the page.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { inProject, picture, startBrowser } from './support.mjs';

let browser;
before(async () => (browser = await startBrowser()));
after(() => browser?.stop());

const folder = pathToFileURL(inProject('web/dist/documents/'));
const isOf = (type) => (file) => file.endsWith(type);
const documents = readdirSync(folder).filter(isOf('.html')).map((file) => new URL(file, folder));
const valuesOf = (attribute, html) => [...html.matchAll(new RegExp(` ${attribute}="([^"]*)"`, 'g'))].map(([, value]) => value);
const isRelative = (link) => !/^[a-z]+:/.test(link);

/** A folder's index is what hosts show of it. */
const fileOf = (target) => fileURLToPath(target.pathname.endsWith('/') ? new URL('index.html', target) : target);

test('every page of docs/ and the README are there', () => {
    assert.equal(documents.length, readdirSync(inProject('docs')).filter(isOf('.md')).length + 1);
});

test('each link of a document leads to a file, and to a heading in it, and each picture is there', () => {
    for (const document of documents) {
        const html = readFileSync(document, 'utf8');
        for (const link of [...valuesOf('href', html), ...valuesOf('src', html)].filter(isRelative)) {
            const target = new URL(link, document);
            const file = fileOf(target);
            assert.ok(existsSync(file) && !file.endsWith('.md'), `${document.pathname}: ${link}`);
            if (target.hash) assert.ok(valuesOf('id', readFileSync(file, 'utf8')).includes(decodeURIComponent(target.hash.slice(1))), `${document.pathname}: ${link}`);
        }
    }
});

test('a document shows its pictures, and is no wider than a small screen', async () => {
    const page = await browser.open('documents/index.html', { viewport: { width: 390, height: 800 } });
    assert.equal(await page.title(), 'Echinus');
    assert.ok(await page.locator('main img').first().evaluate((image) => image.decode().then(() => image.naturalWidth)));
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
    await picture(page, 'document');
    assert.deepEqual(page.complaints, []);
    await browser.close(page);
});
