// Lifetime, memory, errors, hostile input: nothing crashes the module.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { Worker } from 'node:worker_threads';
import { beforeEach, describe, test } from 'node:test';
import { compiled, errorOf, module, moduleFolder, start } from './support.mjs';

let echinus;
beforeEach(async () => { echinus = await start(); });

/** The module still works. */
function assertAlive() {
    const mesh = echinus.makeBox([2, 2, 2]);
    const map = echinus.buildMap(mesh);
    assert.equal(map.contains([0, 0, 0]), true);
    map.delete();
    mesh.delete();
}

describe('An object that was deleted', () => {
    test('refuses every use but another delete()', () => {
        const mesh = echinus.makeBox([1, 1, 1]);
        const map = echinus.buildMap(mesh);
        const points = echinus.makePoints(4);
        for (const object of [mesh, map, points]) {
            assert.equal(object.deleted, false);
            object.delete();
            object.delete();
            assert.equal(object.deleted, true);
        }
        for (const use of [() => mesh.report(), () => mesh.vertices, () => map.contains([0, 0, 0]), () => points.view, () => echinus.buildMap(mesh)])
            assert.equal(errorOf(use).code, 'Deleted');
        assertAlive();
    });
    test('gives its memory back', () => {
        const torus = echinus.makeTorus(1, 0.4, 100, 50);
        const build = () => echinus.buildMap(torus).delete();
        for (let i = 0; i < 3; ++i) build();
        const before = echinus.memoryByteCount;
        for (let i = 0; i < 30; ++i) build();
        assert.equal(echinus.memoryByteCount, before);
    });
    test('is deleted by the end of a block that disposes of it', () => {
        const mesh = echinus.makeBox([1, 1, 1]);
        mesh[Symbol.dispose ?? Symbol.for('Symbol.dispose')]();
        assert.equal(mesh.deleted, true);
    });
    test('may have lent a map to a simulation, which keeps it', () => {
        const scene = echinus.parseScene({ model: { torus: {} }, cloth: { size: [3, 3], particles: [20, 20], position: [0, 0, 0.5] } });
        const map = scene.buildMap(scene.makeModel());
        const simulation = scene.makeSimulation(map);
        map.delete();
        scene.delete();
        simulation.step(10);
        assert.equal(simulation.containsBatch(echinus.makeFlags(400)).view.includes(1), false);
    });
});

describe('When memory grows', () => {
    test('a buffer shows the same values through a new view', () => {
        const points = echinus.makePoints(1000);
        const held = points.view;
        for (let i = 0; i < held.length; ++i) held[i] = i;
        const before = echinus.memoryByteCount;
        const large = echinus.makePoints(5_000_000);
        assert.ok(echinus.memoryByteCount > before);
        assert.equal(held.length, 0, 'the old view is cut off, not stale');
        assert.equal(points.view.length, 3000);
        assert.equal(points.view[2999], 2999);
        large.delete();
    });
    test('contacts and positions do, too', () => {
        const scene = echinus.parseScene({ model: { torus: {} }, cloth: { size: [3, 3], particles: [20, 20], position: [0, 0, 0.5] } });
        const simulation = scene.makeSimulation(scene.buildMap(scene.makeModel()));
        simulation.step(10);
        const contacts = simulation.contactsBatch(0.1, echinus.makeContacts(400));
        const was = { positions: simulation.positions.slice(), floats: contacts.floats.slice(), ints: contacts.ints.slice(), bytes: contacts.bytes.slice() };
        echinus.makePoints(5_000_000);
        assert.deepEqual(simulation.positions.slice(), was.positions);
        assert.deepEqual(contacts.floats.slice(), was.floats);
        assert.deepEqual(contacts.ints.slice(), was.ints);
        assert.deepEqual(contacts.bytes.slice(), was.bytes);
    });
    test('in the middle of a batch over a Float32Array, the answers arrive', () => {
        const map = echinus.buildMap(echinus.makeBox([2, 2, 2]));
        const count = 3_000_000;
        const inside = echinus.makeFlags(count);
        const before = echinus.memoryByteCount;
        map.containsBatch(new Float32Array(3 * count), inside);
        assert.ok(echinus.memoryByteCount > before);
        assert.equal(inside.view[count - 1], 1);
    });
});

