// The package as npm packs it, in an empty folder: answers in Node, and in Chromium when three bundlers have been at it.
// scripts/wasm --pack-test installs the bundlers beside this file.
import { after, before, describe, test } from 'node:test';
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createServer } from 'node:http';
import { cpSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { extname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const inProject = (path) => fileURLToPath(new URL(`../../../${path}`, import.meta.url));
const here = fileURLToPath(new URL('.', import.meta.url));
const user = inProject('build/wasm/user');
const MOST_BYTES = 538_000;
const ANSWER = 'inside, 0.08 deep';

const inUser = (program, ...args) => execFileSync(program, args, { cwd: user, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
const npm = (...args) => inUser('npm', '--no-audit', '--no-fund', '--loglevel=error', ...args);

let packed;
before(() => {
    rmSync(user, { recursive: true, force: true });
    mkdirSync(user, { recursive: true });
    [packed] = JSON.parse(npm('pack', '--json', inProject('build/wasm/echinus')));
    writeFileSync(join(user, 'package.json'), '{ "private": true, "type": "module" }\n');
    npm('install', `./${packed.filename}`);
});

describe('The package', () => {
    test('has what it needs, nothing else, and is small', () => {
        const names = packed.files.map(({ path }) => path);
        for (const name of ['LICENSE', 'README.md', 'echinus.d.ts', 'echinus.mjs', 'echinus.wasm', 'node.mjs', 'package.json', 'three.mjs'])
            assert.ok(names.includes(name), `${name} of ${names}`);
        assert.deepEqual(names.filter((name) => !/^(LICENSE|README\.md|package\.json|[a-z_]+\.(mjs|d\.ts)|echinus\.wasm)$/.test(name)), []);
        assert.ok(packed.size < MOST_BYTES, `${packed.size} bytes`);
        const { version } = JSON.parse(readFileSync(join(user, 'node_modules/echinus/package.json')));
        assert.ok(readFileSync(inProject('include/echinus/version.h'), 'utf8').includes(`"${version}"`));
        assert.deepEqual(readdirSync(join(user, 'node_modules')).filter((name) => !name.startsWith('.')), ['echinus']);
    });
    test('would be published without a complaint', () => {
        // Of the machine, not of the package: that nobody is logged in, and what its configuration has.
        const stderr = execFileSync('sh', ['-c', 'npm publish --dry-run --loglevel=warn 2>&1 >/dev/null'], { cwd: inProject('build/wasm/echinus'), encoding: 'utf8' });
        assert.deepEqual(stderr.split('\n').filter((line) => /warn|error/i.test(line) && !/requires you to be logged in|user config/.test(line)), []);
    });
    test('answers in Node, by the example of its README', () => {
        const [, program] = readFileSync(join(user, 'node_modules/echinus/README.md'), 'utf8').match(/```js\n([^]*?)```/);
        writeFileSync(join(user, 'five_lines.mjs'), program);
        assert.match(inUser(process.execPath, 'five_lines.mjs'), /inside: true/);
    });
    test('has types that fit the engines', () => {
        cpSync(join(here, 'user/typed.ts'), join(user, 'typed.ts'));
        // Types of Jolt are in an old syntax, which TypeScript 7 refuses: hence --skipLibCheck.
        const compile = (resolution, module) => inUser(join(here, 'node_modules/.bin/tsc'), '--ignoreConfig', '--noEmit', '--strict', '--skipLibCheck', '--target', 'es2022', '--module', module,
            '--moduleResolution', resolution, '--typeRoots', join(here, 'node_modules/@types'), 'typed.ts');
        for (const name of ['three', 'jolt-physics', '@dimforge'])
            cpSync(inProject(`examples/js/node_modules/${name}`), join(user, 'node_modules', name), { recursive: true });
        cpSync(join(here, 'node_modules/@types'), join(user, 'node_modules/@types'), { recursive: true });
        compile('bundler', 'esnext');
        compile('nodenext', 'nodenext');
    });
});

describe('In Chromium the package answers', async () => {
    let browser;
    before(async () => {
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
