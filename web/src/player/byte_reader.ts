/** Reads a stream in pieces of any number of bytes. */
export class ByteReader {
    readonly #reader: ReadableStreamDefaultReader<Uint8Array>;
    #chunk = new Uint8Array(0);

    constructor(stream: ReadableStream<Uint8Array>) {
        this.#reader = stream.getReader();
    }

    async take(count: number): Promise<Uint8Array<ArrayBuffer>> {
        const bytes = new Uint8Array(count);
        for (let filled = 0; filled < count; ) {
            if (this.#chunk.length === 0) await this.#next();
            const part = this.#chunk.subarray(0, count - filled);
            bytes.set(part, filled);
            filled += part.length;
            this.#chunk = this.#chunk.subarray(part.length);
        }
        return bytes;
    }

    async #next(): Promise<void> {
        const { done, value } = await this.#reader.read();
        if (done) throw new Error('it ends too early');
        this.#chunk = new Uint8Array(value);
    }
}

/** Decodes base64 text piece by piece on demand. */
export function fromBase64(text: string): ReadableStream<Uint8Array<ArrayBuffer>> {
    const LENGTH = 1 << 18; // a multiple of 4, so that each piece gives whole bytes
    let next = 0;
    return new ReadableStream({
        pull(controller) {
            if (next >= text.length) return controller.close();
            const piece = atob(text.slice(next, next + LENGTH));
            next += LENGTH;
            const bytes = new Uint8Array(piece.length);
            for (let i = 0; i < piece.length; ++i) bytes[i] = piece.charCodeAt(i);
            controller.enqueue(bytes);
        },
    });
}
