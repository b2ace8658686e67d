import { ContactBuffer, FlagBuffer, readContact, requireWithin, withPoints } from './buffers.mjs';
import { Handle, requireOwn } from './core.mjs';
import { refuse, requirePoint } from './errors.mjs';
import { Mesh, asBytes } from './mesh.mjs';
import { distanceMapStatistics, exactMapStatistics, mapInfo, sweepHit, words } from './structs.mjs';

/** The queries of both kinds of map. */
class Map extends Handle {
    #description = null;

    constructor(core, address) {
        super(core, address, 'echinus_map_destroy');
    }

    /** Statistics and layout, which never change. */
    get description() {
        this.#description ??= Object.freeze(describe(this.core, this.address));
        return this.#description;
    }
    get kind() {
        return this.description.kind;
    }
    get byteCount() {
        return this.description.byteCount;
    }
    get origin() {
        return this.description.origin;
    }
    get centre() {
        return this.description.centre;
    }
    get radius() {
        return this.description.radius;
    }

    contains(point) {
        const { core } = this;
        const place = writePoints(core, requirePoint(point, 'the point'));
        core.do('echinus_map_contains', this.address, place, 1, 0, 1, place + RESULT);
        return core.views.bytes[place + RESULT] !== 0;
    }

    contact(point, margin = 0) {
        const { core } = this;
        const place = writePoints(core, requirePoint(point, 'the point'));
        core.do('echinus_map_contacts', this.address, place, 1, 0, margin, 1, place + RESULT);
        return readContact(core, place + RESULT);
    }

    containsBatch(points, inside, count) {
        const flags = requireOwn(this.core, inside, FlagBuffer);
        return withPoints(this.core, points, count, (address, wanted) => {
            requireWithin(wanted, inside.length, 'answers');
            this.core.do('echinus_map_contains', this.address, address, wanted, 0, 1, flags);
            return inside;
        });
    }

    contactsBatch(points, margin, contacts, count) {
        const results = requireOwn(this.core, contacts, ContactBuffer);
        return withPoints(this.core, points, count, (address, wanted) => {
            requireWithin(wanted, contacts.length, 'contacts');
            this.core.do('echinus_map_contacts', this.address, address, wanted, 0, margin, 1, results);
            return contacts;
        });
    }

    /** Lists about a ray, in the order of src/looking.cpp. */
    lookAlong(direction) {
        const lists = this.core.lists('wasm_map_ray', this.address, ...requirePoint(direction, 'the direction'));
        const intervals = records(lists.pop(), 'from', 'to', 'inside', 'certain');
        return [...lists, intervals.map(({ inside, certain, ...rest }) => ({ ...rest, inside: inside !== 0, certain: certain !== 0 }))];
    }

    /** A Mesh, owned by the caller, and a number for each of its faces. */
    surfaceAndClasses() {
        const [mesh, classes] = this.core.makeAll(2, 'echinus_map_surface', this.address);
        return [new Mesh(this.core, mesh), this.core.copyArray(classes)];
    }

    save() {
        return this.core.copyArray(this.core.make('echinus_map_serialise', this.address), Uint8Array);
    }
}

export class DistanceMap extends Map {
    surface() {
        const [mesh, layers] = this.surfaceAndClasses();
        return { mesh, layers };
    }
    ray(direction) {
        const [samples, sampleEntryCounts, used, crossings, intervals] = this.lookAlong(direction);
        return { samples, sampleEntryCounts, samplesUsed: used.map(Boolean), crossings, intervals };
    }
    usableSampleCount(point) {
        return this.core.call('wasm_map_usable_sample_count', this.address, ...requirePoint(point, 'the point'));
    }
}

export class ExactMap extends Map {
    surface() {
        const [mesh, longestLists] = this.surfaceAndClasses();
        return { mesh, longestLists };
    }

    ray(direction) {
        const [[cell], corners, bands, crossings, intervals] = this.lookAlong(direction);
        return {
            cell,
            cellCorners: [0, 3, 6].map((i) => corners.slice(i, i + 3)),
            bands: records(bands, 'from', 'to', 'faceCount', 'windingBelow').map(({ windingBelow, ...band }) => ({ ...band, windingBelow: Number.isNaN(windingBelow) ? null : windingBelow })),
            crossings,
            intervals,
        };
    }

    classify(point) {
        const { core } = this;
        const place = writePoints(core, requirePoint(point, 'the point'));
        core.do('echinus_map_classify', this.address, place, 1, 0, 1, place + RESULT, place + RESULT + 1);
        const { bytes } = core.views;
        return { inside: bytes[place + RESULT] !== 0, certain: bytes[place + RESULT + 1] !== 0 };
    }

