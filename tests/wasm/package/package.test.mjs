// The package as npm packs it, in an empty folder: its files, and answers in Node.
// scripts/wasm --pack-test installs the compiler of TypeScript beside this file.
import { before, describe, test } from 'node:test';
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { here, inProject, installPacked } from './packed.mjs';

const MOST_BYTES = 612_000; // a hundredth above what it has been

let user, packed, inUser;
before(() => ({ user, packed, run: inUser } = installPacked('user')));

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
