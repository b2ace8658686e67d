import { EchinusError, refuse } from './errors.mjs';
import { importsFor } from './imports.mjs';

const utf8 = new TextEncoder();
const fromUtf8 = new TextDecoder();

/**
 * The instance of the WebAssembly file: its exports, its memory, and its errors. Everything else builds on it.
 */
export class Core {
    #exports = null;
    #crash = null;
    #views = { buffer: null };

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
     * Views of all memory. When memory grows, its old buffer is detached from its views, so they are recreated; a view
     * kept across such a call is empty afterwards.
     */
    get views() {
        const buffer = this.memory.buffer;
        if (this.#views.buffer !== buffer)
            this.#views = {
                buffer,
                bytes: new Uint8Array(buffer),
                words: new Uint32Array(buffer),
                ints: new Int32Array(buffer),
                floats: new Float32Array(buffer),
            };
        return this.#views;
    }

    /** Calls an export that cannot fail. */
    call(name, ...args) {
        if (this.#crash) throw this.#deadModule();
        try {
            return this.#exports[name](...args);
        } catch (error) {
            if (error instanceof TypeError) refuse(`an argument is no number (${error.message})`); // before the module runs
            // A trap: a fault of the module, not of its arguments. Its memory may be corrupt.
            this.#crash = error;
            throw this.#deadModule();
        }
    }

    #deadModule() {
        return new EchinusError('Crashed', `the module has stopped (${this.#crash.message}); load() it again`, { cause: this.#crash });
    }

    /** Calls an export that returns 0 when it fails. @throws EchinusError with the library's sentence */
    try(name, ...args) {
        const result = this.call(name, ...args);
        if (result === 0) throw new EchinusError(this.#textAt(this.call('last_error_code')), this.#textAt(this.call('last_error_sentence')));
        return result >>> 0; // addresses beyond 2^31 arrive as negative numbers
    }

    #textAt(address) {
        const { bytes } = this.views;
        const start = address >>> 0;
        return fromUtf8.decode(bytes.slice(start, bytes.indexOf(0, start)));
    }

    /** Allocates memory. @throws EchinusError OutOfMemory */
    take(byteCount) {
        if (!(byteCount <= 0xffffffff)) throw new EchinusError('OutOfMemory', `the module cannot have ${byteCount} bytes of memory; at most 4 GiB`);
        return this.try('memory_take', byteCount);
    }
    giveBack(address) {
        if (!this.#crash) this.call('memory_give_back', address);
    }

    /** Calls `use` with the addresses of temporary copies of typed arrays. */
    withCopies(arrays, use) {
        // Views of the module's own memory would be empty once that grows.
        const lasting = arrays.map((array) => (array.buffer === this.memory.buffer ? array.slice() : array));
        const addresses = [];
        try {
            for (const array of lasting) addresses.push(this.take(Math.max(array.byteLength, 1)));
            lasting.forEach((array, i) => this.views.bytes.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), addresses[i]));
            return use(...addresses);
        } finally {
            addresses.forEach((address) => this.giveBack(address));
        }
    }

    /** Calls `use(address, byteCount, ...)` with texts in the module's memory. */
    withTexts(texts, use) {
        const encoded = texts.map((text) => utf8.encode(text));
        return this.withCopies(encoded, (...addresses) => use(...addresses.flatMap((address, i) => [address, encoded[i].length])));
    }

    /** The text returned by an export. */
    text(name, ...args) {
        const text = this.try(name, ...args);
        try {
            const start = this.call('text_bytes', text) >>> 0;
            return fromUtf8.decode(this.views.bytes.slice(start, start + this.call('text_size', text)));
        } finally {
            this.call('text_delete', text);
        }
    }
    json(name, ...args) {
        return JSON.parse(this.text(name, ...args));
    }

    // Copies of memory, independent of its growth.
    copyWords(address, count) {
        return this.views.words.slice(address >>> 2, (address >>> 2) + count);
    }
    copyFloats(address, count) {
        return this.views.floats.slice(address >>> 2, (address >>> 2) + count);
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
