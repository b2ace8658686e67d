import { EchinusError, refuse } from './errors.mjs';
import { importsFor } from './imports.mjs';

const utf8 = new TextEncoder();
const fromUtf8 = new TextDecoder();

/** The text of a list of bytes. */
export const textOf = (bytes) => fromUtf8.decode(Uint8Array.from(bytes));

const OK = 0;
const OUT_OF_MEMORY = 101; // ECHINUS_OUT_OF_MEMORY
const outOfMemory = () => new EchinusError('OutOfMemory', "the module is out of memory; delete() objects that are no longer needed, or use a smaller model or map");

/** Of one number or struct. */
const bytesOf = (kind) => kind.bytes ?? Number(/\d+$/.exec(kind)[0]) / 8;

/**
 * The instance of the WebAssembly file: its exports, its memory, and its errors. Everything else builds on it.
 */
export class Core {
    #exports = null;
    #crash = null;
    #views = { bytes: [] };
    #scratch;

    /** A new instance of the compiled file. */
    static async start(compiled) {
        const core = new Core();
        const instance = await WebAssembly.instantiate(compiled, importsFor(compiled, () => core.memory));
        core.#exports = instance.exports;
        core.#exports._initialize();
        return core;
    }

    get memory() {
        return this.#exports.memory;
    }

    /**
     * Views of all memory. When memory grows, its old buffer is detached from its views, which are empty then, so they are
     * recreated. (To ask for the length of a view takes less time than for the buffer of the memory.)
     */
    get views() {
        if (this.#views.bytes.length === 0) {
            const { buffer } = this.memory;
            this.#views = {
                bytes: new Uint8Array(buffer),
                words: new Uint32Array(buffer),
                ints: new Int32Array(buffer),
                floats: new Float32Array(buffer),
                doubles: new Float64Array(buffer),
                data: new DataView(buffer),
            };
        }
        return this.#views;
    }

    /** Calls an export that cannot fail. */
    call(name, ...args) {
        if (this.#crash) throw this.#deadModule();
        try {
            return this.#exports[name](...args);
        } catch (error) {
            throw this.#afterTrap(error);
        }
    }

    #afterTrap(error) {
        if (error instanceof TypeError) refuse(`an argument is no number (${error.message})`); // before the module runs
        // A trap: a fault of the module, not of its arguments. Its memory may be corrupt.
        this.#crash = error;
        return this.#deadModule();
    }

    #deadModule() {
        return new EchinusError('Crashed', `the module has stopped (${this.#crash.message}); load() it again`, { cause: this.#crash });
    }

    /** Calls an export that returns a status. @throws EchinusError with the library's sentence */
    do(name, ...args) {
        if (this.#crash) throw this.#deadModule();
        let status;
        try {
            status = this.#exports[name](...args); // not through call(): queries of one point are short
        } catch (error) {
            throw this.#afterTrap(error);
        }
        if (status !== OK) throw this.#errorOf(status);
    }
    #errorOf(status) {
        if (status === OUT_OF_MEMORY) return outOfMemory();
        const code = this.textOf('echinus_status_name', status).replace(/^ECHINUS/, '').toLowerCase();
        return new EchinusError(code.replace(/_./g, (initial) => initial[1].toUpperCase()), this.textOf('echinus_last_error'));
    }

    /** Calls an export whose last arguments are the places for so many new objects. @returns their addresses */
    makeAll(count, name, ...args) {
        const places = Array.from({ length: count }, (_, i) => this.scratch + 4 * i);
        this.do(name, ...args, ...places);
        return places.map((place) => this.views.words[place >>> 2]);
    }
    make(name, ...args) {
        return this.makeAll(1, name, ...args)[0];
    }

    /** The text, ended by a zero, whose address an export returns. */
    textOf(name, ...args) {
        const start = this.call(name, ...args) >>> 0;
        const { bytes } = this.views;
        return fromUtf8.decode(bytes.slice(start, bytes.indexOf(0, start)));
    }

    // Memory of the module.

    /** For arguments and results of one call: whoever comes next may overwrite it. New objects are put to its beginning. */
    get scratch() {
        return (this.#scratch ??= this.take(128));
    }
    /** Vectors of three numbers in the scratch, without taking memory. @returns their addresses */
    vectorsAt(...vectors) {
        const first = this.scratch + 32;
        const { doubles } = this.views;
        return vectors.map((vector, i) => {
            const address = first + 24 * i;
            for (let k = 0; k < 3; ++k) doubles[(address >>> 3) + k] = vector[k];
            return address;
        });
    }

    /** @throws EchinusError OutOfMemory */
    take(byteCount) {
        if (!(byteCount <= 0xffffffff)) throw new EchinusError('OutOfMemory', `the module cannot have ${byteCount} bytes of memory; at most 4 GiB`);
        const address = this.call('memalign', 16, Math.max(byteCount, 1)) >>> 0; // whole vectors
        if (address === 0) throw outOfMemory();
        return address;
    }
    giveBack(address) {
        if (!this.#crash) this.call('free', address);
    }

    /** Calls `use` with the address of so many bytes. */
    withMemory(byteCount, use) {
        const address = this.take(byteCount);
        try {
            return use(address);
        } finally {
            this.giveBack(address);
        }
    }

    /** Calls `use` with the addresses of temporary copies of typed arrays. */
    withCopies(arrays, use) {
        // Views of the module's own memory would be empty once that grows.
        const lasting = arrays.map((array) => (array.buffer === this.memory.buffer ? array.slice() : array));
        const addresses = [];
        try {
            for (const array of lasting) addresses.push(this.take(array.byteLength));
            lasting.forEach((array, i) => this.views.bytes.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), addresses[i]));
            return use(...addresses);
        } finally {
            addresses.forEach((address) => this.giveBack(address));
        }
    }

    /** Calls `use` with the addresses of texts, which end with a zero. */
    withTexts(texts, use) {
        for (const text of texts) if (text.includes('\0')) refuse('a text must not have a character 0');
        return this.withCopies(texts.map((text) => utf8.encode(`${text}\0`)), use);
    }

    // Structs of structs.mjs.

    /** Calls `use` with the address of options: the given ones, and the defaults of the rest. @param init  fills them */
    withOptions(init, struct, given, use) {
        return this.withMemory(struct.bytes, (address) => {
            this.call(init, address, struct.bytes);
            this.write(struct, address, given);
            return use(address);
        });
    }

    /** Calls `use` with the address of a struct that has these members; the others are 0. */
    withStruct(struct, members, use) {
        return this.withMemory(struct.bytes, (address) => {
            this.views.bytes.fill(0, address, address + struct.bytes);
            this.write(struct, address, { ...(struct.members.size && { size: struct.bytes }), ...members });
            return use(address);
        });
    }

    /** The struct that an export fills, whose address is its last argument. */
    ask(struct, name, ...args) {
        return this.withStruct(struct, {}, (address) => {
            this.do(name, ...args, address);
            return this.read(struct, address);
        });
    }

    /** Integers of 64 bits become numbers where these can hold them. */
    read(struct, address) {
        const { data } = this.views;
        const one = (kind, place) => {
            if (typeof kind === 'object') return this.read(kind, place);
            const value = data[`get${kind}`](place, true);
            return Number.isSafeInteger(Number(value)) ? Number(value) : value;
        };
        const members = Object.entries(struct.members).filter(([name]) => name !== 'size');
        return Object.fromEntries(members.map(([name, [offset, kind, count]]) => {
            const at = (i) => one(kind, address + offset + i * bytesOf(kind));
            return [name, count ? Array.from({ length: count }, (_, i) => at(i)) : at(0)];
        }));
    }
    write(struct, address, values) {
        const { data } = this.views;
        const one = (kind, place, value) => {
            if (typeof kind === 'object') this.write(kind, place, value);
            else data[`set${kind}`](place, kind.startsWith('Big') ? BigInt(value) : Number(value), true);
        };
        for (const [name, value] of Object.entries(values)) {
            const [offset, kind, count] = struct.members[name];
            (count ? value : [value]).forEach((each, i) => one(kind, address + offset + i * bytesOf(kind), each));
        }
    }

    // Arrays of the library.

    /** A copy of an array as this kind; destroys the array. @param width  numbers of an element */
    copyArray(array, ArrayKind = Uint32Array, width = 1) {
        const first = this.call('echinus_array_data', array) >>> 0;
        const copy = new ArrayKind(this.memory.buffer, first, width * this.call('echinus_array_count', array)).slice();
        this.call('echinus_array_destroy', array);
        return copy;
    }
    /** Lists of numbers, which an export gives as one array, each behind its length. */
    lists(name, ...args) {
        const numbers = this.copyArray(this.make(name, ...args), Float64Array);
        const lists = [];
        for (let at = 0; at < numbers.length; at += 1 + numbers[at]) lists.push(Array.from(numbers.subarray(at + 1, at + 1 + numbers[at])));
        return lists;
    }

    // Copies of memory, independent of its growth.
    copyWords(address, count) {
        return this.views.words.slice(address >>> 2, (address >>> 2) + count);
    }
    copyFloats(address, count) {
        return this.views.floats.slice(address >>> 2, (address >>> 2) + count);
    }
    copyDoubles(address, count) {
        return Array.from(this.views.doubles.subarray(address >>> 3, (address >>> 3) + count));
    }
}

