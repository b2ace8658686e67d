// Every option of scenes and maps, spoilt in each way that its type allows: refused by its key. bindings/options.toml has them.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { join } from 'node:path';
import { before, describe, test } from 'node:test';
import { errorOf, sourceFolder, start } from './support.mjs';

const { words, ...structs } = JSON.parse(execFileSync('python3', [join(sourceFolder, 'bindings/generate_options'), '--json']));
const kinds = ['structural', 'shear', 'bending'];

let echinus;
before(async () => { echinus = await start(); });

/** A scene in which an option has a meaning. */
const sheet = { size: [1, 1], particles: [4, 4], position: [0, 0, 9] };
const scenes = {
    exact_map: { map: {} }, distance_map: { map: { kind: 'distance' } }, mesh_cloth: { cloth: { mesh: { sphere: {} } } },
    body: { cloth: undefined, bodies: [{ mesh: { box: {} }, element: 1 }] }, jakobsen: { solver: 'jakobsen' },
};
function sceneFor(section, only, path, value) {
    const scene = structuredClone({ model: { torus: {} }, cloth: sheet, ...scenes[section] });
    const [choice, word] = only?.split(' ') ?? [];
    if (choice === 'solver') scene.solver = word;
    if (choice === 'grid') scene.map.grid = word;
    const keys = path.replace('[]', '.0').split('.');
    const last = keys.pop();
    keys.reduce((object, key) => (object[key] ??= {}), scene)[last] = value;
    return scene;
}

/** Values of another type, and out of range. */
function wrongValues({ type, range }) {
    const [kind] = type.split(':');
    if (kind === 'flag') return [1, 'true', null];
    if (kind === 'word') return ['none such', 1, null];
    const count = { real2: 2, whole2: 2, real3: 3 }[kind] ?? 1;
    const numbers = ['1', null, {}, NaN, Infinity, ...(/whole|size|threads/.test(kind) ? [0.5, -1] : [])];
    if (Array.isArray(range)) numbers.push(range[0] - 2, ...(range[1] === 'inf' ? [] : [2 * range[1]]));
    return count === 1 ? numbers : [1, [], [1], ...numbers.map((number) => [number, ...Array(count - 1).fill(5)])];
}

/** [section, choice that it needs, path of the key, row] */
const options = Object.values(structs).flatMap(({ rows }) => Object.values(rows)).filter(({ scene }) => scene).flatMap((row) => {
    const [section, path] = row.scene.split(' ');
    return path.endsWith('.') ? kinds.map((kind) => [section, row.only, path + kind, row]) : [[section, row.only, path, row]];
});

describe('An option', () => {
    test('is known', () => assert.ok(options.length > 35 && Object.keys(words).length > 5));
    for (const [section, only, path, row] of options)
        test(`${path} is refused by its key where its value is wrong, and taken with its default`, () => {
            const name = path.replace('[]', '[0]');
            for (const value of wrongValues(row)) {
                const error = errorOf(() => echinus.parseScene(sceneFor(section, only, path, value), 's.json'));
                assert.equal(error.code, 'InvalidScene', error.message);
                assert.ok(error.message.startsWith(`s.json: ${name} is `), `${JSON.stringify(value)}: ${error.message}`);
            }
            const usual = { '1/60': 1 / 60, required: [1, 1] }[row.default] ?? row.default ?? 1;
            echinus.parseScene(sceneFor(section, only, path, row.type === 'kinds' ? usual[0] : usual)).delete();
        });
});

describe('A scene', () => {
    test('with an unknown key, text that is no JSON, or nothing is refused', () => {
        const cases = [
            [{ model: { torus: {} }, cloth: sheet, clothh: 1 }, 'InvalidScene', /no key "clothh"; the nearest is "cloth"/],
            ['{"model": ', 'InvalidScene', /parse|unexpected/],
            ['['.repeat(100_000), 'InvalidScene', /./],
            [undefined, 'InvalidArgument', /./],
        ];
        for (const [description, code, sentence] of cases) {
            const error = errorOf(() => echinus.parseScene(description, 's.json'));
            assert.equal(error.code, code, error.message);
            assert.match(error.message, sentence);
        }
    });
});
