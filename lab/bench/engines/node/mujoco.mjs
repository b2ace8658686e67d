// The cloth as a flex of MuJoCo, against the distance field that it makes of the model; as a mesh the model would be its
// convex hull.
import { FRAME_SECONDS, FRICTION, GRAVITY, THICKNESS, cloth, engine, inOrder, isMatched, model, orderOf, record, versionOf } from './runner.mjs';

const { default: loadMujoco } = await engine('@mujoco/mujoco');
const mujoco = await loadMujoco();

const substeps = isMatched ? 1 : 8; // about the two milliseconds that MuJoCo's own models of cloth have
const iterations = isMatched ? 10 : 50;
const radius = isMatched ? THICKNESS : 0.005;
const words = (numbers) => Array.from(numbers, (c) => String(c)).join(' ');

const description = mujoco.MjModel.from_xml_string(`
<mujoco>
    <option timestep="${FRAME_SECONDS / substeps}" gravity="${words(GRAVITY)}" solver="CG" tolerance="1e-6" iterations="${iterations}" integrator="implicitfast"/>
    <size memory="400M"/>
    <asset><mesh name="model" vertex="${words(model.vertices)}" face="${words(model.faces)}"/></asset>
    <worldbody>
        <geom type="sdf" mesh="model" friction="${FRICTION}"/>
        <flexcomp name="cloth" type="direct" dim="2" mass="1" radius="${radius}" point="${words(cloth.vertices)}" element="${words(cloth.faces)}">
            <edge equality="true" damping="0.001"/>
            <contact selfcollide="none" internal="false" friction="${FRICTION}"/>
        </flexcomp>
    </worldbody>
</mujoco>`);
const state = new mujoco.MjData(description);
mujoco.mj_forward(description, state);
const order = orderOf(Float32Array.from(state.flexvert_xpos));

record(
    {
        engine: 'MuJoCo', version: versionOf('@mujoco/mujoco'), configuration: '', substeps,
        settings: { solver: 'CG', iterations: String(iterations), radius: String(radius), edges: 'equality constraints', collider: 'sdf of the mesh' },
    },
    () => {
        for (let i = 0; i < substeps; ++i) mujoco.mj_step(description, state);
    },
    () => inOrder(Float32Array.from(state.flexvert_xpos), order),
);
