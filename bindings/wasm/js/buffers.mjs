import { Handle, requireOwn } from './core.mjs';
import { EchinusError, refuse, requireCount } from './errors.mjs';
import { contact } from './structs.mjs';

/**
 * Module memory that JavaScript reads and writes through typed arrays, so that queries copy nothing.
 *
 * A view lasts until memory grows, which any call may cause: keep the buffer, and get its view each time, at the cost
 * of a comparison.
 */
class Buffer extends Handle {
    #view = null;

    constructor(core, length, bytesPerItem) {
        requireCount(length, 'the length of a buffer');
        super(core, core.take(length * bytesPerItem), 'free');
        Object.defineProperty(this, 'length', { value: length, enumerable: true });
    }

    /** A view of the whole buffer as this kind of array; recreated only when necessary. */
    viewAs(ArrayKind, byteCount) {
        const address = this.address;
        if (this.#view?.buffer !== this.core.memory.buffer)
            this.#view = new ArrayKind(this.core.memory.buffer, address, byteCount / ArrayKind.BYTES_PER_ELEMENT);
        return this.#view;
    }
}

/** Positions: x, y, z of each particle in turn. */
export class PointBuffer extends Buffer {
    constructor(core, length) {
        super(core, length, 12);
    }
    get view() {
        return this.viewAs(Float32Array, 12 * this.length);
    }
}

/** A number from 0 to 255 for each particle. */
export class FlagBuffer extends Buffer {
    constructor(core, length) {
        super(core, length, 1);
    }
    get view() {
        return this.viewAs(Uint8Array, this.length);
    }
}

const FEATURES = ['unknown', 'face', 'edge', 'vertex'];

/** A contact at an address. */
export function readContact(core, address) {
    const { floats, ints, bytes } = core.views;
    const f = address >>> 2;
    const inside = bytes[address + ContactBuffer.INSIDE] !== 0;
    const normal = Array.from(floats.subarray(f + ContactBuffer.NORMAL, f + ContactBuffer.NORMAL + 3));
    return {
        point: Array.from(floats.subarray(f + ContactBuffer.POINT, f + ContactBuffer.POINT + 3)),
        normal,
        depth: floats[f + ContactBuffer.DEPTH],
        face: ints[f + ContactBuffer.FACE],
        inside,
        certain: bytes[address + ContactBuffer.CERTAIN] !== 0,
        feature: FEATURES[bytes[address + ContactBuffer.FEATURE]],
        found: inside || normal.some((c) => c !== 0),
    };
}

/** Contacts. `at(i)` reads one; to read one field of all, stride through floats, ints or bytes. */
export class ContactBuffer extends Buffer {
    #ints = null;
    #bytes = null;

    constructor(core, length) {
        super(core, length, ContactBuffer.BYTES);
    }
    get floats() {
        return this.viewAs(Float32Array, ContactBuffer.BYTES * this.length);
    }
    get ints() {
        const { buffer } = this.floats;
        if (this.#ints?.buffer !== buffer) this.#ints = new Int32Array(buffer, this.address, ContactBuffer.STRIDE * this.length);
        return this.#ints;
    }
    get bytes() {
        const { buffer } = this.floats;
        if (this.#bytes?.buffer !== buffer) this.#bytes = new Uint8Array(buffer, this.address, ContactBuffer.BYTES * this.length);
        return this.#bytes;
    }
    at(index) {
        if (!(Number.isInteger(index) && index >= 0 && index < this.length)) refuse(`there is no contact ${String(index)}; there ${this.length === 1 ? 'is' : 'are'} ${this.length}`);
        return readContact(this.core, this.address + ContactBuffer.BYTES * index);
    }
}
ContactBuffer.BYTES = contact.bytes;
ContactBuffer.STRIDE = contact.bytes / 4; // in floats and ints
for (const [member, [offset, kind]] of Object.entries(contact.members)) ContactBuffer[member.toUpperCase()] = kind === 'Uint8' ? offset : offset / 4;

/**
 * The address of points for a batch, without a copy where they are a PointBuffer.
 * @param use  called with address and count
 */
export function withPoints(core, points, count, use) {
    if (points instanceof PointBuffer) {
        const address = requireOwn(core, points, PointBuffer);
        return use(address, requireWithin(count ?? points.length, points.length, 'points'));
    }
    if (!(points instanceof Float32Array) || points.length % 3 !== 0)
        refuse('points must be a PointBuffer, or a Float32Array of three numbers for each point');
    const wanted = requireWithin(count ?? points.length / 3, points.length / 3, 'points');
    return core.withCopies([points.subarray(0, 3 * wanted)], (address) => use(address, wanted));
}

/** @throws EchinusError unless a batch of this size fits */
export function requireWithin(count, available, what) {
    requireCount(count, `the number of ${what}`);
    if (count > available) throw new EchinusError('InvalidArgument', `${count} ${what} are wanted, but there is room for ${available}`);
    return count;
}
