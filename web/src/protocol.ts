import type { ColliderState, DistanceMapDescription, ExactMapDescription, MeshFaults, MeshReport, RayInterval } from 'echinus';
import type { Axis } from './frames';
import type { Shape } from './normals';
import type { Settings } from './settings';

/**
 * The messages between the page and the worker. The worker holds the mesh, the maps and the cloth; the page draws.
 * Large arrays are transferred, and returned to be filled again.
 */

export type Triple = [number, number, number];

export type ToWorker =
    /** A file, with those that it may refer to, or else the sample of the settings. Opening and changing each count as a turn, which the answers name. */
    | { kind: 'open'; turn: number; settings: Settings; page: string; file?: File; companions?: readonly File[] }
    | { kind: 'change'; turn: number; settings: Settings }
    | { kind: 'restart' }
    | { kind: 'pause'; paused: boolean }
    | { kind: 'step' }
    /** Requests a frame; its arrays are those of an earlier one, if there was one. */
    | { kind: 'frame'; arrays?: FrameArrays; until?: number }
    | { kind: 'grab'; particle: number; target: Triple }
    | { kind: 'drag'; target: Triple }
    | { kind: 'release' }
    /** The visitor holds the model, this far from where it would be. */
    | { kind: 'hold'; offset: Triple }
    /** The line under the pointer, for the ball. */
    | { kind: 'pointer'; from: Triple; to: Triple }
    /** The map along a ray from its centre. */
    | { kind: 'ray'; direction: Triple }
    /** The same, through the first point of the surface on a straight line. */
    | { kind: 'point'; from: Triple; to: Triple }
    | { kind: 'surface' }
    /** The cells of an exact map. */
    | { kind: 'cells' }
    /** Builds the map in use once more, only to time it. */
    | { kind: 'rebuild' }
    | { kind: 'slice'; height: number };

export type FromWorker =
    | ({ kind: 'model' } & ModelNews)
    /** Another cloth; `why`, where a setting and no button has caused it. */
    | ({ kind: 'cloth'; why?: 'changed' | 'map' } & ClothNews)
    /** The same cloth, and the ball's radius where there is one. */
    | { kind: 'hand'; ball?: number }
    | { kind: 'frame'; arrays: FrameArrays; figures: Figures; wrong: Uint32Array; ball?: Triple; collider: ColliderState; shape?: ModelShape; cloth: number }
    | { kind: 'progress'; turn: number; stage: Stage }
    | ({ kind: 'surface' } & SurfaceNews)
    | ({ kind: 'cells' } & CellNews)
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

/** The stages of opening a model that take time. */
export type Stage = 'reading' | 'repairing' | 'building the map' | 'laying the cloth';

export interface ClothNews {
    faces: Uint32Array;
    /** The distance that particles keep from the model. */
    thickness: number;
    /** [2 particles] places on the fabric, about in radii of the model. */
    weave?: Float32Array;
    /** [particles] places on the scale of colours, 0 to 1. */
    tints?: Float32Array;
    /** The edge on the fabric of square sheets that have a border. */
    hem?: number;
    /** The surface of soft bodies, without a back. */
    soft: boolean;
    /** The radius of the visitor's ball. */
    ball?: number;
}

export interface FrameArrays {
    /** [3 particles] */
    positions: Float32Array<ArrayBuffer>;
    /** [3 particles] */
    normals: Float32Array<ArrayBuffer>;
    /** [particles] depth of contact (worker/judge.ts), where the colours need it. */
    depths: Float32Array<ArrayBuffer>;
}

/** A model that has deformed. */
export interface ModelShape {
    /** [3 vertices], as are the normals. */
    vertices: Float32Array<ArrayBuffer>;
    normals: Float32Array<ArrayBuffer>;
}

export interface ModelNews {
    name: string;
    vertices: Float32Array;
    faces: Uint32Array;
    /** Where it is small enough for creases. */
    shape?: Shape;
    /** [3 vertices] Otherwise. */
    normals?: Float32Array;
    report: MeshReport;
    /** Of the bounding sphere: where the answers of the exact map are certain for sure. */
    certainShare: number;
    faults: MeshFaults;
    /** Faces dropped and parts reversed by mending. */
    mendedFaces: number;
    flippedParts: number;
    centre: Triple;
    radius: number;
    /** The sphere that the camera shows. */
    sight: { centre: Triple; radius: number };
    /** The height of the ground, along up. */
    floor: number;
    up: Axis;
    map: MapNews;
}

export interface MapNews {
    kind: 'exact' | 'distance';
    byteCount: number;
    buildMs: number;
    description: ExactMapDescription | DistanceMapDescription;
}

/** Separate faces, each in its colour, ready to draw: there may be a million. Transferred. */
export interface ColouredFaces {
    /** [9 faces] of their corners, as are the others. */
    positions: Float32Array<ArrayBuffer>;
    normals: Float32Array<ArrayBuffer>;
    /** Linear. */
    colours: Float32Array<ArrayBuffer>;
}

export interface SurfaceNews {
    /** Coloured by their values. Exact: the longest list that contains the face; distance: its layer. */
    faces: ColouredFaces;
    /** Of the values. */
    largest: number;
    mapKind: 'exact' | 'distance';
    /** Where the paper's map and the exact map differ, of points in the whole bounding sphere and near the surface. */
    differences?: { everywhere: Difference; near: Difference & { within: number } };
}

/** The cells of an exact map on the bounding sphere: the more faces are in their lists, the darker. */
export interface CellNews {
    faces: ColouredFaces;
    /** Of the numbers of faces. */
    largest: number;
}

export interface Difference {
    /** [3 n] */
    points: Float32Array;
    sampleCount: number;
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
    /** The model's vertices, where they have moved. */
    shape?: Float32Array;
}

/** Its answer: pairs of faces that intersect, and the faces of the cloth among them: with the model, and with each other. */
export interface Cuts {
    number: number;
    withModel: number;
    own: number;
    cutFaces: Uint32Array;
    ownFaces: Uint32Array;
    /** The time that the count took. */
    ms: number;
}

export interface Figures {
    frame: number;
    paused: boolean;
    atRest: boolean;
    /** Simulated by a step. */
    stepSeconds: number;
    /** Per step, over the steps since the last frame; 0 when there was none. */
    stepMs: number;
    constraintMs: number;
    collisionMs: number;
    /** Judged by the exact map, whichever map the cloth uses; an open model has no inside. */
    inside?: number;
    stepCount: number;
}

/** Do the faces look inwards? Undecided for an open mesh, whose volume is meaningless. */
export const isInsideOut = ({ closed, signedVolume }: MeshReport): boolean => closed && signedVolume < 0;
