// The common part of the runners in Node: their arguments, and the folder that they write
// (lab/bench/engines/runners.py).
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { parseArgs } from 'node:util';

export const FRAME_SECONDS = 1 / 60;
export const GRAVITY = [0, -9.81, 0];
export const FRICTION = 0.5;
/** A correction after the step is coupled the closer to the engine's solver the shorter the steps are: docs/wasm.md. */
const STEPS_WITH_ECHINUS = 4;
/** The margin of the matched setup, and what Echinus keeps of distance in all: the model's radius is 1. */
export const THICKNESS = 0.01;

const NOT_INSTALLED = 77;

const { values: given } = parseArgs({
    options: {
        model: { type: 'string' }, cloth: { type: 'string' }, setup: { type: 'string' }, frames: { type: 'string' }, out: { type: 'string' },
        echinus: { type: 'boolean', default: false }, particles: { type: 'boolean', default: false },
    },
});
export const isMatched = given.setup === 'matched';
export const { echinus: withEchinus, particles: particlesOnly } = given;
/** Of an engine whose own documentation steps once a frame. */
export const stepsPerFrame = withEchinus && !isMatched ? STEPS_WITH_ECHINUS : 1;
export const STEP_SECONDS = FRAME_SECONDS / stepsPerFrame;
export const model = readObj(given.model);
export const cloth = readObj(given.cloth);

/** A package, or the end of this run. */
export async function engine(name) {
    try {
        return await import(name);
    } catch (error) {
        if (error.code !== 'ERR_MODULE_NOT_FOUND') throw error;
        console.error(`${name} is not installed (npm ci in lab/bench/engines/node)`);
        return process.exit(NOT_INSTALLED);
    }
}

/** The version of an installed package. */
export function versionOf(name) {
    let folder = createRequire(import.meta.url).resolve(name);
    while (true) {
        folder = join(folder, '..');
        try {
            const { name: found, version } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
            if (found === name) return version;
        } catch (error) {
            if (error.code !== 'ENOENT' || folder === '/') throw error;
        }
    }
}

/**
 * @param description  engine, version, configuration, substeps, settings
 * @param step         computes one of the stepsPerFrame
 * @param positions    [3 n] of the particles, in the order of the cloth's vertices
 */
export function record(description, step, positions) {
    const samples = [Float32Array.from(positions())];
    const frameSeconds = [];
    for (let frame = 0; frame < Number(given.frames); ++frame) {
        const before = process.cpuUsage();
        for (let i = 0; i < stepsPerFrame; ++i) step();
        const { user, system } = process.cpuUsage(before); // microseconds
        frameSeconds.push((user + system) / 1e6);
        samples.push(Float32Array.from(positions()));
    }
    writeCache(join(given.out, 'cloth.pc2'), samples);
    writeFileSync(join(given.out, 'run.json'), JSON.stringify({ ...description, platform: 'wasm', frame_seconds: frameSeconds }, null, 1));
}

/** @returns places of particles in the order of the engine, found by where the cloth's vertices begin */
export function orderOf(positions) {
    const key = (numbers, i) => [0, 1, 2].map((k) => Math.round(numbers[3 * i + k] * 1e5) + 0).join(' ');
    const places = new Map(Array.from({ length: positions.length / 3 }, (_, i) => [key(positions, i), i]));
    return Uint32Array.from({ length: cloth.vertices.length / 3 }, (_, i) => {
        const place = places.get(key(cloth.vertices, i));
        if (place === undefined) throw new Error(`vertex ${i} of the cloth has no particle`);
        return place;
    });
}

/** The positions of an engine, in the order of the cloth's vertices. */
export function inOrder(positions, order) {
    const result = new Float32Array(3 * order.length);
    order.forEach((place, i) => result.set(positions.subarray(3 * place, 3 * place + 3), 3 * i));
    return result;
}

function readObj(path) {
    const vertices = [], faces = [];
    for (const line of readFileSync(path, 'utf8').split('\n')) {
        const [kind, ...words] = line.trim().split(/\s+/);
        if (kind === 'v') vertices.push(...words.slice(0, 3).map(Number));
        if (kind !== 'f') continue;
        const corners = words.map((word) => Number.parseInt(word, 10) - 1);
        for (let k = 2; k < corners.length; ++k) faces.push(corners[0], corners[k - 1], corners[k]);
    }
    return { vertices: Float32Array.from(vertices), faces: Uint32Array.from(faces) };
}

/** PC2, version 1. */
function writeCache(path, samples) {
    const header = Buffer.alloc(32);
    header.write('POINTCACHE2\0', 'latin1');
    header.writeInt32LE(1, 12);
    header.writeInt32LE(samples[0].length / 3, 16);
    header.writeFloatLE(0, 20);
    header.writeFloatLE(1, 24);
    header.writeInt32LE(samples.length, 28);
    writeFileSync(path, Buffer.concat([header, ...samples.map(({ buffer }) => Buffer.from(buffer))]));
}
