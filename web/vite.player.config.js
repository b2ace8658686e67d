/**
 * The player of recorded simulations: one HTML file, with script and style inside, since a page from the disk may load
 * nothing else. `echinus simulate --html` inserts a recording at the mark in player.html.
 */
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

const inProject = (path) => fileURLToPath(new URL(`../${path}`, import.meta.url));

export default defineConfig({
    publicDir: false,
    plugins: [inOneFile()],
    build: {
        target: 'es2022',
        outDir: inProject('build/web'),
        emptyOutDir: false,
        modulePreload: false,
        chunkSizeWarningLimit: 1000,
        rollupOptions: { input: inProject('web/player.html') },
    },
});

/** Puts the script, the style and the licences that scripts/web has gathered into the page. */
function inOneFile() {
    return {
        name: 'in-one-file',
        enforce: 'post',
        generateBundle(_, bundle) {
            const page = bundle['player.html'];
            for (const [name, { type, code, source }] of Object.entries(bundle)) {
                if (name === 'player.html') continue;
                const tag = type === 'chunk' ? /<script type="module"[^>]*src="[^"]*"[^>]*><\/script>/ : /<link rel="stylesheet"[^>]*>/;
                const element = type === 'chunk' ? `<script type="module">${inScript(code)}</script>` : `<style>${source}</style>`;
                if (!tag.test(page.source)) throw new Error(`player.html: there is no place for ${name}`);
                page.source = page.source.replace(tag, () => element); // a function: no dollar sign in it means anything
                delete bundle[name];
            }
            page.source = page.source.replace('<!-- licences -->', () => inMarkup(readFileSync(inProject('build/web/public/LICENSES.txt'), 'utf8')));
        },
    };
}

/** Escapes everything that would end the script or begin a comment in it. */
const inScript = (code) => code.replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');
const inMarkup = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;');
