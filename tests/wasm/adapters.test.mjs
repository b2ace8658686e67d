// The adapters to engines and to three.js, from the package as examples/js has installed it, with the engines themselves.
import { describe, test } from 'node:test';
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { sourceFolder } from './support.mjs';

const installed = createRequire(join(sourceFolder, 'examples/js/package.json'));
const fromExamples = (name) => import(pathToFileURL(installed.resolve(name)));

const { load } = await fromExamples('echinus');
const echinus = await load();
const SECONDS = 1 / 60;
const torus = echinus.makeTorus(1, 0.4, 30, 16);
const map = echinus.buildMap(torus);

const insideCount = (positions, mesh = torus) => Array.from({ length: positions.length / 3 }, (_, i) => mesh.windingNumber(positions.subarray(3 * i, 3 * i + 3)))
    .filter((winding) => winding > 0.5).length;

describe('The examples', () => {
    for (const name of ['jolt', 'rapier', 'three'])
        test(`${name}.mjs ends with nothing inside`, () => {
            const { status, stdout, stderr } = spawnSync(process.execPath, [`${name}.mjs`], { cwd: join(sourceFolder, 'examples/js'), encoding: 'utf8' });
            assert.equal(status, 0, stderr);
            assert.match(stdout, / 0 of \d+ /);
        });
});

describe('In Jolt', async () => {
    const { default: initJolt } = await fromExamples('jolt-physics');
    const { JoltCollision } = await fromExamples('echinus/jolt');
    const { MODELS, addCloth, makeSheet, makeWorld, positionsOf } = await import(pathToFileURL(join(sourceFolder, 'examples/js/jolt_cloth.mjs')));
    const Jolt = await initJolt();
    const sheet = makeSheet(16, 2);
    const GRAVITY = [0, 0, -9.81];

    test('a cloth falls into the torus alone, and not with the adapter', () => {
        const inside = [false, true].map((withEchinus) => {
            const { jolt, bodies } = makeWorld(Jolt, GRAVITY);
            const cloth = addCloth(Jolt, bodies, sheet, { position: [0, 0, 0.5] });
            const collision = withEchinus && new JoltCollision(echinus, Jolt, cloth, { colliders: [{ map }], thickness: 0.03 });
            for (let step = 0; step < 25; ++step) {
                jolt.Step(SECONDS, 1);
                if (collision) collision.step(SECONDS);
            }
            return insideCount(positionsOf(Jolt, cloth));
        });
        assert.ok(inside[0] > 20, `${inside[0]} inside without it`);
        assert.equal(inside[1], 0);
    });
    test('no face of a cloth meets the torus with surfaces', () => {
        const { jolt, bodies } = makeWorld(Jolt, GRAVITY);
        const cloth = addCloth(Jolt, bodies, sheet, { position: [0, 0, 0.5] });
        const collision = new JoltCollision(echinus, Jolt, cloth, { colliders: [{ map }], thickness: 0.02, surfaces: true });
        for (let step = 0; step < 60; ++step) {
            jolt.Step(SECONDS, 1);
            collision.step(SECONDS);
            assert.equal(echinus.makeMesh(positionsOf(Jolt, cloth), sheet.faces).intersectingPairs(torus).length, 0, `step ${step}`);
        }
        assert.equal(collision.collision.unresolvedCount, 0);
    });
    test('a body that moves takes its collider along, and pinned vertices stay where Jolt has them', () => {
        const { jolt, bodies } = makeWorld(Jolt, [0, 0, 0]);
        const pin = 0;
        const cloth = addCloth(Jolt, bodies, sheet, { position: [0, 0, 0.5], pins: [pin] });
        const body = bodies.CreateBody(new Jolt.BodyCreationSettings(
            new Jolt.SphereShape(0.1), new Jolt.RVec3(0, 0, 0), new Jolt.Quat(0, 0, 0, 1), Jolt.EMotionType_Kinematic, MODELS));
        bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
        bodies.SetLinearVelocity(body.GetID(), new Jolt.Vec3(0, 0, 1));
        const collision = new JoltCollision(echinus, Jolt, cloth, { colliders: [{ map, body }], thickness: 0.03 });
        const before = positionsOf(Jolt, cloth);
        for (let step = 0; step < 60; ++step) {
            jolt.Step(SECONDS, 1);
            collision.step(SECONDS);
        }
        const after = positionsOf(Jolt, cloth);
        assert.ok(Math.abs(body.GetPosition().GetZ() - 1) < 1e-3);
        assert.equal(insideCount(after.map((c, i) => (i % 3 === 2 ? c - body.GetPosition().GetZ() : c))), 0);
        const risen = [...Array(256).keys()].filter((i) => after[3 * i + 2] > before[3 * i + 2] + 0.3).length;
        assert.ok(risen > 100, `${risen} were lifted`);
        for (let k = 0; k < 3; ++k) assert.ok(Math.abs(after[3 * pin + k] - before[3 * pin + k]) < 1e-5);
    });
    test('a vertex that is pinned later stays from then on', () => {
        const { jolt, bodies } = makeWorld(Jolt, [0, 0, 0]);
        const cloth = addCloth(Jolt, bodies, sheet, { position: [0, 0, 0.5] });
        const collision = new JoltCollision(echinus, Jolt, cloth, { colliders: [{ map }], thickness: 0.03 });
        const pin = 8 * 16 + 13; // over the torus
        Jolt.castObject(cloth.GetMotionProperties(), Jolt.SoftBodyMotionProperties).GetVertices().at(pin).mInvMass = 0;
        const before = positionsOf(Jolt, cloth);
        for (let step = 0; step < 30; ++step) {
            collision.collision.setColliderPose(0, [0, 0, 0.01 * step]);
            jolt.Step(SECONDS, 1);
            collision.step(SECONDS);
        }
        const after = positionsOf(Jolt, cloth);
        assert.ok([...Array(256).keys()].some((i) => after[3 * i + 2] > before[3 * i + 2] + 0.1), 'others were lifted');
        assert.ok(Math.abs(after[3 * pin + 2] - before[3 * pin + 2]) < 1e-5);
    });
    test('a soft body that is turned is refused', () => {
        const { bodies } = makeWorld(Jolt, GRAVITY);
        const cloth = addCloth(Jolt, bodies, sheet, {
            change(settings) {
                settings.mMakeRotationIdentity = false;
                settings.mRotation = new Jolt.Quat(0, 0, 1, 0);
            },
        });
        assert.throws(() => new JoltCollision(echinus, Jolt, cloth, { colliders: [{ map }], thickness: 0.03 }), { code: 'InvalidArgument', message: /mMakeRotationIdentity/ });
    });
});

