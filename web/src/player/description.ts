import type { ColliderState } from 'echinus';
import type { Triple } from '../protocol';

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
    sticks: number;
    solver: string;
    substeps: number;
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
