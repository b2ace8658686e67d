// A file server for the built page, and Debian's Chromium to view it.
import { createServer } from 'node:http';
import { existsSync, mkdirSync, readFileSync, readdirSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { extname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

export const inProject = (path) => fileURLToPath(new URL(`../../${path}`, import.meta.url));
/** Whether the tested page has the horse. */
export const hasHorse = existsSync(inProject('web/dist/models/horse.3ds'));
/** Rendering is by software; small pages leave time for the cloth. */
export const SMALL = { viewport: { width: 900, height: 480 } };

/** As on a desk. */
const LARGE = { width: 1280, height: 800 };

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };

/** web/dist/ in a subfolder, as on a static host. @param beforeLoad  runs in the page before its own code */
export async function serve(beforeLoad) {
    const server = createServer(async ({ url }, response) => {
        const path = new URL(url, 'http://host').pathname.replace(/^\/any\/folder\//, '/');
        const file = path === '/' ? '/index.html' : path;
        try {
            let bytes = await readFile(join(inProject('web/dist'), file));
            if (beforeLoad && file === '/index.html') bytes = bytes.toString().replace('<head>', `<head><script>(${beforeLoad})()</script>`);
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
        // A container offers neither a sandbox nor a graphics card.
        args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
    });
    const tab = async (options) => {
        const page = await (await browser.newContext({ viewport: LARGE, acceptDownloads: true, ...options })).newPage();
        page.setDefaultNavigationTimeout(180_000); // a machine that is busy with other work breaks no limit
        page.on('console', (message) => ['error', 'warning'].includes(message.type()) && !isOfTheDriver(message.text()) && page.complaints.push(message.text()));
        page.on('pageerror', (error) => page.complaints.push(String(error)));
        return page;
    };
    /** To load the page anew in a tab that has had it takes half the time of one in a new tab. */
    let spare;
    return {
        address,
        /**
         * The page, loaded anew, which keeps what its console complains of in `complaints`. Close it by close().
         * @param place       a link within the built page, or an address
         * @param beforeLoad  runs in it before its own code
         * @param folded      leaves the settings folded away, where tests could not reach them
         * @param fresh       in a tab that has not had it before; so is one with options of its own
         */
        async open(place = '', { beforeLoad, folded = false, fresh = false, viewport = LARGE, ...options } = {}) {
            const usual = !fresh && !beforeLoad && Object.keys(options).length === 0;
            const page = usual && spare ? spare : await tab({ viewport, ...options });
            page.isSpare = usual;
            if (page === spare) {
                spare = undefined;
                await page.setViewportSize(viewport);
            }
            if (beforeLoad) await page.addInitScript(beforeLoad);
            page.complaints = [];
            await page.goto(new URL(place, address).href);
            if (!folded) await page.evaluate(() => document.querySelectorAll('#panel details').forEach((part) => (part.open = true)));
            return page;
        },
        async close(page) {
            if (!page.isSpare || spare) return page.context().close();
            spare = page;
            page.removeAllListeners('request');
            page.setDefaultTimeout(30_000);
            await page.unrouteAll();
            await page.context().unrouteAll();
            await page.goto('about:blank');
        },
        async stop() {
            await browser.close();
            server.close();
        },
    };
}

/** Software rendering warns that reading back its picture is slow, which is no fault of the page. */
const isOfTheDriver = (text) => /GL Driver Message|GPU stall due to ReadPixels|swiftshader|SwiftShader/.test(text);

/** Saves a picture for inspection under out/web/. */
export async function picture(page, name) {
    mkdirSync(inProject('out/web'), { recursive: true });
    await page.screenshot({ path: inProject(`out/web/${name}.png`) });
}

/** What a figure says, once it says something. */
export async function figure(page, name) {
    const text = await page.waitForFunction((id) => {
        const says = document.getElementById(id).textContent;
        return says !== '\u2013' && says;
    }, `figure-${name}`);
    return text.jsonValue();
}

/** Waits until the cloth has made this many time steps. */
export const untilFrame = (page, frame) => page.waitForFunction((least) => Number(document.body.dataset.frame) >= least, frame, { timeout: 60_000 });

/** Waits until the view of the map shows its ray, which comes last. */
export const untilRay = (page) => page.waitForFunction(() => document.getElementById('ray').textContent.includes('side'), null, { timeout: 60_000 });

/** Runs in the page: keeps the longest time between two of its pictures. */
export function watchPauses() {
    let last = performance.now();
    globalThis.longestPause = 0;
    const look = () => {
        const now = performance.now();
        globalThis.longestPause = Math.max(globalThis.longestPause, now - last);
        last = now;
        requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
}

/** 31.5 ms, 84.2 kB and the like. */
export const numberOf = (text) => Number(text.replace(/[^0-9.].*$/, ''));

/** The share of its runnable time that the youngest thread of this name actually ran, from Linux's accounting. */
export function shareOfProcessor(name) {
    const threads = readdirSync('/proc').filter((process) => /^\d+$/.test(process)).flatMap((process) => threadsOf(process, name));
    const { ran, waited } = threads.reduce((a, b) => (a.begin > b.begin ? a : b));
    return ran / (ran + waited);
}

function threadsOf(process, name) {
    try {
        const folders = readdirSync(`/proc/${process}/task`).map((thread) => `/proc/${process}/task/${thread}`);
        return folders.filter((folder) => readFileSync(`${folder}/comm`, 'utf8').startsWith(name)).map((folder) => {
            const [ran, waited] = readFileSync(`${folder}/schedstat`, 'utf8').split(' ').map(Number);
            // The name may contain spaces, so fields are counted from its closing bracket. Field 22 is the thread's
            // start time.
            const begin = Number(readFileSync(`${folder}/stat`, 'utf8').split(') ')[1].split(' ')[19]);
            return { begin, ran, waited };
        });
    } catch {
        return []; // it has ended meanwhile
    }
}
