import { ContactBuffer, FlagBuffer, readContact, requireWithin, withPoints } from './buffers.mjs';
import { Handle, requireOwn } from './core.mjs';
import { refuse, requirePoint } from './errors.mjs';
import { Mesh, asBytes } from './mesh.mjs';

/** The queries of both kinds of map. */
class Map extends Handle {
    #description = null;

    constructor(core, address) {
        super(core, address, 'map_delete');
    }

    /** Statistics and layout, which never change. */
    get description() {
        this.#description ??= Object.freeze(this.core.json('map_describe', this.address));
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
        return this.core.call('map_contains', this.address, ...requirePoint(point, 'the point')) !== 0;
    }

    contact(point, margin = 0) {
        requirePoint(point, 'the point');
        return withResult(this.core, (result) => {
            this.core.call('map_contact', this.address, ...point, margin, result);
            return readContact(this.core, result);
        });
    }

    containsBatch(points, inside, count) {
        const flags = requireOwn(this.core, inside, FlagBuffer);
        return withPoints(this.core, points, count, (address, wanted) => {
            requireWithin(wanted, inside.length, 'answers');
            this.core.call('map_contains_batch', this.address, address, wanted, flags);
            return inside;
        });
    }

    contactsBatch(points, margin, contacts, count) {
        const results = requireOwn(this.core, contacts, ContactBuffer);
        return withPoints(this.core, points, count, (address, wanted) => {
            requireWithin(wanted, contacts.length, 'contacts');
            this.core.call('map_contacts_batch', this.address, address, wanted, margin, results);
            return contacts;
        });
    }

    ray(direction) {
        return this.core.json('map_ray', this.address, ...requirePoint(direction, 'the direction'));
    }

    /** A Mesh, owned by the caller, and a number for each of its faces. */
    surfaceAndClasses() {
        const surface = this.core.try('map_surface', this.address);
        try {
            const mesh = new Mesh(this.core, this.core.try('surface_mesh', surface));
            return [mesh, this.core.copyWords(this.core.call('surface_classes', surface), mesh.faceCount)];
        } finally {
            this.core.call('surface_delete', surface);
        }
    }

    save() {
        const bytes = this.core.try('map_serialise', this.address);
        try {
            const first = this.core.call('bytes_first', bytes) >>> 0;
            return this.core.views.bytes.slice(first, first + this.core.call('bytes_size', bytes));
        } finally {
            this.core.call('bytes_delete', bytes);
        }
    }
}

export class DistanceMap extends Map {
    surface() {
        const [mesh, layers] = this.surfaceAndClasses();
        return { mesh, layers };
    }
    usableSampleCount(point) {
        return this.core.call('map_usable_sample_count', this.address, ...requirePoint(point, 'the point'));
    }
}

export class ExactMap extends Map {
    surface() {
        const [mesh, longestLists] = this.surfaceAndClasses();
        return { mesh, longestLists };
    }

    classify(point) {
        const bits = this.core.call('map_classify', this.address, ...requirePoint(point, 'the point'));
        return { inside: (bits & 1) !== 0, certain: (bits & 2) !== 0 };
    }

    sweep(from, to) {
        requirePoint(from, 'the beginning of the way');
        requirePoint(to, 'the end of the way');
        return withResult(this.core, (result) => {
            this.core.call('map_sweep', this.address, ...from, ...to, result);
            const { floats, ints, bytes } = this.core.views;
            const f = result >>> 2;
            const face = ints[f + 7];
            return {
                fraction: floats[f],
                point: Array.from(floats.subarray(f + 1, f + 4)),
                normal: Array.from(floats.subarray(f + 4, f + 7)),
                face,
                entering: bytes[result + 32] !== 0,
                found: face !== -1,
            };
        });
    }

    cells() {
        const arrays = this.core.try('map_cells', this.address);
        try {
            const numbers = (which) => this.core.copyWords(
                this.core.call('arrays_numbers', arrays, which), this.core.call('arrays_number_count', arrays, which));
            return {
                bandCounts: numbers(0),
                faceCounts: numbers(1),
                corners: this.core.copyFloats(this.core.call('arrays_floats', arrays, 0), this.core.call('arrays_float_count', arrays, 0)),
            };
        } finally {
            this.core.call('arrays_delete', arrays);
        }
    }
}

/** Memory for one answer. */
function withResult(core, use) {
    const result = core.take(ContactBuffer.BYTES);
    try {
        return use(result);
    } finally {
        core.giveBack(result);
    }
}

/** The map at an address, as an object of its kind. */
export function wrapMap(core, address) {
    return core.call('map_is_exact', address) ? new ExactMap(core, address) : new DistanceMap(core, address);
}

export function buildMap(core, mesh, options) {
    const meshAddress = requireOwn(core, mesh, Mesh);
    return core.withTexts([asJson(options)], (text, size) => wrapMap(core, core.try('map_build', meshAddress, text, size)));
}

export function loadMap(core, bytes, name) {
    const data = asBytes(bytes);
    return core.withTexts([name], (n, size) =>
        core.withCopies([data], (b) => wrapMap(core, core.try('map_load', b, data.length, n, size))));
}

export function requireMap(core, map) {
    if (!(map instanceof Map)) refuse('a map is needed here');
    return requireOwn(core, map, Map);
}

/** Options as a JSON text; a text stays unchanged. */
export function asJson(value) {
    return typeof value === 'string' ? value : (JSON.stringify(value) ?? refuse('options must be an object or a JSON text'));
}
