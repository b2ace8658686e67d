// Collision for particles that another solver moves; the solver is a line of the test.
import { describe, test } from 'node:test';
import assert from 'node:assert/strict';
import { errorOf, pseudoRandom, start } from './support.mjs';

const echinus = await start();
const torus = echinus.makeTorus(1, 0.4, 24, 12);
const map = echinus.buildMap(torus);
const SECONDS = 1 / 60;

/** Random places outside of the torus. */
function placesOutside(count) {
    const random = pseudoRandom(3);
    const places = [];
    while (places.length < 3 * count) {
        const place = [3 * random() - 1.5, 3 * random() - 1.5, 3 * random() - 1.5];
        if (!map.contains(place) && !map.contact(place, 0.05).found) places.push(...place);
    }
    return Float32Array.from(places);
}
const insideOf = (mesh, positions) => Array.from({ length: positions.length / 3 }, (_, i) => i)
    .filter((i) => mesh.windingNumber(positions.subarray(3 * i, 3 * i + 3)) > 0.5).length;

describe('A collision', () => {
    test('keeps particles outside that a solver throws about, and says which', () => {
        const positions = placesOutside(1000);
        const collision = echinus.makeCollision({ positions, colliders: [{ map }], thickness: 0.01 });
        const random = pseudoRandom(5);
        let correctedInAll = 0;
        for (let step = 0; step < 20; ++step) {
            collision.positions.forEach((c, i) => (collision.positions[i] = 0.9 * c + 0.8 * (random() - 0.5)));
            const sent = collision.positions.slice();
            const count = collision.correct(SECONDS);
            const { corrected } = collision;
            assert.equal(corrected.length, count);
            const moved = [...Array(1000).keys()].filter((i) => [0, 1, 2].some((k) => collision.positions[3 * i + k] !== sent[3 * i + k]));
            assert.deepEqual(moved, [...corrected]);
            assert.equal(insideOf(torus, collision.positions), 0);
            correctedInAll += count;
        }
        assert.ok(correctedInAll > 1000, `${correctedInAll} corrections`);
    });
    test('brakes by friction what slides, and not without it', () => {
        const floor = echinus.buildMap(echinus.makeBox([4, 4, 1]));
        const slide = (friction) => {
            const collision = echinus.makeCollision({ positions: [0, 0, 0.51], colliders: [{ map: floor }], thickness: 0.01, friction });
            collision.positions.set([0.01, 0, 0.5]);
            collision.correct(SECONDS);
            return collision.positions[0];
        };
        assert.ok(Math.abs(slide(0) - 0.01) < 1e-6);
        assert.ok(Math.abs(slide(0.5) - 0.005) < 1e-4);
        assert.ok(Math.abs(slide(2)) < 1e-6);
    });
    test('pushes particles before a model that comes, and takes them along', () => {
        const plate = echinus.buildMap(echinus.makeBox([2, 2, 0.1]));
        const collision = echinus.makeCollision({ positions: [0, 0, 0.5], colliders: [{ map: plate }], thickness: 0.01 });
        for (let step = 1; step <= 10; ++step) {
            collision.setColliderPose(0, [0, 0, 0.3 * step]); // past the particle within two steps
            collision.correct(SECONDS);
            assert.ok(collision.positions[2] > 0.3 * step + 0.05, `step ${step}: ${collision.positions[2]}`);
        }
        assert.ok(Math.abs(collision.velocities[2] - 0.3 / SECONDS) < 1, `${collision.velocities[2]}`);
    });
    test('turns a collider the shorter way, about its own place', () => {
        const plank = echinus.buildMap(echinus.makeBox([4, 0.1, 1]));
        const collision = echinus.makeCollision({ positions: [1, 0.3, 0], colliders: [{ map: plank }], thickness: 0.01 });
        const half = Math.PI / 8;
        collision.setColliderPose(0, [0, 0, 0], [Math.cos(half), 0, 0, Math.sin(half)]); // by 45 degrees
        collision.correct(SECONDS);
        const [x, y] = collision.positions;
        assert.ok(y > x, `(${x}, ${y}) is over the plank`);
    });
    test('has several colliders, scaled each', () => {
        const box = echinus.buildMap(echinus.makeBox([1, 1, 1]));
        const colliders = [{ map: box, position: [-3, 0, 0], scale: 2 }, { map: box, position: [3, 0, 0], scale: [1, 1, 4] }];
        const collision = echinus.makeCollision({ positions: [-3, 0, 2, 3, 0, 3], colliders, thickness: 0.01 });
        collision.positions.set([-3, 0, -2, 3, 0, -3]);
        assert.equal(collision.correct(SECONDS), 2);
        assert.ok(Math.abs(collision.positions[2] - 1.01) < 0.01 && Math.abs(collision.positions[5] - 2.01) < 0.01, `${collision.positions}`);
    });
    test('of surfaces lets no face meet a model, and without them one does', () => {
        const needle = echinus.makeBox([0.02, 0.02, 1]);
        const needleMap = echinus.buildMap(needle);
        const faces = [0, 1, 2];
        const fallen = (options) => {
            const collision = echinus.makeCollision({ positions: [-1, -1, 0.6, 1, -1, 0.6, 0, 1, 0.6], colliders: [{ map: needleMap }], thickness: 0.01, ...options });
            for (let step = 0; step < 20; ++step) {
                for (let i = 2; i < 9; i += 3) collision.positions[i] -= 0.02;
                collision.correct(SECONDS);
            }
            return [echinus.makeMesh(collision.positions.slice(), faces).intersectingPairs(needle).length / 2, collision.unresolvedCount];
        };
        assert.deepEqual(fallen({ faces, surfaces: true }), [0, 0]);
        assert.ok(fallen({})[0] > 0);
    });
    test('of surfaces keeps faces off each other, unless told otherwise', () => {
        const faces = [0, 1, 2, 3, 4, 5];
        const positions = [-1, -1, 5, 1, -1, 5, 0, 1, 5, 0, 0, 5.2, 0.1, 0, 5.4, 0, 0.1, 5.4];
        const pairsAfterFall = (options) => {
            const collision = echinus.makeCollision({ positions, faces, colliders: [{ map }], thickness: 0.05, surfaces: true, ...options });
            for (let step = 0; step < 20; ++step) {
                for (let i = 11; i < 18; i += 3) collision.positions[i] -= 0.02;
                collision.correct(SECONDS);
            }
            const [sheet, spike] = [collision.positions.slice(0, 9), collision.positions.slice(9)];
            return echinus.makeMesh(sheet, [0, 1, 2]).intersectingPairs(echinus.makeMesh(spike, [0, 1, 2])).length / 2;
        };
        assert.equal(pairsAfterFall({}), 0);
        assert.equal(pairsAfterFall({ selfCollision: false }), 1);
    });
    test('of surfaces keeps layers as far apart as selfThickness says, by default as the thickness', () => {
        const faces = [0, 1, 2, 3, 4, 5];
        const layer = (height) => [-1, -1, height, 1, -1, height, 0, 1, height];
        const gapAfter = (options) => {
            const collision = echinus.makeCollision({ positions: [...layer(5), ...layer(5.1)], faces, colliders: [{ map }], thickness: 0.05, surfaces: true, ...options });
            for (let step = 0; step < 20; ++step) collision.correct(SECONDS);
            return collision.positions[11] - collision.positions[2];
        };
        assert.ok(Math.abs(gapAfter({}) - 0.1) < 1e-3, `${gapAfter({})}`);
        assert.ok(gapAfter({ selfThickness: 0.3 }) > 0.2, `${gapAfter({ selfThickness: 0.3 })}`);
    });
    test('refuses what it cannot work with, in a sentence', () => {
        const good = { positions: [3, 0, 0], colliders: [{ map }], thickness: 0.01 };
        const refusal = (options) => errorOf(() => echinus.makeCollision({ ...good, ...options }));
        assert.match(refusal({ thicknes: 1 }).message, /'thicknes' is not an option of a collision/);
        assert.match(refusal({ colliders: [] }).message, /at least one collider/);
        assert.match(refusal({ colliders: [{ map: torus }] }).message, /a map is needed/);
        assert.match(refusal({ colliders: [{ map, body: {} }] }).message, /'body' is not a key of a collider/);
        assert.match(refusal({ colliders: [{ map, rotation: [0, 0, 0, 2] }] }).message, /a quaternion of length 2/);
        assert.match(refusal({ colliders: [{ map, scale: 0 }] }).message, /scale of 0/);
        assert.match(refusal({ thickness: undefined }).message, /thickness is undefined/);
        assert.match(refusal({ positions: [1, 2] }).message, /three numbers for each vertex/);
        assert.match(refusal({ positions: [] }).message, /no particles/);
        assert.match(refusal({ faces: [0, 1, 2], surfaces: true }).message, /refers to particle 1/);
        assert.match(refusal({ selfCollision: true }).message, /needs surfaces/);
        assert.match(refusal({ selfThickness: 0.1 }).message, /selfThickness needs surfaces/);
        assert.match(refusal({ selfThickness: -1 }).message, /selfThickness is -1/);
        assert.match(refusal({ selfThickness: 1e10, surfaces: true, faces: [0, 0, 0] }).message, /selfThickness/);
        assert.match(refusal({ friction: 1e10 }).message, /friction/);
        assert.match(refusal({ surfaces: true }).message, /give the faces/);
        const collision = echinus.makeCollision(good);
        assert.match(errorOf(() => collision.correct(0)).message, /0 seconds/);
        assert.equal(errorOf(() => collision.correct(1n)).code, 'InvalidArgument');
        assert.match(errorOf(() => collision.setColliderPose(1, [0, 0, 0])).message, /no collider 1; there is 1/);
        collision.delete();
        assert.equal(errorOf(() => collision.correct(SECONDS)).code, 'Deleted');
    });
    test('takes undefined for an option that is not given, and the positions of a simulation while memory grows', () => {
        const scene = echinus.parseScene({ model: { torus: {} }, cloth: { size: [2, 2], particles: [60, 60], position: [0, 0, 0.6] } });
        const simulation = scene.makeSimulation(map);
        const made = Array.from({ length: 120 }, () =>
            echinus.makeCollision({ positions: simulation.positions, faces: undefined, friction: undefined, colliders: [{ map, position: undefined }], thickness: 0.01 }));
        assert.deepEqual(made.at(-1).positions.slice(), simulation.positions.slice());
        for (const each of [...made, simulation, scene]) each.delete();
    });
    test('parts faces that intersect at the start, if it may', () => {
        const plate = echinus.buildMap(echinus.makeBox([2, 2, 0.1], 4));
        const given = { positions: [-0.3, -0.3, 0.03, 0.3, -0.3, 0.12, 0, 0.3, 0.12], faces: [0, 1, 2], colliders: [{ map: plate }], thickness: 0.01, surfaces: true };
        assert.match(errorOf(() => echinus.makeCollision(given)).message, /untangle/);
        const collision = echinus.makeCollision({ ...given, untangle: true });
        assert.ok(collision.positions[2] > 0.05);
    });
    test('outlives its map, and its views outlive growth of memory', () => {
        const own = echinus.buildMap(torus);
        const collision = echinus.makeCollision({ positions: [3, 0, 0], colliders: [{ map: own }], thickness: 0.01 });
        own.delete();
        echinus.makePoints(4_000_000).delete();
        collision.positions.set([1, 0, 0]);
        assert.equal(collision.correct(SECONDS), 1);
        assert.ok(collision.positions[0] > 1.4);
    });
});
