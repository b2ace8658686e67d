// The module's answers, and the interplay of its parts.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { before, describe, test } from 'node:test';
import { module, pseudoRandom, readScene, sourceFolder, start } from './support.mjs';

let echinus;
before(async () => { echinus = await start(); });

/** A cloth above a torus. */
const falling = { model: { torus: {} }, cloth: { size: [3, 3], particles: [20, 20], position: [0, 0, 0.5] } };

/** A cube of edge 1 without its lid: vertices of corner i have the bits of i as coordinates. */
const cubeVertices = Float32Array.from({ length: 24 }, (_, i) => (Math.floor(i / 3) >> (i % 3)) & 1);
const openCubeSides = [[0, 2, 3, 1], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]];

describe('A mesh', () => {
    test('of polygons is cut into triangles, and its report finds the hole', () => {
        const mesh = echinus.makeMeshFromPolygons(cubeVertices, openCubeSides.flat(), openCubeSides.map((side) => side.length));
        const report = mesh.report();
        assert.equal(report.faceCount, 10);
        assert.equal(report.closed, false);
        assert.equal(report.borderEdges.count, 4);
        const edges = mesh.faults().borderEdges;
        assert.deepEqual(new Set(edges), new Set([4, 5, 6, 7]), 'the corners of the missing lid');
        assert.equal(edges.length, 8);
    });
    test('returns the arrays that it was made of', () => {
        const torus = echinus.makeTorus(1, 0.4, 8, 6);
        const again = echinus.makeMesh(torus.vertices, torus.faces);
        assert.deepEqual(again.vertices, torus.vertices);
        assert.deepEqual(again.faces, torus.faces);
        assert.equal(again.report().closed, true);
    });
    test('far from 0 has an origin, and its map takes points relative to it', () => {
        const at = (i) => [448262.25 + (i & 1), 5411932.4 + 0.9 * ((i >> 1) & 1), 112.3 + 0.8 * (i >> 2)];
        const lines = Array.from({ length: 8 }, (_, i) => `v ${at(i).join(' ')}`);
        const sides = [...openCubeSides, [4, 5, 7, 6]].map((side) => `f ${side.map((corner) => corner + 1).join(' ')}`);
        const mesh = echinus.readMesh(new TextEncoder().encode([...lines, ...sides, ''].join('\n')), 'cube.obj');
        assert.ok(Math.abs(mesh.report().signedVolume - 0.72) < 1e-6);
        assert.equal(mesh.report().roundingStep, 0);
        const map = echinus.buildMap(mesh);
        assert.deepEqual(map.origin, mesh.origin);
        const inFile = (...point) => point.map((coordinate, axis) => coordinate - map.origin[axis]);
        assert.equal(map.contains(inFile(448262.75, 5411932.45, 112.7)), true);
        assert.equal(map.contains(inFile(448262.75, 5411932.35, 112.7)), false);
        assert.deepEqual(echinus.makeTorus(1, 0.4, 8, 6).origin, [0, 0, 0]);
    });
    test('whose faces share no vertices is closed, and has fewer after welding', () => {
        const torus = echinus.makeTorus(1, 0.4, 8, 6);
        const { vertices, faces } = torus;
        const soup = Float32Array.from({ length: 3 * faces.length }, (_, i) => vertices[3 * faces[Math.floor(i / 3)] + (i % 3)]);
        const loose = echinus.makeMesh(soup, Uint32Array.from(faces.keys()));
        assert.equal(loose.report().closed, true);
        assert.equal(loose.vertexCount, faces.length);
        const welded = loose.weld();
        assert.equal(welded.report().closed, true);
        assert.equal(welded.vertexCount, torus.vertexCount);
    });
    test('with a face twice is repaired, and the report names the dropped face', () => {
        const torus = echinus.makeTorus(1, 0.4, 8, 6);
        const faces = [...torus.faces, ...torus.faces.subarray(0, 3)];
        const { mesh, report } = echinus.makeMesh(torus.vertices, faces).repair(['duplicate_faces']);
        assert.equal(report.duplicateFacesDropped, 1);
        assert.deepEqual([...report.droppedFaces], [torus.faceCount]);
        assert.equal(mesh.report().closed, true);
    });
    test('knows the pairs of its faces that intersect another mesh, and each other', () => {
        const sheet = echinus.makeMesh([-1, -1, 0, 1, -1, 0, 0, 1, 0, 5, 5, 5, 6, 5, 5, 5, 6, 5], [0, 1, 2, 3, 4, 5]);
        const needle = echinus.makeMesh([0, 0, -1, 0.1, 0, 1, 0, 0.1, 1], [0, 1, 2]);
        assert.deepEqual([...sheet.intersectingPairs(needle)], [0, 0]);
        assert.deepEqual([...needle.intersectingPairs(sheet)], [0, 0]);
        assert.deepEqual([...sheet.selfIntersectingPairs()], []);
        const both = echinus.makeMesh([...sheet.vertices, ...needle.vertices], [0, 1, 2, 3, 4, 5, 6, 7, 8]);
        assert.deepEqual([...both.selfIntersectingPairs()], [0, 2]);
        assert.throws(() => sheet.intersectingPairs({}), { code: 'InvalidArgument' });
    });
    test('is checked against others and itself, with the curves and depths', () => {
        const torus = echinus.makeTorus(1, 0.4, 24, 12);
        const needle = echinus.makeMesh([1, 0, 0, 1.1, 0, 2, 1, 0.1, 2], [0, 1, 2]);
        const { pairs, curves } = torus.intersections(needle);
        assert.deepEqual([...pairs], [...torus.intersectingPairs(needle)]);
        assert.equal(curves.length, 1);
        assert.equal(curves[0].closed, false);
        assert.ok(curves[0].points.length >= 6 && curves[0].points.every((x) => Math.abs(x) < 1.2));
        assert.deepEqual(torus.intersections(), { pairs: new Uint32Array(0), curves: [] });
        const [found, ...others] = echinus.check([torus, needle]);
        assert.equal(others.length, 0);
        assert.deepEqual([found.a, found.b, found.pairCount, found.curveCount], [0, 1, pairs.length / 2, 1]);
        assert.equal(found.aInB, null); // a single face has no inside
        assert.deepEqual([found.bInA.vertexCount, found.bInA.deepestVertex], [1, 0]);
        assert.ok(Math.abs(found.bInA.depth - 0.39) < 0.02);
        assert.deepEqual(echinus.check([]), []);
        assert.throws(() => echinus.check([torus, {}]), { code: 'InvalidArgument' });
        assert.throws(() => torus.intersections({}), { code: 'InvalidArgument' });
    });
    test('is parted from models and from layers, and the report counts what still intersects', () => {
        const [torus, ball] = [echinus.makeTorus(1, 0.3, 24, 12), echinus.makeSphere(0.3, 16, 8)];
        const moved = echinus.makeMesh(ball.vertices.map((x, i) => x + (i % 3 === 0 ? 0.95 : 0.01)), ball.faces);
        const { mesh, report } = torus.part([moved]);
        assert.deepEqual([report.ownPairs, report.modelPairs, report.insideCount], [0, 0, 0]);
        assert.ok(report.largestStretch > 0 && mesh.intersectingPairs(moved).length === 0);
        const pinned = new Uint8Array(torus.vertexCount).fill(1);
        assert.ok(torus.part([moved], { pinned }).report.modelPairs > 0);
        assert.deepEqual(torus.part([moved], { pinned }).mesh.vertices, torus.vertices);
        const two = echinus.makeMesh([...ball.vertices, ...moved.vertices.map((x, i) => x - (i % 3 === 0 ? 0.9 : 0))],
            [...ball.faces, ...ball.faces.map((v) => v + ball.vertexCount)]);
        const layers = Uint8Array.from({ length: two.vertexCount }, (_, v) => (v < ball.vertexCount ? 0 : 1));
        const { vertices } = two.part([], { layers }).mesh;
        const outer = echinus.makeMesh(vertices.subarray(ball.vertices.length), ball.faces);
        const map = echinus.buildMap(outer);
        for (let i = 0; i < ball.vertices.length; i += 3) assert.ok(map.contains(vertices.subarray(i, i + 3)));
        assert.throws(() => torus.part([{}]), { code: 'InvalidArgument' });
        assert.throws(() => torus.part([moved], { pinned: [1] }), { code: 'InvalidArgument' });
        assert.throws(() => torus.part([moved], { thickness: -1 }), { code: 'InvalidOptions' });
    });
    test('is read from the bytes of a file', () => {
        const obj = 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .1e+1 0.5 1e-3\nf 1 2 3 4\nf 1 2 5\n';
        const mesh = echinus.readMesh(new TextEncoder().encode(obj), 'A.OBJ');
        assert.equal(mesh.faceCount, 3);
        assert.ok(mesh.vertices.includes(Math.fround(1e-3)));
    });
    // Emscripten's library has no std::from_chars() for floats: there they are read by another function.
    test('reads decimals as the nearest float', () => {
        const random = pseudoRandom(5);
        const numbers = Array.from({ length: 300 }, () => (random() - 0.5) * 10 ** Math.floor(60 * random() - 30));
        const rows = numbers.map((x) => `v ${x} ${x.toExponential(20)} 1`);
        const faces = numbers.slice(2).map((_, i) => `f ${i + 1} ${i + 2} ${i + 3}`);
        const { vertices } = echinus.readMesh(new TextEncoder().encode([...rows, ...faces].join('\n')), 'a.obj');
        numbers.forEach((x, i) => assert.deepEqual([...vertices.subarray(3 * i, 3 * i + 2)], [Math.fround(x), Math.fround(x)]));
    });
    test('judges points by its winding number and distance', () => {
        const box = echinus.makeBox([2, 2, 2]);
        assert.ok(Math.abs(box.windingNumber([0.1, 0.2, 0.3]) - 1) < 1e-9);
        assert.ok(Math.abs(box.windingNumber([3, 0, 0])) < 1e-9);
        assert.equal(box.unsignedDistance([3, 0, 0]), 2);
    });
});

