import type { ColliderState } from 'echinus';
import type { Triple } from '../protocol';

/** The description that `echinus simulate --html` writes beside the data (docs/command_line.md). */
export interface Description {
    format: number;
    version: string;
    machine: string;
    scene: string;
    model: { name: string; notice: string; vertices: number; faces: number; centre: Triple; radius: number };
    cloth_faces: number;
    lattice_step: number;
    figures: Figures;
    frames: RecordedFrame[];
}

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
    /** The smallest coordinates, in lattice steps. */
    origin: Triple;
    /** Of the first frame, and of each where the model moves. */
    pose?: Pick<ColliderState, 'position' | 'rotation'>;
}