describe('Too much', () => {
    test('of memory is an error, and the module still works', () => {
        assert.equal(errorOf(() => echinus.makePoints(0xffffffff)).code, 'OutOfMemory');
        assert.equal(errorOf(() => echinus.makeFlags(0xfffffff0)).code, 'OutOfMemory');
        assertAlive();
    });
    test('of faces is refused by the generator', () => {
        assert.equal(errorOf(() => echinus.makeTorus(1, 0.4, 0xffffffff, 0xffffffff)).code, 'InvalidOptions');
        assert.match(errorOf(() => echinus.makeTorus(1, 0.4, 1.5, 7)).message, /majorSegments is 1.5/);
        assertAlive();
    });
    test('of a map that does not fit into 4 GiB is an error, until there is room for it', () => {
        const mesh = echinus.makeTorus(1, 0.4, 300, 150);
        const ballast = [];
        for (let size = 2 ** 30; size >= 2 ** 20;) {
            try {
                ballast.push(echinus.makeFlags(size));
            } catch (error) {
                assert.equal(error.code, 'OutOfMemory');
                size /= 2;
            }
        }
        const error = errorOf(() => echinus.buildMap(mesh));
        assert.equal(error.code, 'OutOfMemory');
        assert.match(error.message, /out of memory/);
        for (const flags of ballast) flags.delete();
        assert.equal(mesh.report().closed, true);
        assert.equal(echinus.buildMap(mesh).contains([1, 0, 0]), true);
        assertAlive();
    });
});

describe('Hostile input', () => {
    const torusArrays = () => {
        const torus = echinus.makeTorus(1, 0.4, 8, 6);
        return [torus.vertices, torus.faces];
    };

    test('in meshes gives our sentence', () => {
        const [vertices, faces] = torusArrays();
        const broken = vertices.slice();
        broken[7] = NaN;
        const cases = [
            [() => echinus.makeMesh(broken, faces), 'InvalidMesh', /not finite/],
            [() => echinus.makeMesh(vertices, faces.map(() => 4_000_000_000)), 'InvalidMesh', /4000000000/],
            [() => echinus.makeMesh([], []), 'InvalidMesh', /no faces/],
            [() => echinus.makeMesh([1, 2], [0, 0, 0]), 'InvalidArgument', /three numbers/],
            [() => echinus.makeMesh(vertices, [0, 1]), 'InvalidArgument', /faces/],
            [() => echinus.makeMesh(vertices, [0, 1, -1]), 'InvalidArgument', /number 2 of faces is -1/],
            [() => echinus.makeMesh(vertices, [0, 1, 1.5]), 'InvalidArgument', /1.5/],
            [() => echinus.makeMesh(null, faces), 'InvalidArgument', /vertices/],
            [() => echinus.makeMeshFromPolygons(vertices, [0, 1, 2], [4]), 'InvalidMesh', /add up to 4/],
            [() => echinus.makeMeshFromPolygons(vertices, [0, 1, 2], [0xffffffff, 4]), 'InvalidMesh', /add up to/],
            [() => echinus.makeMeshFromPolygons(vertices, [0, 1, 999], [3]), 'InvalidMesh', /999/],
        ];
        for (const [use, code, sentence] of cases) {
            const error = errorOf(use);
            assert.equal(error.code, code, error.message);
            assert.match(error.message, sentence);
        }
        assertAlive();
    });

    test('in arguments that are no numbers is refused', () => {
        const map = echinus.buildMap(echinus.makeTorus(1, 0.4, 8, 6));
        for (const call of [() => map.contact([0, 0, 0], 1n), () => echinus.makeTorus(1n, 0.4, 8, 6)]) assert.equal(errorOf(call).code, 'InvalidArgument');
        assert.match(errorOf(() => echinus.parseScene({ model: { torus: {} }, cloth: { size: [1, 1] } }).makeSimulation(map, { allowOpenColiders: true })).message, /'allowOpenColiders' is not an option of a simulation/);
        assertAlive();
    });
    test('in files gives our sentence with the name of the file', () => {
        const text = (string) => new TextEncoder().encode(string);
        const files = [
            ['v 1 2\n', 'a.obj', 'Damaged'], ['f 1 2 3\n', 'a.obj', 'InvalidMesh'], ['v 1 2 3', 'noending', 'WrongFormat'],
        ];
        for (const [content, name, code] of files) {
            const error = errorOf(() => echinus.readMesh(text(content), name));
            assert.ok(error.message.startsWith(name), error.message);
            assert.equal(error.code, code, error.message);
        }
        const error = errorOf(() => echinus.readMesh(new Uint8Array(200).fill(255), 'a.stl'));
        assert.ok(error.message.startsWith('a.stl'), error.message);
        assertAlive();
    });

    test('in directions of rays is refused', () => {
        const map = echinus.buildMap(echinus.makeBox([2, 2, 2]));
        for (const direction of [[0, 0, 0], [NaN, 1, 1], [Infinity, 0, 0], [1e300, 0, 0]])
            assert.equal(errorOf(() => map.ray(direction)).code, 'InvalidOptions');
        assert.equal(errorOf(() => map.ray([1, 2])).code, 'InvalidArgument');
        assert.equal(errorOf(() => map.ray('up')).code, 'InvalidArgument');
    });

    test('in sizes of batches is refused before anything is written', () => {
        const map = echinus.buildMap(echinus.makeBox([2, 2, 2]));
        const points = echinus.makePoints(10), few = echinus.makeFlags(9);
        for (const use of [
            () => map.containsBatch(points, few),
            () => map.containsBatch(points, echinus.makeFlags(10), 11),
            () => map.containsBatch(points, echinus.makeFlags(10), -1),
            () => map.containsBatch(points, new Uint8Array(10)),
            () => map.containsBatch([0, 0, 0], few),
            () => map.containsBatch(new Float32Array(4), few),
            () => map.contactsBatch(points, 0, few),
            () => echinus.makePoints(-1),
            () => echinus.makePoints(2.5),
        ])
            assert.equal(errorOf(use).code, 'InvalidArgument');
        assertAlive();
    });

    test('from another instance of the module is refused', async () => {
        const other = await start();
        const mesh = other.makeBox([1, 1, 1]);
        assert.equal(errorOf(() => echinus.buildMap(mesh)).code, 'InvalidArgument');
        assert.equal(errorOf(() => echinus.buildMap({})).code, 'InvalidArgument');
    });
});