    sweep(from, to) {
        const { core } = this;
        const place = writePoints(core, requirePoint(from, 'the beginning of the way'), requirePoint(to, 'the end of the way'));
        core.do('echinus_map_sweep', this.address, place, 0, place + POINT, 0, 1, 1, place + RESULT);
        const { floats, ints, bytes } = core.views;
        const f = (place + RESULT) >>> 2;
        const face = ints[f + HIT.face / 4];
        return {
            fraction: floats[f + HIT.fraction / 4],
            point: Array.from(floats.subarray(f + HIT.point / 4, f + HIT.point / 4 + 3)),
            normal: Array.from(floats.subarray(f + HIT.normal / 4, f + HIT.normal / 4 + 3)),
            face,
            entering: bytes[place + RESULT + HIT.entering] !== 0,
            found: face !== -1,
        };
    }

    cells() {
        const [bands, faces, corners] = this.core.makeAll(3, 'wasm_map_cells', this.address);
        return { bandCounts: this.core.copyArray(bands), faceCounts: this.core.copyArray(faces), corners: this.core.copyArray(corners, Float32Array) };
    }
}

// One point or two, and the answer about them, in the scratch of a core.
const POINT = 12;
const RESULT = 24;

/** Where the members of a hit lie. */
const HIT = Object.fromEntries(Object.entries(sweepHit.members).map(([name, [offset]]) => [name, offset]));

/** @returns the address of a point or two, behind which is room for the answer */
function writePoints(core, first, second) {
    const place = core.scratch;
    const { floats } = core.views;
    for (let k = 0; k < 3; ++k) {
        floats[(place >>> 2) + k] = first[k];
        if (second) floats[((place + POINT) >>> 2) + k] = second[k];
    }
    return place;
}

const KINDS = [undefined, 'exact', 'distance'];

/** Objects with these members from their values, one after the other. */
const records = (values, ...names) =>
    Array.from({ length: values.length / names.length }, (_, i) => Object.fromEntries(names.map((name, k) => [name, values[i * names.length + k]])));

function exactLayout([numbers]) {
    const [divisions, rule, closed, cellCount, bandCount, referenceCount] = numbers;
    return { divisions, rule: words.rule[rule], closed: closed !== 0, cellCount, bandCount, referenceCount };
}
function distanceLayout([numbers, entryHistogram]) {
    const [grid, longitudeCount, colatitudeCount, divisions, pole, entry, correction, centreInside, directionCount, entryCount] = numbers;
    const choices = { grid: words.grid[grid], poleAxis: words.pole[pole], entryFormat: words.entry[entry], correction: words.correction[correction] };
    return { ...choices, longitudeCount, colatitudeCount, divisions, centreInside: centreInside !== 0, directionCount, entryCount, entryHistogram };
}

function describe(core, address) {
    const { kind, sourceHash, ...info } = core.ask(mapInfo, 'echinus_map_describe', address);
    const layout = core.lists('wasm_map_layout', address);
    const details = KINDS[kind] === 'exact'
        ? { ...core.ask(exactMapStatistics, 'echinus_map_exact_statistics', address), ...exactLayout(layout) }
        : { ...core.ask(distanceMapStatistics, 'echinus_map_distance_statistics', address), ...distanceLayout(layout) };
    return { kind: KINDS[kind], ...info, sourceHash: BigInt(sourceHash).toString(16).padStart(16, '0'), ...details };
}

/** The map at an address, as an object of its kind. */
export function wrapMap(core, address) {
    return KINDS[core.ask(mapInfo, 'echinus_map_describe', address).kind] === 'exact' ? new ExactMap(core, address) : new DistanceMap(core, address);
}

export function buildMap(core, mesh, options) {
    const meshAddress = requireOwn(core, mesh, Mesh);
    return core.withTexts([asJson(options)], (text) => wrapMap(core, core.make('wasm_map_build', meshAddress, text)));
}

export function loadMap(core, bytes, name) {
    const data = asBytes(bytes);
    return core.withTexts([name], (n) => {
        const own = core.take(data.length); // of the map, which reads it in place
        try {
            core.views.bytes.set(data, own);
            return wrapMap(core, core.make('echinus_map_view', own, data.length, core.call('wasm_free'), own, n));
        } catch (error) {
            core.giveBack(own);
            throw error;
        }
    });
}

export function requireMap(core, map) {
    if (!(map instanceof Map)) refuse('a map is needed here');
    return requireOwn(core, map, Map);
}

/** Options as a JSON text; a text stays unchanged. */
export function asJson(value) {
    return typeof value === 'string' ? value : (JSON.stringify(value) ?? refuse('options must be an object or a JSON text'));
}
