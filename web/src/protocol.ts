/**
 * What the page and the worker say to each other. The worker holds the mesh, the maps and the cloth; the page draws.
 * Large arrays are transferred, and come back to be filled again.
 */
import type { ColliderState, DistanceMapDescription, ExactMapDescription, MeshFaults, MeshReport, RayInterval } from 'echinus';
import type { Axis } from './axes';
import type { Settings } from './settings';

export type Triple = [number, number, number];

export type ToWorker =
    /** A file, or else the sample of the settings. This and a change are each a turn, which its answers name. */
    | { kind: 'open'; turn: number; settings: Settings; page: string; file?: File }
    | { kind: 'change'; turn: number; settings: Settings }
    | { kind: 'restart' }
    | { kind: 'pause'; paused: boolean }
    | { kind: 'step' }
    /** A frame is wanted; its arrays are those of an earlier one, once there was one. */
    | { kind: 'frame'; arrays?: FrameArrays }
    | { kind: 'grab'; particle: number; target: Triple }
    | { kind: 'drag'; target: Triple }
    | { kind: 'release' }
    /** The map along a ray from its centre. */
    | { kind: 'ray'; direction: Triple }
    /** The same, through the first point of the surface on a straight way. */
    | { kind: 'point'; from: Triple; to: Triple }
    | { kind: 'surface' }
    /** The map in use once more, for its time alone. */
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
    /** There is no surface on the way. */
    | { kind: 'missed' }
    | ({ kind: 'cut' } & Cut)
    | { kind: 'failed'; sentence: string; code: string; turn?: number }
    /** The last answer to a turn, whether it failed or not: the turn that opened the model on show, once there is one, and by what it goes. */
    | { kind: 'settled'; turn: number; inForce?: { turn: number; settings: Settings } };

export interface FrameArrays {
    /** [3 particles] */
    positions: Float32Array<ArrayBuffer>;
    /** [3 particles] */
    normals: Float32Array<ArrayBuffer>;
    /** [particles] depth of contact (depth.ts of the worker), where colours ask for it. */
    depths: Float32Array<ArrayBuffer>;
}

export interface ModelNews {
    name: string;
    vertices: Float32Array;
    faces: Uint32Array;
    report: MeshReport;
    faults: MeshFaults;
    /** Faces that mending dropped, and parts that it turned round. */
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
    /** [faces] exact: the longest list that the face is in; distance: its layer. */
    values: Uint32Array;
    mapKind: 'exact' | 'distance';
    /** [3 n] points at which the paper's map and the exact map differ, of sampleCount in the bounding sphere. */
    disagreements: Float32Array;
    sampleCount: number;
    /** Of an exact map: for each cell the faces in all its lists, and unit vectors to its three corners. */
    cells?: { faceCounts: Uint32Array; corners: Float32Array };
}

/** A plane across the model, and what the map says at its points. */
export interface Cut {
    /** Row by row: 1 inside. */
    inside: Uint8Array;
    side: number;
    height: number;
}

export interface Figures {
    frame: number;
    paused: boolean;
    atRest: boolean;
    /** Per step, over the steps since the last frame; 0 when there was none. */
    stepMs: number;
    constraintMs: number;
    collisionMs: number;
    /** Particles asked about, per second of collision. */
    queriesPerSecond: number;
    /** Judged by the exact map, whichever map the cloth uses. */
    inside: number;
    stepCount: number;
}