describe('A map', () => {
    test('of exact kind classifies, sweeps, and describes itself', () => {
        const map = echinus.buildMap(echinus.makeBox([2, 2, 2]));
        assert.ok(map instanceof module.ExactMap);
        assert.deepEqual(map.classify([0, 0, 0]), { inside: true, certain: true });
        const hit = map.sweep([0.1, 0.2, 3], [0.1, 0.2, 0]);
        assert.equal(hit.found, true);
        assert.equal(hit.entering, true);
        assert.ok(Math.abs(hit.fraction - 2 / 3) < 1e-5);
        assert.equal(map.sweep([0, 0, 3], [0, 0, 2]).found, false);
        assert.equal(map.description.closed, true);
        assert.equal(map.description.faceCount, 12);
        assert.equal(map.byteCount, map.description.byteCount);
    });
    test('has a surface with a class for each face, and cells with corners of length 1', () => {
        const mesh = echinus.makeTorus(1, 0.4, 24, 12);
        const exact = echinus.buildMap(mesh);
        const surface = exact.surface();
        assert.equal(surface.mesh.faceCount, mesh.faceCount);
        assert.equal(Math.max(...surface.longestLists), exact.description.longestList);
        const cells = exact.cells();
        assert.equal(cells.bandCounts.length, exact.description.cellCount);
        assert.equal(cells.corners.length, 9 * exact.description.cellCount);
        assert.equal(cells.bandCounts.reduce((a, b) => a + b), exact.description.bandCount);
        assert.ok(Math.abs(Math.hypot(...cells.corners.subarray(0, 3)) - 1) < 1e-6);
        const distance = echinus.buildMap(mesh, { kind: 'distance' }).surface();
        assert.deepEqual([...new Set(distance.layers)].sort(), [0, 1]);
        assert.equal(distance.layers.length, distance.mesh.faceCount);
    });
    for (const options of [{}, { kind: 'distance' }, { kind: 'distance', grid: 'octahedral' }])
        test(`with ${JSON.stringify(options)} agrees along a ray with contains()`, () => {
            const map = echinus.buildMap(echinus.makeTorus(1, 0.4, 24, 12), options);
            for (const direction of [[1, 0.1, 0.05], [-3, 2, 0.4], [0.01, 0.02, 5]]) {
                const size = Math.hypot(...direction);
                const ray = map.ray(direction);
                assert.equal(ray.intervals[0].from, 0);
                assert.equal(ray.intervals.at(-1).to, map.radius);
                assert.equal(ray.intervals.length, ray.crossings.length + 1);
                for (const { from, to, inside } of ray.intervals) {
                    const middle = direction.map((c, k) => map.centre[k] + (c / size) * (from + to) / 2);
                    assert.equal(map.contains(middle), inside);
                }
            }
        });
    test('takes a Float32Array as well as a buffer, and fewer points than there are', () => {
        const map = echinus.buildMap(echinus.makeBox([2, 2, 2]));
        const inside = echinus.makeFlags(2);
        assert.deepEqual([...map.containsBatch(Float32Array.of(0, 0, 0, 5, 0, 0), inside).view], [1, 0]);
        inside.view.fill(7);
        map.containsBatch(Float32Array.of(0, 0, 0, 0, 0, 0), inside, 1);
        assert.deepEqual([...inside.view], [1, 7]);
    });
});

