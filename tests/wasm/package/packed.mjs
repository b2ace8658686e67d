// The package as npm packs it, installed into an empty folder.
import { execFileSync } from 'node:child_process';
import { mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

export const inProject = (path) => fileURLToPath(new URL(`../../../${path}`, import.meta.url));
export const here = fileURLToPath(new URL('.', import.meta.url));

/**
 * @param name  of the folder in build/wasm/, which is emptied; test files run side by side, so each takes its own
 * @returns the folder, what `npm pack` lists, and `run(program, ...args)`, which gives what the program prints there
 */
export function installPacked(name) {
    const user = inProject(`build/wasm/${name}`);
    const run = (program, ...args) => execFileSync(program, args, { cwd: user, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
    const npm = (...args) => run('npm', '--no-audit', '--no-fund', '--loglevel=error', ...args);
    rmSync(user, { recursive: true, force: true });
    mkdirSync(user, { recursive: true });
    const [packed] = JSON.parse(npm('pack', '--json', inProject('build/wasm/echinus')));
    writeFileSync(join(user, 'package.json'), '{ "private": true, "type": "module" }\n');
    npm('install', `./${packed.filename}`);
    return { user, packed, run };
}
