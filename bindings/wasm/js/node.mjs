/** Echinus in Node, whose fetch() reads no files. Bundlers and pages take echinus.mjs. */
import { readFile } from 'node:fs/promises';
import { EchinusError, load as loadFrom } from './echinus.mjs';

export * from './echinus.mjs';

export async function load(source = new URL('./echinus.wasm', import.meta.url)) {
    const given = await source;
    const path = pathOf(given);
    return loadFrom(path === undefined ? given : read(path));
}

/** The argument for readFile(), where the source is a file. */
function pathOf(source) {
    if (typeof source === 'string') return /^(https?|data|blob):/i.test(source) ? undefined : /^file:/i.test(source) ? new URL(source) : source;
    return source instanceof URL && source.protocol === 'file:' ? source : undefined;
}

async function read(path) {
    try {
        return await readFile(path);
    } catch (error) {
        throw new EchinusError('Unreadable', error.message, { cause: error });
    }
}