describe('In Rapier', async () => {
    const { default: RAPIER } = await fromExamples('@dimforge/rapier3d-compat');
    const { RapierCollision } = await fromExamples('echinus/rapier');
    await RAPIER.init();

    test('a cloth falls into the torus alone, and not with the adapter', () => {
        const inside = [false, true].map((withEchinus) => {
            const world = new RAPIER.World({ x: 0, y: 0, z: -9.81 });
            const edge = 2 / 15;
            const cloth = world.createSoftBody(RAPIER.SoftBodyDesc.cloth({ x: -1, y: -1, z: 0.5 }, { x: edge, y: 0, z: 0 }, { x: 0, y: edge, z: 0 }, 16, 16));
            const collision = withEchinus && new RapierCollision(echinus, cloth, { colliders: [{ map }], thickness: 0.03 });
            for (let step = 0; step < 25; ++step) {
                world.step();
                if (collision) collision.step(world.timestep);
            }
            return insideCount(cloth.particlePositions());
        });
        assert.ok(inside[0] > 20, `${inside[0]} inside without it`);
        assert.equal(inside[1], 0);
    });
    test('pinned particles stay where Rapier has them, and surfaces take the faces of the body', () => {
        const world = new RAPIER.World({ x: 0, y: 0, z: 0 });
        const edge = 2 / 15, pin = 8 * 16 + 13;
        const desc = RAPIER.SoftBodyDesc.cloth({ x: -1, y: -1, z: 0.5 }, { x: edge, y: 0, z: 0 }, { x: 0, y: edge, z: 0 }, 16, 16);
        desc.pinnedParticles = [pin];
        const cloth = world.createSoftBody(desc);
        for (const options of [undefined, {}, { colliders: [null] }]) assert.throws(() => new RapierCollision(echinus, cloth, options), { code: 'InvalidArgument', message: /^colliders must be/ });
        const collision = new RapierCollision(echinus, cloth, { colliders: [{ map }], thickness: 0.02, surfaces: true });
        const before = cloth.particlePositions().slice();
        for (let step = 0; step < 30; ++step) {
            collision.collision.setColliderPose(0, [0, 0, 0.01 * step]);
            world.step();
            collision.step(world.timestep);
        }
        const after = cloth.particlePositions();
        assert.ok([...Array(256).keys()].some((i) => after[3 * i + 2] > before[3 * i + 2] + 0.1), 'others were lifted');
        assert.ok(Math.abs(after[3 * pin + 2] - before[3 * pin + 2]) < 1e-5);
    });
});

