// The same bits as the scalar reference of native C++, written by tests/wasm/reference.cpp.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { module, referenceFolder, start } from './support.mjs';

const read = (name) => readFileSync(join(referenceFolder, name));
const floatsOf = (bytes) => new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
const wordsOf = (bytes) => new Uint32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
const reference = JSON.parse(read('reference.json'));
const instructionSets = ['wasm', 'scalar'];

/** The first place where two arrays of bytes differ, for a readable message. */
function assertSameBytes(actual, expected, what, bytesPerItem = 1) {
    assert.equal(actual.length, expected.length, `${what}: length`);
    if (Buffer.compare(actual, expected) === 0) return;
    const place = actual.findIndex((byte, i) => byte !== expected[i]);
    assert.fail(`${what}: byte ${place}, of item ${Math.floor(place / bytesPerItem)}, is ${actual[place]} and not ${expected[place]}`);
}

/** Contacts with zeros where the compiler leaves a gap. */
function contactBytes(contacts) {
    const bytes = contacts.bytes.slice();
    for (let end = 35; end < bytes.length; end += 36) bytes[end] = 0;
    return bytes;
}

function assertSameContact(contact, expected, i, what) {
    const floats = new Float32Array(expected.buffer.slice(expected.byteOffset + 36 * i, expected.byteOffset + 36 * i + 28));
    const bits = (numbers) => Buffer.from(Float32Array.from(numbers).buffer).toString('hex');
    assert.equal(bits([...contact.point, ...contact.normal, contact.depth]), bits(floats), `${what}: contact ${i}`);
    assert.equal(contact.face, expected.readInt32LE(36 * i + 28), `${what}: face of contact ${i}`);
    assert.equal(contact.inside, expected[36 * i + 32] !== 0, `${what}: inside of contact ${i}`);
    assert.equal(contact.certain, expected[36 * i + 33] !== 0, `${what}: certainty of contact ${i}`);
}

for (const subject of reference.subjects) {
    describe(`Of ${subject.name} the module has the reference's bits`, () => {
        let echinus, mesh, points, coordinates;
        before(async () => {
            echinus = await start();
            mesh = echinus.makeMesh(floatsOf(read(`${subject.name}.vertices`)), wordsOf(read(`${subject.name}.faces`)));
            coordinates = floatsOf(read(`${subject.name}.particles`));
            points = echinus.makePoints(coordinates.length / 3);
            points.view.set(coordinates);
        });

        for (const { name, options, margin } of subject.maps) {
            describe(`with the map ${options}`, () => {
                const file = read(`${name}.ech`), inside = read(`${name}.inside`), contacts = read(`${name}.contacts`);
                let map;
                before(() => { map = echinus.buildMap(mesh, options); });
                after(() => map.delete());

                test('in the map file', () => assertSameBytes(map.save(), file, name));
                for (const set of instructionSets) {
                    test(`in contains_batch by ${set}`, () => {
                        echinus.instructionSet = set;
                        assertSameBytes(map.containsBatch(points, echinus.makeFlags(points.length)).view, inside, name);
                    });
                    test(`in contacts_batch by ${set}`, () => {
                        echinus.instructionSet = set;
                        const answers = map.contactsBatch(points, margin, echinus.makeContacts(points.length));
                        assertSameBytes(contactBytes(answers), contacts, name, 36);
                    });
                }
                test('one by one', () => {
                    for (let i = 0; i < points.length; ++i) {
                        const point = coordinates.subarray(3 * i, 3 * i + 3);
                        assert.equal(map.contains(point), inside[i] !== 0, `${name}: particle ${i}`);
                        assertSameContact(map.contact(point, margin), contacts, i, name);
                    }
                });
                test("in what a map loaded from the reference's file answers", () => {
                    echinus.instructionSet = 'wasm';
                    const loaded = echinus.loadMap(file, name);
                    assertSameBytes(loaded.save(), file, name);
                    const answers = loaded.contactsBatch(points, margin, echinus.makeContacts(points.length));
                    assertSameBytes(contactBytes(answers), contacts, name, 36);
                    loaded.delete();
                });
            });
        }
    });
}

describe('A simulation has the state of the reference, bit for bit', () => {
    for (const { scene, growth, frames, hash, ...counts } of reference.simulations) {
        const { model, cloth, ...rest } = scene;
        for (const set of instructionSets)
            test(`${JSON.stringify(rest)}${growth ? ' with a model that grows' : ''} after ${frames} frames by ${set}`, async () => {
                const echinus = await start();
                echinus.instructionSet = set;
                const parsed = echinus.parseScene(scene);
                const mesh = parsed.makeModel();
                const simulation = parsed.makeSimulation(parsed.buildMap(mesh));
                const { vertices } = mesh;
                for (let frame = 1; frame <= frames; ++frame) {
                    if (growth) simulation.setColliderVertices(vertices.map((part) => part * (1 + growth * frame)));
                    simulation.step();
                }
                assert.equal(simulation.stateHash, hash);
                const { queryCount, contactCount, lostCount } = simulation.profile;
                assert.deepEqual({ queryCount, contactCount, lostCount }, counts);
                assert.ok(simulation instanceof module.Simulation);
            });
    }
});
