// The package as npm packs it, in Chromium, when three bundlers have been at it and without one.
// scripts/wasm --bundlers installs the bundlers beside this file.
import { after, before, describe, test } from 'node:test';
import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import { cpSync, mkdirSync, readdirSync, writeFileSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { extname, join } from 'node:path';
import { chromium } from 'playwright-core';
import { here, inProject, installPacked } from './packed.mjs';

const ANSWER = 'inside, 0.08 deep';

describe('In Chromium the package answers', async () => {
    let browser, user;
    before(async () => {
        ({ user } = installPacked('user_of_bundlers'));
        browser = await chromium.launch({
            executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
            args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
        });
        cpSync(join(here, 'user'), user, { recursive: true });
    });
    after(() => browser.close());

    const BUNDLERS = {
        async Vite() {
            const { build } = await import('vite');
            await build({ root: user, base: './', logLevel: 'error', worker: { format: 'es' }, build: { outDir: 'dist_Vite' } });
        },
        async esbuild() {
            const { build } = await import('esbuild');
            const load = join(user, 'load_for_esbuild.js');
            await build({
                absWorkingDir: user, entryPoints: ['main.js', 'worker.js'], bundle: true, minify: true, format: 'esm', outdir: 'dist_esbuild',
                loader: { '.wasm': 'file' }, logLevel: 'error',
                plugins: [{ name: 'load', setup: ({ onResolve }) => onResolve({ filter: /^\.\/load\.js$/ }, () => ({ path: load })) }],
            });
        },
        async webpack() {
            const { default: webpack } = await import('webpack');
            const stats = await new Promise((resolve, reject) =>
                webpack({ context: user, mode: 'production', entry: './main.js', output: { path: join(user, 'dist_webpack') }, performance: { hints: false } },
                    (error, result) => (error ? reject(error) : resolve(result))));
            assert.equal(stats.toString({ all: false, errors: true, warnings: true }), '');
        },
    };
    for (const [name, bundle] of Object.entries(BUNDLERS))
        test(`bundled by ${name}, in the page and in a worker`, async () => {
            await bundle();
            const folder = join(user, `dist_${name}`);
            if (name !== 'Vite') cpSync(join(user, 'index.html'), join(folder, 'index.html'));
            assert.ok(readdirSync(folder, { recursive: true }).some((file) => file.endsWith('.wasm')), 'the .wasm is a file of its own');
            assert.equal(await textOf(browser, folder, 'index.html'), `page: ${ANSWER}; worker: ${ANSWER}`);
        });
    test('from the development server of Vite', async () => {
        const { createServer: createViteServer } = await import('vite');
        const server = await createViteServer({ root: user, logLevel: 'error', server: { host: '127.0.0.1' }, optimizeDeps: { exclude: ['echinus'] } });
        await server.listen();
        try {
            assert.equal(await textAt(browser, server.resolvedUrls.local[0]), `page: ${ANSWER}; worker: ${ANSWER}`);
        } finally {
            await server.close();
        }
    });
    test('without a bundler, from its folder', async () => {
        writeFileSync(join(user, 'load.js'), `export { load } from './node_modules/echinus/echinus.mjs';\n`);
        assert.equal(await textOf(browser, user, 'index.html'), `page: ${ANSWER}; worker: ${ANSWER}`);
    });
    test('with three.js, in the page of examples/js', async () => {
        const { server, address } = await serve(inProject('examples/js'));
        const page = await browser.newPage({ viewport: { width: 720, height: 480 } });
        try {
            const complaints = listenTo(page);
            await page.goto(`${address}three.html`);
            await page.waitForFunction(() => Number(document.body.dataset.frame) >= 45, null, { timeout: 60_000 });
            assert.deepEqual(complaints, []);
            mkdirSync(inProject('out/web'), { recursive: true });
            await page.screenshot({ path: inProject('out/web/three.png') });
        } finally {
            await page.close();
            server.close();
        }
    });
});

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm' };

async function serve(folder) {
    const server = createServer(async ({ url }, response) => {
        try {
            const { pathname } = new URL(url, 'http://host');
            const bytes = await readFile(join(folder, decodeURIComponent(pathname)));
            response.writeHead(200, { 'content-type': TYPES[extname(pathname)] ?? 'application/octet-stream' }).end(bytes);
        } catch {
            response.writeHead(404).end();
        }
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    return { server, address: `http://127.0.0.1:${server.address().port}/` };
}

async function textOf(browser, folder, name) {
    const { server, address } = await serve(folder);
    try {
        return await textAt(browser, address + name);
    } finally {
        server.close();
    }
}

async function textAt(browser, address) {
    const page = await browser.newPage();
    const complaints = listenTo(page);
    await page.goto(address);
    await page.waitForFunction(() => document.body.textContent.includes('worker'), null, { timeout: 20_000 }).catch(() => {});
    const text = (await page.textContent('body')).trim();
    await page.close();
    assert.deepEqual(complaints, []);
    return text;
}

function listenTo(page) {
    const complaints = [];
    page.on('console', (message) => ['error', 'warning'].includes(message.type()) && !/GL Driver Message|GPU stall/.test(message.text()) && complaints.push(message.text()));
    page.on('pageerror', (error) => complaints.push(String(error)));
    return complaints;
}