describe('A simulation', () => {
    test('that diverges reports the frame, and can still be read', () => {
        const scene = echinus.parseScene({
            model: { torus: {} }, gravity: [0, 0, 1e9],
            cloth: { size: [3, 3], particles: [10, 10], position: [0, 0, 5] },
        });
        const simulation = scene.makeSimulation(scene.buildMap(scene.makeModel()));
        const error = errorOf(() => simulation.step(100_000));
        assert.equal(error.code, 'Diverged');
        assert.match(error.message, /frame \d+/);
        assert.equal(simulation.positions.length, 300);
        assertAlive();
    });
    test('refuses the exact map of an open mesh unless it is asked to take it', () => {
        const cube = echinus.makeBox([1, 1, 1]);
        const open = echinus.makeMesh(cube.vertices, cube.faces.slice(3));
        const map = echinus.buildMap(open);
        const scene = echinus.parseScene({ model: { torus: {} }, cloth: { size: [3, 3], particles: [10, 10], position: [0, 0, 2] }, collision: 'particles' });
        const error = errorOf(() => scene.makeSimulation(map));
        assert.equal(error.code, 'InvalidOptions');
        assert.match(error.message, /open mesh/);
        const simulation = scene.makeSimulation(map, { allowOpenCollider: true });
        simulation.step();
        assert.equal(simulation.frame, 1);
        assertAlive();
    });
    test('refuses velocities that are not finite, and particles that it does not have', () => {
        const scene = echinus.parseScene({ model: { torus: {} }, cloth: { size: [3, 3], particles: [10, 10], position: [0, 0, 2] } });
        const simulation = scene.makeSimulation(scene.buildMap(scene.makeModel()));
        for (const use of [
            () => simulation.setParticleVelocity(100, [0, 0, 0]), () => simulation.setParticleVelocity(-1, [0, 0, 0]), () => simulation.setParticleVelocity(0, [NaN, 0, 0]),
            () => simulation.setColliderVelocity([0, 0, 0], [0, Infinity, 0]), () => simulation.blow([0, NaN, 0], 1), () => simulation.blow([0, 0, 0], -1),
            () => simulation.step(-1), () => simulation.containsBatch(echinus.makeFlags(99)),
        ])
            assert.equal(errorOf(use).code, 'InvalidArgument');
        simulation.step();
    });
});

