// The cloth in Jolt, against a mesh shape of the model; with --echinus against Echinus instead.
import { MODELS, addCloth, makeWorld, positionsOf } from '../../../../examples/js/jolt_cloth.mjs';
import { FRICTION, GRAVITY, STEP_SECONDS, THICKNESS, cloth, engine, isMatched, model, record, stepsPerFrame, versionOf, withEchinus } from './runner.mjs';

const { default: initJolt } = await engine('jolt-physics');
const Jolt = await initJolt();
const settings = {};

const { jolt, bodies } = makeWorld(Jolt, GRAVITY, { doMeet: !withEchinus });
const body = addCloth(Jolt, bodies, cloth, {
    change(creation) {
        if (isMatched) creation.mNumIterations = 10;
        creation.mVertexRadius = withEchinus ? 0 : isMatched ? THICKNESS : creation.mVertexRadius;
        creation.mFriction = FRICTION;
        creation.mAllowSleeping = false;
        Object.assign(settings, { mNumIterations: `${creation.mNumIterations}`, mVertexRadius: `${creation.mVertexRadius.toFixed(3)}`, compliance: '1e-5 at vertices that weigh 1, as in its demo', mLinearDamping: `${creation.mLinearDamping.toFixed(2)}` });
    },
});
const correct = withEchinus ? await correctionOf(body) : () => {};
if (!withEchinus) addModel();

record(
    { engine: 'Jolt', version: versionOf('jolt-physics'), configuration: withEchinus ? 'with Echinus' : '', substeps: stepsPerFrame, settings },
    () => {
        jolt.Step(STEP_SECONDS, 1);
        correct();
    },
    () => positionsOf(Jolt, body),
);

async function correctionOf(softBody) {
    const { load } = await engine('echinus');
    const { JoltCollision } = await engine('echinus/jolt');
    const echinus = await load();
    const map = echinus.buildMap(echinus.makeMesh(model.vertices, model.faces));
    settings.thickness = String(THICKNESS);
    const collision = new JoltCollision(echinus, Jolt, softBody, { colliders: [{ map }], thickness: THICKNESS, friction: FRICTION });
    return () => collision.step(STEP_SECONDS);
}

function addModel() {
    const triangles = new Jolt.TriangleList();
    triangles.resize(model.faces.length / 3);
    for (let i = 0; i < model.faces.length; ++i) {
        const corner = triangles.at(Math.floor(i / 3)).get_mV(i % 3);
        [corner.x, corner.y, corner.z] = model.vertices.subarray(3 * model.faces[i], 3 * model.faces[i] + 3);
    }
    const shape = new Jolt.MeshShapeSettings(triangles, new Jolt.PhysicsMaterialList()).Create().Get();
    const creation = new Jolt.BodyCreationSettings(shape, new Jolt.RVec3(0, 0, 0), new Jolt.Quat(0, 0, 0, 1), Jolt.EMotionType_Static, MODELS);
    creation.mFriction = FRICTION;
    bodies.AddBody(bodies.CreateBody(creation).GetID(), Jolt.EActivation_DontActivate);
}
