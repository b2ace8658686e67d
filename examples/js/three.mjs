// A cloth falls on a knot of three.js: node three.mjs. three.html draws the same objects.
import { load } from 'echinus';
import { clothOnKnot } from './cloth_on_knot.mjs';

const STEPS = 60;

const echinus = await load();
const { cloth, model, step } = clothOnKnot(echinus);
for (let i = 0; i < STEPS; ++i) step();

// Decided exactly, from the geometry that three.js draws.
const { position } = cloth.geometry.attributes;
const pairs = echinus.makeMesh(position.array, cloth.geometry.index.array).intersectingPairs(model).length / 2;
console.log(`after ${STEPS} frames ${pairs} of ${cloth.geometry.index.count / 3} faces of the cloth meet a face of the knot`);
process.exitCode = pairs === 0 ? 0 : 1;