describe('Map files of every version', () => {
    const folder = join(sourceFolder, 'tests/golden');
    for (const name of readdirSync(folder).filter((file) => file.endsWith('.ech')))
        test(`${name} is loaded, answers, and is saved as it was`, () => {
            const bytes = readFileSync(join(folder, name));
            const map = echinus.loadMap(bytes, name);
            assert.ok(Buffer.from(map.save()).equals(bytes));
            // This is the hole of the torus, and inside the boxes, the open one included.
            assert.equal(map.contains(map.centre), !name.includes('torus'));
        });
});

describe('A simulation', () => {
    test('tells what of it touches its model and what is inside, how it was computed, and how far its constraints are stretched', () => {
        const scene = echinus.parseScene({ ...falling, cloth: { ...falling.cloth, position: [0, 0, 0.42] } });
        const simulation = scene.makeSimulation(scene.buildMap(scene.makeModel()));
        assert.equal(scene.particleCount, simulation.particleCount);
        simulation.step(10);
        assert.deepEqual([simulation.frame, simulation.atRest], [10, false]);
        const inside = simulation.containsBatch(echinus.makeFlags(simulation.particleCount)).view;
        assert.equal(inside.includes(1), false);
        const contacts = simulation.contactsBatch(0.1, echinus.makeContacts(simulation.particleCount));
        assert.ok(Array.from({ length: simulation.particleCount }, (_, i) => contacts.at(i)).some(({ found }) => found));
        const { contactCount, lostCount, measuredPairCount, unresolvedCount } = simulation.profile;
        assert.ok(contactCount > 0 && measuredPairCount > 0);
        assert.deepEqual([lostCount, unresolvedCount], [0, 0]);
        const { rootMeanSquare, largest } = simulation.residual;
        assert.ok(rootMeanSquare > 0 && largest > rootMeanSquare);
    });
    test('is moved by a hand, by wind, and by a collider that deforms', () => {
        const scene = echinus.parseScene({ ...falling, gravity: [0, 0, 0] });
        const model = scene.makeModel();
        const simulation = scene.makeSimulation(scene.buildMap(model));
        const height = (i) => simulation.positions[3 * i + 2];
        const before = [height(0), height(399)];
        simulation.setParticleVelocity(0, [0, 0, 5]);
        simulation.step();
        assert.ok(height(0) > before[0] + 0.01);
        for (let i = 0; i < 20; ++i) {
            simulation.blow([0, 0, 5], 5);
            simulation.step();
        }
        assert.ok(height(399) > before[1] + 0.01);
        const points = echinus.makePoints(model.vertexCount);
        const grown = model.vertices.map((part) => 1.01 * part);
        simulation.setColliderVertices(grown);
        simulation.step();
        points.view.set(grown);
        simulation.setColliderVertices(points, 0);
        simulation.step();
        assert.equal(simulation.frame, 23);
    });
    test('of a cloth that is a mesh takes the mesh that its caller has read', () => {
        const description = { model: { box: {} }, cloth: { mesh: 'bag.obj', rest_mesh: 'wide.obj', position: [0, 0, 2], pins: [0] } };
        const scene = echinus.parseScene(description);
        assert.deepEqual([scene.clothFile, scene.clothRestFile, scene.particleCount], ['bag.obj', 'wide.obj', null]);
        const map = scene.buildMap(scene.makeModel());
        const bag = echinus.makeSphere(0.5, 12, 8);
        const simulation = scene.makeSimulation(map, { cloth: bag, clothAtRest: echinus.makeSphere(0.7, 12, 8) });
        assert.equal(simulation.particleCount, bag.vertexCount);
        assert.deepEqual(simulation.faces, bag.faces);
        simulation.step(10);
        assert.throws(() => scene.makeSimulation(map, { cloth: bag }), /cloth\.rest_mesh is the file wide\.obj: read it/);
        assert.throws(() => scene.makeSimulation(map), /cloth\.mesh is the file bag\.obj: read it/);
    });
    test('moves its positions in place', () => {
        const scene = echinus.parseScene(readScene('torus_small.json'));
        const simulation = scene.makeSimulation(scene.buildMap(scene.makeModel()));
        simulation.step(2); // make room for the contacts of surfaces, and memory that grows has new views
        const { positions } = simulation;
        const before = positions.slice();
        simulation.step();
        assert.equal(simulation.positions, positions, 'the same view');
        assert.notDeepEqual(positions, before);
        const speed = 9.81 * 3 * scene.timeStep; // after three frames
        assert.ok(Math.abs(simulation.velocities[2] + speed) < 0.02 * speed);
    });
    test('has a collider that turns at the velocity it is given', () => {
        const scene = echinus.parseScene(readScene('torus_small.json'));
        const simulation = scene.makeSimulation(scene.buildMap(scene.makeModel()));
        simulation.setColliderVelocity([0, 0, 1], [0, 0, Math.PI]);
        simulation.step(15);
        const { position, rotation } = simulation.collider;
        assert.ok(Math.abs(position[2] - 15 * scene.timeStep) < 1e-9);
        assert.ok(Math.abs(rotation[0] - Math.cos(Math.PI / 8)) < 1e-9);
    });
    test('reports the contacts of a frame, which sum to the load on a collider, and sets it free', () => {
        const scene = echinus.parseScene(readScene('torus_small.json'));
        const simulation = scene.makeSimulation(scene.buildMap(scene.makeModel()));
        simulation.step(40);
        assert.equal(simulation.contactPoints.gaps.length, 0);
        simulation.recordContacts();
        simulation.step();
        const { normals, normalImpulses, frictionImpulses, colliders, particles } = simulation.contactPoints;
        assert.equal(particles.length, 4 * colliders.length);
        const impulses = [0, 0, 0];
        colliders.forEach((number, i) => {
            if (number === 0) for (let k = 0; k < 3; ++k) impulses[k] += normals[3 * i + k] * normalImpulses[i] + frictionImpulses[3 * i + k];
        });
        const { force } = simulation.loadOn();
        assert.ok(force[2] < 0, `${force}`);
        assert.ok(impulses.every((impulse, k) => Math.abs(impulse / scene.timeStep + force[k]) < 0.01 * Math.hypot(...force)), `${impulses} ${force}`);
        simulation.setColliderFree(0.5);
        simulation.step(5);
        assert.ok(simulation.collider.position[2] < 0);
        assert.throws(() => simulation.setColliderFree(0), /mass of 0/);
    });
    test('continues with other options from its present state', () => {
        const description = { model: { torus: {} }, cloth: { size: [3, 3], particles: [20, 20], position: [0, 0, 0.5] } };
        const scene = echinus.parseScene(description);
        const first = scene.makeSimulation(scene.buildMap(scene.makeModel()));
        first.step(5);
        const light = echinus.parseScene({ ...description, gravity: [0, 0, 0] });
        const second = first.continueWith(light);
        assert.deepEqual(second.positions.slice(), first.positions.slice());
        first.step(5);
        second.step(5);
        assert.ok(second.positions[2] > first.positions[2]);
    });
    test('has several colliders, each with a map and a velocity of its own', () => {
        const cloth = { size: [2, 2], particles: [16, 16], position: [0, 0, 1.2] };
        const scene = echinus.parseScene({ colliders: [{ model: 'a.obj' }, { model: { sphere: {} }, position: [3, 0, 0] }], cloth });
        const maps = [echinus.buildMap(echinus.makeSphere(1, 30, 15)), echinus.buildMap(echinus.makeSphere(0.3, 20, 10))];
        assert.throws(() => scene.makeSimulation(maps[0]), /2 colliders/);
        const simulation = scene.makeSimulation(maps);
        assert.equal(simulation.colliderCount, 2);
        simulation.setColliderVelocity([-1, 0, 0], [0, 0, 0], 1);
        simulation.step(6);
        assert.ok(Math.abs(simulation.colliderAt(1).position[0] - 2.9) < 1e-9);
        assert.deepEqual(simulation.collider.position, [0, 0, 0]);
        assert.throws(() => simulation.setColliderVelocity([0, 0, 0], [0, 0, 0], 2), /there is no collider 2; there are 2/);
        assert.throws(() => simulation.colliderAt(-1));
    });
    test('continues with a collider more, and without it', () => {
        const description = { model: 'a.obj', cloth: { size: [2, 2], particles: [16, 16], position: [0, 0, 1.2] } };
        const maps = [echinus.buildMap(echinus.makeSphere(1, 30, 15)), echinus.buildMap(echinus.makeSphere(0.3, 20, 10))];
        const alone = echinus.parseScene(description);
        const simulation = alone.makeSimulation(maps[0]);
        simulation.setColliderVelocity([0, 0, -1], [0, 0, 0]);
        simulation.step(6);
        const { model, ...rest } = description;
        const both = echinus.parseScene({ ...rest, colliders: [{ model }, { model: { sphere: {} }, position: [0, 0, 3] }] });
        const joined = simulation.continueWith(both, maps);
        assert.deepEqual([joined.colliderCount, joined.colliderAt(1).position], [2, [0, 0, 3]]);
        assert.deepEqual(joined.collider, simulation.collider);
        assert.deepEqual(joined.positions.slice(), simulation.positions.slice());
        joined.step(4);
        assert.equal(joined.continueWith(alone, [maps[0]]).colliderCount, 1);
        assert.throws(() => simulation.continueWith(both, [maps[0]]), /a map for each collider/);
    });
    test('of soft bodies takes the surfaces that its caller has', () => {
        const bodies = [{ mesh: 'ball.obj', element: 0.2, position: [0, 0, 0.9] }];
        const scene = echinus.parseScene({ model: { torus: {} }, bodies });
        assert.equal(scene.particleCount, null);
        const map = scene.buildMap(scene.makeModel());
        const simulation = scene.makeSimulation(map, { bodies: [echinus.makeSphere(0.4, 20, 10)] });
        assert.ok(simulation.faces.length > 100);
        const before = simulation.positions[2];
        simulation.step(8);
        assert.ok(simulation.positions[2] < before);
        assert.throws(() => scene.makeSimulation(map), /bodies\[0\]: its mesh is the file ball\.obj/);
        assert.throws(() => scene.makeSimulation(map, { bodies: [null, null] }), /more meshes of bodies than bodies/);
    });
    test('of a scene with a file needs its mesh from outside', () => {
        const scene = echinus.parseScene(readScene('horse.json').replace('[100, 100]', '[30, 30]'), 'horse.json');
        assert.equal(scene.modelFile, 'horse.3ds');
        const map = scene.buildMap(echinus.makeSphere(0.5, 20, 10));
        assert.equal(scene.makeSimulation(map).frame, 0);
    });
});
