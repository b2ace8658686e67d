// Times the module beside native C++: the same work in turns, medians of processor time. Run by scripts/wasm
// --speed:  speed.mjs PROGRAM SCENE MODEL FOLDER
import { spawn } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { createInterface } from 'node:readline';
import { join } from 'node:path';
import { start } from './support.mjs';

const [program, scenePath, model, folder] = process.argv.slice(2);
const TURNS = 15;
const STEPS = 200;
const NATIVE_SETS = ['scalar', 'sse4', 'avx2'];

const native = spawn(program, [scenePath, model, folder], { stdio: ['pipe', 'pipe', 'inherit'] });
const lines = createInterface({ input: native.stdout })[Symbol.asyncIterator]();
const nextLine = async () => {
    const { value, done } = await lines.next();
    if (done) throw new Error('the native program has ended');
    return value;
};
async function runNative(set, task) {
    native.stdin.write(`${set} ${task}\n`);
    return Number(await nextLine());
}
await nextLine();

const arrayOf = (Kind, name) => {
    const bytes = readFileSync(join(folder, name));
    return new Kind(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
};
const echinus = await start();
const mesh = echinus.makeMesh(arrayOf(Float32Array, 'vertices'), arrayOf(Uint32Array, 'faces'));
const scene = echinus.parseScene(readFileSync(scenePath, 'utf8'), scenePath);
const options = { exact: {}, distance: { kind: 'distance' } };
const maps = Object.fromEntries(Object.entries(options).map(([kind, choice]) => [kind, echinus.buildMap(mesh, choice)]));
const points = Object.fromEntries(['U', 'S'].map((name) => {
    const values = arrayOf(Float32Array, `particles_${name}`);
    const buffer = echinus.makePoints(values.length / 3);
    buffer.view.set(values);
    return [name, buffer];
}));
const inside = echinus.makeFlags(points.U.length), contacts = echinus.makeContacts(points.U.length);
const simulations = {};

function workOf(set, task) {
    const [name, kind, particles] = task.split(' ');
    if (name === 'build') return () => echinus.buildMap(mesh, options[kind]).delete();
    if (name === 'contains') return () => maps[kind].containsBatch(points[particles], inside);
    if (name === 'contacts') return () => maps[kind].contactsBatch(points[particles], 0, contacts);
    simulations[set] ??= scene.makeSimulation(maps[kind]);
    return () => simulations[set].step();
}
function runModule(set, task) {
    echinus.instructionSet = set;
    const work = workOf(set, task);
    const before = process.cpuUsage();
    work();
    const { user, system } = process.cpuUsage(before);
    return (user + system) * 1e-6;
}

const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];
const contestants = [
    ...['wasm', 'scalar'].map((set) => ({ name: `module, ${set}`, run: (task) => runModule(set, task) })),
    ...NATIVE_SETS.map((set) => ({ name: `native, ${set}`, run: (task) => runNative(set, task) })),
];

console.log(`| processor time, ms | ${contestants.map(({ name }) => name).join(' | ')} | module / native scalar | module / native sse4 |`);
console.log(`|---|${'---|'.repeat(contestants.length + 2)}`);
for (const [task, turns] of [
    ['contains exact U', TURNS], ['contains exact S', TURNS], ['contacts exact S', TURNS],
    ['contains distance U', TURNS], ['contacts distance S', TURNS], ['simulation exact', STEPS], ['build exact', TURNS], ['build distance', TURNS],
]) {
    const times = contestants.map(() => []);
    // The host's compiler needs some calls to reach its best code.
    for (let turn = -5; turn < turns; ++turn)
        for (const [i, { run }] of contestants.entries()) {
            const seconds = await run(task);
            if (turn >= 0) times[i].push(seconds);
        }
    const ms = times.map((values) => 1000 * median(values));
    const ratio = (i) => (ms[0] / ms[i]).toFixed(2);
    console.log(`| ${task} | ${ms.map((value) => value.toFixed(2)).join(' | ')} | ${ratio(2)} | ${ratio(3)} |`);
}
native.stdin.end();