describe('A collider that deforms', () => {
    const sceneOf = (keys) => echinus.parseScene({ model: { torus: {} }, cloth: { size: [3, 3], particles: [10, 10], position: [0, 0, 2] }, ...keys });
    test('refuses vertices that are not those of its mesh, and goes on as it was', () => {
        const scene = sceneOf({ collision: 'surfaces_and_self' });
        const mesh = scene.makeModel();
        const { vertices } = mesh;
        const simulation = scene.makeSimulation(scene.buildMap(mesh)), undisturbed = scene.makeSimulation(scene.buildMap(mesh));
        const refusal = (given, index) => errorOf(() => simulation.setColliderVertices(given, index));
        assert.match(refusal(vertices.subarray(3)).message, /has \d+ vertices, and was given positions for \d+/);
        assert.match(refusal(vertices.map((part, i) => (i === 10 ? NaN : part))).message, /the position of vertex 3 is not finite/);
        assert.equal(refusal(new Float32Array(vertices.length)).code, 'InvalidMesh');
        for (const given of [[...vertices], vertices.subarray(1), undefined, 7, new Float64Array(vertices), echinus.makeFlags(vertices.length)])
            assert.equal(refusal(given).code, 'InvalidArgument');
        for (const index of [1, -1, 0.5, NaN]) assert.equal(refusal(vertices, index).code, 'InvalidArgument');
        for (const each of [simulation, undisturbed]) each.step(3);
        assert.equal(simulation.stateHash, undisturbed.stateHash);
        const deleted = echinus.makePoints(mesh.vertexCount);
        deleted.delete();
        assert.equal(refusal(deleted).code, 'Deleted');
        assertAlive();
    });
    test('needs an exact map, and surfaces that collide', () => {
        for (const [keys, words] of [[{ collision: 'particles' }, /cannot deform where only particles collide/], [{ map: { kind: 'distance' } }, /has no exact map/]]) {
            const scene = sceneOf(keys);
            const mesh = scene.makeModel();
            const error = errorOf(() => scene.makeSimulation(scene.buildMap(mesh)).setColliderVertices(mesh.vertices));
            assert.equal(error.code, 'InvalidOptions');
            assert.match(error.message, words);
        }
        assertAlive();
    });
});

describe('The module', () => {
    test('supports everything here, and names what it needs where vectors are missing', async () => {
        assert.deepEqual(module.missingFeatures(), []);
        const { validate } = WebAssembly;
        WebAssembly.validate = () => false;
        try {
            assert.deepEqual(module.missingFeatures(), ['WebAssembly SIMD', 'WebAssembly exceptions']);
            await assert.rejects(module.load(compiled), { code: 'Unsupported' });
        } finally {
            WebAssembly.validate = validate;
        }
    });
    test('loads from beside itself, from a file, bytes, a response, and a compiled module', async () => {
        const bytes = readFileSync(join(moduleFolder, 'echinus.wasm'));
        const streamed = new Response(bytes, { headers: { 'content-type': 'application/wasm' } });
        for (const source of [undefined, new URL(`file://${join(moduleFolder, 'echinus.wasm')}`), bytes, new Response(bytes), streamed, compiled]) {
            const instance = await module.load(source);
            assert.equal(instance.instructionSet, 'wasm');
        }
        await assert.rejects(module.load(new Response('', { status: 404 })), { code: 'Unreadable' });
        for (const wrong of [new Uint8Array(4), new Response('no module'), 'http://127.0.0.1:1/echinus.wasm', 7, null]) {
            await assert.rejects(module.load(wrong), { name: 'EchinusError', code: 'Unreadable' });
        }
    });
    test('chooses between its kernels and the reference', () => {
        echinus.instructionSet = 'scalar';
        assert.equal(echinus.instructionSet, 'scalar');
        assert.match(errorOf(() => { echinus.instructionSet = 'avx2'; }).message, /wasm, scalar/);
        assert.equal(echinus.instructionSet, 'scalar');
    });
    test('works in a worker, to which the compiled module is posted', async () => {
        const code = `
            import { parentPort, workerData } from 'node:worker_threads';
            const { load } = await import(workerData.url);
            const echinus = await load(workerData.compiled);
            parentPort.postMessage(echinus.buildMap(echinus.makeBox([2, 2, 2])).contains([0, 0, 0]));`;
        const worker = new Worker(new URL(`data:text/javascript,${encodeURIComponent(code)}`), {
            workerData: { url: `file://${join(moduleFolder, 'echinus.mjs')}`, compiled },
        });
        const answer = await new Promise((resolve, reject) => worker.once('message', resolve).once('error', reject));
        assert.equal(answer, true);
        await worker.terminate();
    });
});
