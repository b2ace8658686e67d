// A cloth of Rapier falls on a torus that rises, kept out of it by Echinus: node rapier.mjs
import RAPIER from '@dimforge/rapier3d-compat';
import { load } from 'echinus';
import { RapierCollision } from 'echinus/rapier';

const SECONDS = 1 / 240, STEPS = 600, COLUMNS = 24, SIZE = 3;

await RAPIER.init();
const echinus = await load();
const mesh = echinus.makeTorus(1, 0.4, 60, 24);
const map = echinus.buildMap(mesh);

const world = new RAPIER.World({ x: 0, y: 0, z: -9.81 });
world.timestep = SECONDS;
const torus = world.createRigidBody(RAPIER.RigidBodyDesc.kinematicVelocityBased().setLinvel(0, 0, 0.2));
const edge = SIZE / (COLUMNS - 1);
const cloth = world.createSoftBody(RAPIER.SoftBodyDesc.cloth(
    { x: -SIZE / 2, y: -SIZE / 2, z: 0.6 }, { x: edge, y: 0, z: 0 }, { x: 0, y: edge, z: 0 }, COLUMNS, COLUMNS));

const collision = new RapierCollision(echinus, cloth, { colliders: [{ map, body: torus }], thickness: 0.03 });
for (let step = 0; step < STEPS; ++step) {
    world.step();
    collision.step(world.timestep);
}

// By brute force over all faces, where the torus is now.
const height = torus.translation().z;
const positions = cloth.particlePositions();
let inside = 0;
for (let i = 0; i < positions.length; i += 3)
    inside += mesh.windingNumber([positions[i], positions[i + 1], positions[i + 2] - height]) > 0.5;
console.log(`after ${STEPS} steps ${inside} of ${positions.length / 3} particles are inside the torus, ${height.toFixed(2)} above where it began`);
process.exitCode = inside === 0 ? 0 : 1;
