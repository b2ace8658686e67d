// The built page behind a server of files, and Debian's Chromium looking at it.
import { createServer } from 'node:http';
import { mkdirSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { extname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const inProject = (path) => fileURLToPath(new URL(`../../${path}`, import.meta.url));
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };

/** web/dist/ under a folder of its own, as a static host would have it. */
async function serve() {
    const server = createServer(async ({ url }, response) => {
        const path = new URL(url, 'http://host').pathname.replace(/^\/any\/folder\//, '/');
        const file = path === '/' ? '/index.html' : path;
        try {
            const bytes = await readFile(join(inProject('web/dist'), file));
            response.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'application/octet-stream' }).end(bytes);
        } catch {
            response.writeHead(404).end();
        }
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    return { server, address: `http://127.0.0.1:${server.address().port}/any/folder/` };
}

export async function startBrowser() {
    const { server, address } = await serve();
    const browser = await chromium.launch({
        executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
        // A container has no sandbox of its own to give and no graphics card.
        args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
    });
    return {
        /** A page that keeps what its console complains of in `complaints`. @param beforeLoad  runs in it before its own code */
        async open(hash = '', { beforeLoad, ...options } = {}) {
            const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, acceptDownloads: true, ...options });
            const page = await context.newPage();
            if (beforeLoad) await page.addInitScript(beforeLoad);
            page.complaints = [];
            page.on('console', (message) => ['error', 'warning'].includes(message.type()) && !isOfTheDriver(message.text()) && page.complaints.push(message.text()));
            page.on('pageerror', (error) => page.complaints.push(String(error)));
            await page.goto(`${address}${hash}`);
            return page;
        },
        async stop() {
            await browser.close();
            server.close();
        },
    };
}

/** Software drawing warns that reading its picture is slow, which is no fault of the page. */
const isOfTheDriver = (text) => /GL Driver Message|GPU stall due to ReadPixels|swiftshader|SwiftShader/.test(text);

/** A picture for a person to look at, under out/web/. */
export async function picture(page, name) {
    mkdirSync(inProject('out/web'), { recursive: true });
    await page.screenshot({ path: inProject(`out/web/${name}.png`) });
}

export const figure = (page, name) => page.locator(`#figure-${name}`).textContent();

/** Waits until the cloth has made so many time steps. */
export const untilFrame = (page, frame) => page.waitForFunction((least) => Number(document.body.dataset.frame) >= least, frame, { timeout: 60_000 });

/** 31.5 ms, 84.2 kB and the like. */
export const numberOf = (text) => Number(text.replace(/[^0-9.].*$/, ''));