/** Frees the memory of objects that were garbage-collected without delete(). */
const forgotten = new FinalizationRegistry(({ core, destroyer, address }) => {
    try {
        core.call(destroyer, address);
    } catch {
        // The module has crashed: its memory is freed as a whole.
    }
});

/** An object of the library: its address, until it is deleted. */
export class Handle {
    #address;
    #destroyer;

    constructor(core, address, destroyer) {
        this.#address = address;
        this.#destroyer = destroyer;
        Object.defineProperty(this, 'core', { value: core });
        forgotten.register(this, { core, destroyer, address }, this);
    }

    /** @throws EchinusError Deleted */
    get address() {
        if (this.#address === 0) throw new EchinusError('Deleted', `this ${this.constructor.name} was deleted and cannot be used any more`);
        return this.#address;
    }

    get deleted() {
        return this.#address === 0;
    }

    delete() {
        if (this.#address === 0) return;
        const address = this.#address;
        this.#address = 0;
        forgotten.unregister(this);
        this.core.call(this.#destroyer, address);
    }
}
Handle.prototype[Symbol.dispose ?? Symbol.for('Symbol.dispose')] = Handle.prototype.delete;

/** @throws EchinusError unless the value is an object of this kind and of this module */
export function requireOwn(core, value, Kind) {
    if (!(value instanceof Kind)) refuse(`a ${Kind.name} is needed here`);
    if (value.core !== core) refuse(`this ${Kind.name} belongs to another instance of the module`);
    return value.address;
}
