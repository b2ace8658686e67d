import { ByteReader, fromBase64 } from './byte_reader';
import type { Description } from './description';

/** The shapes and positions in a page. Frames arrive one after the other during reading. */
export class Recording {
    readonly description: Description;
    readonly modelVertices: Float32Array<ArrayBuffer>;
    readonly modelFaces: Uint32Array<ArrayBuffer>;
    readonly clothFaces: Uint32Array<ArrayBuffer>;
    /** Frame by frame, and within each axis by axis: coordinates in lattice steps, modulo 2^16. */
    readonly #coordinates: Uint16Array[] = [];
    readonly #bytes: ByteReader;

    /** Reads the shapes; the frames come with readFrames(). */
    static async open(description: Description, data: string): Promise<Recording> {
        const bytes = new ByteReader(fromBase64(data).pipeThrough(new DecompressionStream('deflate')));
        const { vertices, faces } = description.model;
        const take = async (triples: number) => (await bytes.take(12 * triples)).buffer;
        return new Recording(description, bytes, await take(vertices), await take(faces), await take(description.cloth_faces));
    }

    private constructor(description: Description, bytes: ByteReader, vertices: ArrayBuffer, faces: ArrayBuffer, clothFaces: ArrayBuffer) {
        this.description = description;
        this.#bytes = bytes;
        this.modelVertices = new Float32Array(vertices);
        this.modelFaces = new Uint32Array(faces);
        this.clothFaces = new Uint32Array(clothFaces);
    }

    async readFrames(): Promise<void> {
        const count = 3 * this.description.figures.particles;
        let before = new Uint16Array(count), last = new Uint16Array(count);
        for (const _ of this.description.frames) {
            const now = undoDifferences(await this.#bytes.take(2 * count), last, before);
            this.#coordinates.push(now);
            before = last;
            last = now;
        }
    }

    /** The number of frames read so far. */
    get frameCount(): number {
        return this.#coordinates.length;
    }

    /** Between a frame and the next, straight. @param share  of the way @param positions, ahead  [3 particles] out, and room for the next */
    positionsBetween(frame: number, share: number, positions: Float32Array, ahead: Float32Array): void {
        this.positionsOf(frame, positions);
        if (share === 0) return;
        this.positionsOf(frame + 1, ahead);
        for (let i = 0; i < positions.length; ++i) positions[i] += share * (ahead[i] - positions[i]);
    }

    /** @param positions  [3 particles] out */
    positionsOf(frame: number, positions: Float32Array): void {
        const { lattice_step: step, frames } = this.description;
        const coordinates = this.#coordinates[frame];
        const count = coordinates.length / 3;
        for (let axis = 0; axis < 3; ++axis) {
            const origin = frames[frame].origin[axis];
            // Bit operations are modulo 2^32, so they need only the last 16 bits of the origin.
            const originBits = ((origin % 65536) + 65536) % 65536;
            for (let i = 0; i < count; ++i)
                positions[3 * i + axis] = step * (origin + ((coordinates[axis * count + i] - originBits) & 0xffff));
        }
    }
}

/** Coordinates from second differences, all low bytes first, then all high bytes. Typed arrays wrap at 2^16. */
function undoDifferences(bytes: Uint8Array, last: Uint16Array, before: Uint16Array): Uint16Array<ArrayBuffer> {
    const { length } = last;
    const now = new Uint16Array(length);
    for (let i = 0; i < length; ++i) {
        const code = bytes[i] | (bytes[length + i] << 8);
        now[i] = ((code >> 1) ^ -(code & 1)) + 2 * last[i] - before[i];
    }
    return now;
}
