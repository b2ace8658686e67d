// Shared by the tests. scripts/wasm passes the paths of the module and the reference.
import { readFileSync } from 'node:fs';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { join } from 'node:path';

export const sourceFolder = fileURLToPath(new URL('../../', import.meta.url));
const buildFolder = process.env.ECHINUS_WASM_BUILD ?? join(sourceFolder, 'build/wasm');
export const moduleFolder = join(buildFolder, 'echinus');
export const referenceFolder = join(buildFolder, 'reference');

export const module = await import(pathToFileURL(join(moduleFolder, 'node.mjs')));
export const compiled = await WebAssembly.compile(readFileSync(join(moduleFolder, 'echinus.wasm')));

/** A fresh instance. */
export const start = () => module.load(compiled);

export const readScene = (name) => readFileSync(join(sourceFolder, 'scenes', name), 'utf8');

/** The error that a call throws; fails the test when it throws nothing, or anything but an EchinusError. */
export function errorOf(call) {
    try {
        call();
    } catch (error) {
        if (error instanceof module.EchinusError) return error;
        throw error;
    }
    throw new Error('nothing was thrown');
}

/** The same random numbers in every run. */
export function pseudoRandom(seed = 1) {
    let state = seed >>> 0;
    return () => {
        state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
        return state / 2 ** 32;
    };
}
