// The cloth in Rapier, against a triangle mesh of the model; with --echinus against Echinus instead.
import { FRICTION, GRAVITY, STEP_SECONDS, THICKNESS, cloth, engine, inOrder, isMatched, model, orderOf, record, stepsPerFrame, versionOf, withEchinus } from './runner.mjs';

const { default: RAPIER } = await engine('@dimforge/rapier3d-compat');
await RAPIER.init();
const settings = {};

const world = new RAPIER.World({ x: GRAVITY[0], y: GRAVITY[1], z: GRAVITY[2] });
world.timestep = STEP_SECONDS;
if (isMatched) world.numSolverIterations = 10;
settings.numSolverIterations = String(world.numSolverIterations);
const body = world.createSoftBody(describeCloth());
const order = orderOf(body.particlePositions());
const correct = withEchinus ? await correctionOf(body) : () => {};
if (!withEchinus) world.createCollider(RAPIER.ColliderDesc.trimesh(model.vertices, model.faces).setFriction(FRICTION));

record(
    { engine: 'Rapier', version: versionOf('@dimforge/rapier3d-compat'), configuration: withEchinus ? 'with Echinus' : '', substeps: stepsPerFrame, settings },
    () => {
        world.step();
        correct();
    },
    () => inOrder(body.particlePositions(), order),
);

function describeCloth() {
    const columns = Math.round(Math.sqrt(cloth.vertices.length / 3));
    const [x, y, z] = [0, 1, 2].map((k) => cloth.vertices.reduce((least, c, i) => (i % 3 === k ? Math.min(least, c) : least), Infinity));
    const edge = (-2 * x) / (columns - 1);
    const description = RAPIER.SoftBodyDesc.cloth({ x, y, z }, { x: edge, y: 0, z: 0 }, { x: 0, y: 0, z: edge }, columns, columns).setMass(1);
    if (isMatched) description.setParticleRadius(THICKNESS);
    settings.particleRadius = isMatched ? String(THICKNESS) : 'as SoftBodyDesc.cloth() chooses';
    settings.material = 'as SoftBodyDesc.cloth() chooses';
    return description;
}

async function correctionOf(softBody) {
    const { load } = await engine('echinus');
    const { RapierCollision } = await engine('echinus/rapier');
    const echinus = await load();
    const map = echinus.buildMap(echinus.makeMesh(model.vertices, model.faces));
    settings.thickness = String(THICKNESS);
    const collision = new RapierCollision(echinus, softBody, { colliders: [{ map }], thickness: THICKNESS, friction: FRICTION });
    return () => collision.step(world.timestep);
}
