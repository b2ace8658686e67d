// Writes the README and the pages of docs/ as HTML, with the pictures that they show: node web/documents.mjs FOLDER
import { copyFileSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { join as joinLinks } from 'node:path/posix';
import { fileURLToPath } from 'node:url';
import { Marked, TextRenderer } from 'marked';

const inProject = (path) => fileURLToPath(new URL(`../${path}`, import.meta.url));
const read = (path) => readFileSync(inProject(path), 'utf8');
const inMarkup = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('"', '&quot;');

const HEADER = { '../': 'The page', 'index.html': 'README', 'docs.html': 'Documents' };
const [icon] = read('web/index.html').match(/<link rel="icon".*>/);
/** Which page each document becomes. All lie in one folder, so that their addresses are short. */
const pages = new Map([['README.md', 'index.html']]);
for (const file of readdirSync(inProject('docs'))) if (file.endsWith('.md')) pages.set(`docs/${file}`, pageOf(file));

const folder = process.argv[2];
mkdirSync(join(folder, 'images'), { recursive: true });
writeFileSync(join(folder, 'documents.css'), ['web/src/palette.css', 'web/documents.css'].map(read).join('\n'));
for (const [document, page] of pages) writeFileSync(join(folder, page), inPage(page, convert(document)));

function pageOf(file) {
    return file === 'README.md' ? 'docs.html' : file.replace(/md$/, 'html');
}

/** The document's title and its HTML. Copies its pictures. */
function convert(document) {
    const names = new Set();
    let title;
    const marked = new Marked({
        walkTokens(token) {
            if (token.type === 'image') token.href = copyPicture(fileOf(token.href, document));
        },
        renderer: {
            heading({ tokens, depth }) {
                const text = this.parser.parseInline(tokens, new TextRenderer());
                title ??= text;
                return `<h${depth} id="${nameOf(text, names)}">${this.parser.parseInline(tokens)}</h${depth}>\n`;
            },
            link(token) {
                if (/^([a-z]+:|#)/.test(token.href)) return false; // as it is
                const [path, anchor] = token.href.split('#');
                const file = fileOf(path, document);
                if (!pages.has(file)) return asFile(file, this.parser.parseInline(token.tokens));
                token.href = pages.get(file) + (anchor ? `#${anchor}` : '');
                return false;
            },
        },
    });
    // Wide tables and code scroll, by the keyboard too.
    const html = marked.parse(read(document)).replaceAll(/<(pre|table)>/g, '<$1 tabindex="0">');
    return { title, html };
}

/** The file of the repository to which a document's relative link leads. */
function fileOf(link, document) {
    return joinLinks(dirname(document), link);
}

function copyPicture(file) {
    const copy = `images/${basename(file)}`;
    copyFileSync(inProject(file), join(folder, copy));
    return copy;
}

/** A file that only the repository has is named where the document links to it. */
function asFile(file, html) {
    const tag = /^[\w./]+$/.test(html) ? 'code' : 'span';
    return `<${tag} title="${inMarkup(file)}">${html}</${tag}>`;
}

/** The anchor of a heading, as on GitHub: without punctuation, and numbered if another heading has the same name. */
function nameOf(text, names) {
    const plain = text.toLowerCase().replace(/[^\p{L}\p{M}\p{N}\p{Pc} -]/gu, '').replaceAll(' ', '-');
    let name = plain;
    for (let i = 1; names.has(name); ++i) name = `${plain}-${i}`;
    names.add(name);
    return name;
}

function inPage(page, { title, html }) {
    const links = Object.entries(HEADER).map(([address, text]) => `<a href="${address}"${address === page ? ' aria-current="page"' : ''}>${text}</a>`);
    return `<!doctype html>
<html lang="en">
    <head>
        <meta charset="utf-8" />
        <meta name="viewport" content="width=device-width, initial-scale=1" />
        <meta name="color-scheme" content="light dark" />
        <title>${inMarkup(title.includes('Echinus') ? title : `${title} · Echinus`)}</title>
        ${icon}
        <link rel="stylesheet" href="documents.css" />
    </head>
    <body>
        <header><nav aria-label="Echinus"><b>Echinus</b> ${links.join(' ')}</nav></header>
        <main>
${html}        </main>
    </body>
</html>
`;
}
