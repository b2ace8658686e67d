// The cloth in Echinus itself, as WebAssembly: surfaces collide, or with --particles only particles.
import { FRAME_SECONDS, FRICTION, GRAVITY, THICKNESS, cloth, engine, isMatched, model, particlesOnly, record, versionOf } from './runner.mjs';

const { load } = await engine('echinus');
const echinus = await load();

const substeps = isMatched || !particlesOnly ? 1 : 4; // the time steps of a scene unless it says otherwise
const map = echinus.buildMap(echinus.makeMesh(model.vertices, model.faces));
const scene = echinus.parseScene({
    model: 'model.obj',
    cloth: { mesh: 'cloth.obj', ...(isMatched && { thickness: THICKNESS }) },
    material: { friction: FRICTION },
    gravity: GRAVITY,
    time_step: FRAME_SECONDS / substeps,
    ...(particlesOnly && { solver: 'jakobsen' }),
});
const simulation = scene.makeSimulation(map, { cloth: echinus.makeMesh(cloth.vertices, cloth.faces) });

record(
    {
        engine: 'Echinus', version: versionOf('echinus'), configuration: particlesOnly ? 'particles only' : '', substeps,
        settings: { solver: particlesOnly ? 'jakobsen' : 'newton', thickness: isMatched ? String(THICKNESS) : 'half an edge' },
    },
    () => simulation.step(substeps),
    () => simulation.positions,
);
