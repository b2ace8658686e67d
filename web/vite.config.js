import { existsSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

const inProject = (path) => fileURLToPath(new URL(`../${path}`, import.meta.url));
// scripts/web puts files there that are copied into the page unchanged: the horse, where it is installed, and licences.
const publicDir = inProject('build/web/public');

/** Where the page will be, for the picture that others show of a link to it; they take absolute addresses only. */
const address = process.env.ECHINUS_PAGE ?? './';
/** Where Echinus can be had, if whoever builds the page says so. */
const source = process.env.ECHINUS_SOURCE ? `<a href="${process.env.ECHINUS_SOURCE}">Get Echinus</a>` : '';

export default defineConfig({
    plugins: [{ name: 'address', transformIndexHtml: (page) => page.replaceAll('%ADDRESS%', address).replaceAll('%SOURCE%', source) }],
    base: './', // dist works in any folder of any host
    publicDir,
    define: { HAS_HORSE: existsSync(`${publicDir}/models/horse.3ds`) },
    worker: { format: 'es' },
    // Every browser with WebAssembly SIMD runs this.
    build: { target: 'es2022', chunkSizeWarningLimit: 1000 },
});