describe('In three.js', async () => {
    const { BoxGeometry, BufferGeometry, InterleavedBuffer, InterleavedBufferAttribute, Matrix4, Mesh, SphereGeometry, TorusGeometry, TorusKnotGeometry } = await fromExamples('three/src/Three.js');
    const { ClothGeometry, geometryOfMesh, meshOfGeometry } = await fromExamples('echinus/three');

    test('geometries of closed shapes become closed meshes, indexed or not', () => {
        for (const geometry of [new BoxGeometry(1, 2, 3, 4, 5, 6), new SphereGeometry(1), new TorusGeometry(1, 0.4, 16, 48), new TorusKnotGeometry(1, 0.3, 100, 12)])
            for (const given of [geometry, geometry.toNonIndexed()]) {
                const { closed, signedVolume, faceCount } = meshOfGeometry(echinus, given).report();
                assert.equal(closed, true, geometry.type);
                assert.ok(signedVolume > 0);
                assert.equal(faceCount, geometry.index.count / 3);
            }
    });
    test('a matrix moves the mesh, and one that mirrors leaves its outside outside', () => {
        const box = new BoxGeometry(1, 1, 1);
        const moved = meshOfGeometry(echinus, box, new Matrix4().makeTranslation(5, 0, 0));
        assert.deepEqual(moved.report().boundingSphere.centre, [5, 0, 0]);
        const mirrored = meshOfGeometry(echinus, box, new Matrix4().makeScale(-2, 1, 1)).report();
        assert.equal(mirrored.closed, true);
        assert.ok(Math.abs(mirrored.signedVolume - 2) < 1e-6);
    });
    test('a place far away joins no more vertices than one nearby', () => {
        const { closed, faceCount } = meshOfGeometry(echinus, new SphereGeometry(1, 64, 32), new Matrix4().makeTranslation(3000, 0, 0)).report();
        assert.ok(closed);
        assert.equal(faceCount, new SphereGeometry(1, 64, 32).index.count / 3);
    });
    test('what is no vertex, or no place, is refused, and what no face uses does not matter', () => {
        for (const given of [new Mesh(), new BufferGeometry()]) assert.throws(() => meshOfGeometry(echinus, given), { code: 'InvalidArgument' });
        const assertRefused = (geometry) => assert.throws(() => meshOfGeometry(echinus, geometry), { code: 'InvalidMesh' });
        const triangle = () => new BufferGeometry().setAttribute('position', new BoxGeometry(1, 1, 1).attributes.position);
        assertRefused(triangle().setIndex([0, 1, 700]));
        const holed = new SphereGeometry(1, 64, 32);
        holed.attributes.position.setX(200, NaN);
        assertRefused(holed);
        const box = new BoxGeometry(1, 1, 1).toNonIndexed();
        box.setIndex([...Array(box.attributes.position.count - 3).keys()]);
        box.attributes.position.setX(box.attributes.position.count - 1, 1e30);
        assert.equal(meshOfGeometry(echinus, box).faceCount, 11);
    });
    test('interleaved attributes are read', () => {
        const geometry = new BufferGeometry();
        const data = Float32Array.of(0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9);
        geometry.setAttribute('position', new InterleavedBufferAttribute(new InterleavedBuffer(data, 4), 3, 0));
        assert.deepEqual([...meshOfGeometry(echinus, geometry).vertices], [0, 0, 0, 1, 0, 0, 0, 1, 0]);
    });
    test('a mesh becomes a geometry with normals, and back', () => {
        const geometry = geometryOfMesh(torus);
        assert.equal(geometry.attributes.normal.count, torus.vertexCount);
        const back = meshOfGeometry(echinus, geometry);
        assert.deepEqual(back.vertices, torus.vertices);
        assert.deepEqual(back.faces, torus.faces);
    });
    test('the geometry of a cloth follows its simulation', () => {
        const simulation = echinus.parseScene({ model: { torus: {} }, cloth: { size: [2, 2], particles: [10, 10], position: [0, 0, 0.6] } }).makeSimulation(map);
        const geometry = new ClothGeometry(simulation);
        const { version } = geometry.attributes.position;
        const { z } = geometry.boundingSphere.center;
        simulation.step(10);
        geometry.update();
        assert.deepEqual(geometry.attributes.position.array, simulation.positions.slice());
        assert.ok(geometry.attributes.position.version > version);
        assert.ok(geometry.boundingSphere.center.z < z);
        assert.equal(geometry.index.count, simulation.faces.length);
        assert.deepEqual(geometry.clone().attributes.position.array, geometry.attributes.position.array);
    });
});
