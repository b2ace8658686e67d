import type { ColliderState } from 'echinus';
import type { Triple } from '../protocol';

/** Reads a stream in pieces of any number of bytes. */
class ByteReader {
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
function fromBase64(text: string): ReadableStream<Uint8Array<ArrayBuffer>> {
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

/** The description that `echinus simulate --html` writes beside the data (docs/command_line.md). */
export interface Description {
    format: number;
    version: string;
    machine: string;
    scene: string;
    /** The parts are colliders, where there are several: their vertices follow each other, and then their faces. */
    model: { name: string; notice: string; vertices: number; faces: number; centre: Triple; radius: number; parts?: Part[] };
    cloth_faces: number;
    lattice_step: number;
    figures: Figures;
    frames: RecordedFrame[];
}

export interface Part {
    vertices: number;
    faces: number;
}

export type Pose = Pick<ColliderState, 'position' | 'rotation'>;

export interface Figures {
    particles: number;
    constraints: number;
    solver: string;
    iterations: number;
    time_step: number;
    frames: number;
    frames_to_rest: number | null;
    ms_per_frame: { integration: number; constraints: number; collision: number; total: number };
    queries_per_frame: number;
    ns_per_query: number;
    map_kind: 'exact' | 'distance';
    thickness: number;
    gravity: Triple;
}

export interface RecordedFrame {
    number: number;
    inside: number;
    /** Of faces: of the cloth and a model, and of the cloth alone; where all frames were judged. */
    intersecting_pairs?: number;
    self_intersecting_pairs?: number;
    /** The smallest coordinates, in lattice steps. */
    origin: Triple;
    /** Of the first frame, and of each where the model moves. */
    pose?: Pose;
    /** The same of several colliders. */
    poses?: Pose[];
}

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
