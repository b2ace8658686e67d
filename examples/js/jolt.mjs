// A cloth of Jolt falls on a torus that turns, and Echinus keeps it out: node jolt.mjs
import initJolt from 'jolt-physics';
import { load } from 'echinus';
import { JoltCollision } from 'echinus/jolt';
import { MODELS, addCloth, makeSheet, makeWorld, positionsOf } from './jolt_cloth.mjs';

const SECONDS = 1 / 240, STEPS = 1200;

const [echinus, Jolt] = await Promise.all([load(), initJolt()]);
const mesh = echinus.makeTorus(1, 0.4, 60, 24);
const map = echinus.buildMap(mesh);

// The layers of models and cloths do not meet in Jolt. The body's shape is for other bodies.
const { jolt, bodies } = makeWorld(Jolt, [0, 0, -9.81]);
const torus = bodies.CreateBody(new Jolt.BodyCreationSettings(
    new Jolt.SphereShape(0.1), new Jolt.RVec3(0, 0, 0), new Jolt.Quat(0, 0, 0, 1), Jolt.EMotionType_Kinematic, MODELS));
bodies.AddBody(torus.GetID(), Jolt.EActivation_Activate);
bodies.SetAngularVelocity(torus.GetID(), new Jolt.Vec3(0, 0, 0.5));
const cloth = addCloth(Jolt, bodies, makeSheet(24, 3), { position: [0, 0, 0.6] });

const collision = new JoltCollision(echinus, Jolt, cloth, { colliders: [{ map, body: torus }], thickness: 0.03 });
for (let step = 0; step < STEPS; ++step) {
    jolt.Step(SECONDS, 1);
    collision.step(SECONDS);
}

// By brute force over all faces, where the torus is now.
const angle = 0.5 * STEPS * SECONDS;
const positions = positionsOf(Jolt, cloth);
let inside = 0;
for (let i = 0; i < positions.length; i += 3) {
    const [x, y, z] = positions.subarray(i, i + 3);
    inside += mesh.windingNumber([Math.cos(angle) * x + Math.sin(angle) * y, Math.cos(angle) * y - Math.sin(angle) * x, z]) > 0.5;
}
console.log(`after ${STEPS} steps ${inside} of ${positions.length / 3} vertices are inside the torus`);
process.exitCode = inside === 0 ? 0 : 1;
