/**
 * The messages between the page and the worker. The worker holds the mesh, the maps and the cloth; the page draws.
 * Large arrays are transferred, and returned to be filled again.
 */
import type { ColliderState, DistanceMapDescription, ExactMapDescription, MeshFaults, MeshReport, RayInterval } from 'echinus';
import type { Axis } from './axes';
import type { Settings } from './settings';

export type Triple = [number, number, number];

export type ToWorker =
    /** A file, or else the sample of the settings. Opening and changing each count as a turn, which the answers name. */
    | { kind: 'open'; turn: number; settings: Settings; page: string; file?: File }
    | { kind: 'change'; turn: number; settings: Settings }
    | { kind: 'restart' }
    | { kind: 'pause'; paused: boolean }
    | { kind: 'step' }
    /** Requests a frame; its arrays are those of an earlier one, if there was one. */
    | { kind: 'frame'; arrays?: FrameArrays }
    | { kind: 'grab'; particle: number; target: Triple }
    | { kind: 'drag'; target: Triple }
    | { kind: 'release' }
    /** The map along a ray from its centre. */
    | { kind: 'ray'; direction: Triple }
    /** The same, through the first point of the surface on a straight line. */
    | { kind: 'point'; from: Triple; to: Triple }
    | { kind: 'surface' }
    /** Builds the map in use once more, only to time it. */
    | { kind: 'rebuild' }
    | { kind: 'slice'; height: number };

export type FromWorker =
    | ({ kind: 'model' } & ModelNews)
    | { kind: 'cloth'; faces: Uint32Array }
    | { kind: 'frame'; arrays: FrameArrays; figures: Figures; collider: ColliderState; cloth: number }
    | ({ kind: 'surface' } & SurfaceNews)
    /** Another map is in use. */
    | { kind: 'map'; map: MapNews }
    | { kind: 'rebuilt'; map: MapNews }
    | { kind: 'ray'; crossings: number[]; intervals: RayInterval[]; direction: Triple; outline: Triple[]; bands: [number, number][] }
    /** There is no surface on the line. */
    | { kind: 'missed' }
    | ({ kind: 'cut' } & Cut)
    | { kind: 'failed'; sentence: string; code: string; turn?: number }
    /** The last answer to a turn, failed or not: the turn that opened the model shown, if there is one, and the settings in force. */
    | { kind: 'settled'; turn: number; inForce?: { turn: number; settings: Settings } };

export interface FrameArrays {
    /** [3 particles] */
    positions: Float32Array<ArrayBuffer>;
    /** [3 particles] */
    normals: Float32Array<ArrayBuffer>;
    /** [particles] depth of contact (worker/depth.ts), where the colours need it. */
    depths: Float32Array<ArrayBuffer>;
}

export interface ModelNews {
    name: string;
    vertices: Float32Array;
    faces: Uint32Array;
    report: MeshReport;
    faults: MeshFaults;
    /** Faces dropped and parts reversed by mending. */
    mendedFaces: number;
    flippedParts: number;
    centre: Triple;
    radius: number;
    up: Axis;
    map: MapNews;
}

export interface MapNews {
    kind: 'exact' | 'distance';
    byteCount: number;
    buildMs: number;
    description: ExactMapDescription | DistanceMapDescription;
}

export interface SurfaceNews {
    vertices: Float32Array;
    faces: Uint32Array;
    /** [faces] exact: the longest list that contains the face; distance: its layer. */
    values: Uint32Array;
    mapKind: 'exact' | 'distance';
    /** [3 n] points at which the paper's map and the exact map differ, of sampleCount in the bounding sphere. */
    disagreements: Float32Array;
    sampleCount: number;
    /** Of an exact map: for each cell the faces in all its lists, and unit vectors to its three corners. */
    cells?: { faceCounts: Uint32Array; corners: Float32Array };
}

/** A plane across the model, and the map's answers at its points. */
export interface Cut {
    /** Row by row: 1 inside. */
    inside: Uint8Array;
    side: number;
    height: number;
}

/** To the worker that counts intersecting faces (worker/pairs.ts). */
export interface PairsQuestion {
    /** Of the cloth, to be named in the answer. */
    number: number;
    /** Where it is another than in the last question. */
    model?: { vertices: Float32Array; faces: Uint32Array };
    /** Transferred. */
    positions: Float32Array<ArrayBuffer>;
    faces: Uint32Array;
    collider: Pick<ColliderState, 'position' | 'rotation'>;
}

/** Its answer: pairs of faces that intersect, and the faces of the cloth among them. */
export interface Cuts {
    number: number;
    withModel: number;
    own: number;
    cutFaces: Uint32Array;
    /** What it took. */
    ms: number;
}

export interface Figures {
    frame: number;
    paused: boolean;
    atRest: boolean;
    /** Per step, over the steps since the last frame; 0 when there was none. */
    stepMs: number;
    constraintMs: number;
    collisionMs: number;
    /** Particle queries per second of collision. */
    queriesPerSecond: number;
    /** Judged by the exact map, whichever map the cloth uses. */
    inside: number;
    stepCount: number;
}
