import type { Echinus, Mesh, SceneDescription, Simulation } from 'echinus';
import type { Triple } from '../../protocol';
import type { Settings } from '../../settings';
import type { Body } from '../cloth_scene';
import type { SheetMesh } from './sheet_mesh';
import type { SolidMesh } from './solids';

/** What happens around a model: by default sheets fall on it (sheets.ts). */
export interface Act {
    /** The model, where the act makes it. */
    solid?: SolidMesh;
    /** Its vertices at a time, where it deforms: at 0 those of `solid`. It does so while surfaces collide, which alone are kept off faces that move. */
    shape?(seconds: number): Float32Array<ArrayBuffer>;
    /** What the camera shows, and what lengths and gravity are measured by, where that is not the model alone. */
    body?: Pick<Body, 'centre' | 'radius' | 'up'>;
    /** How high the ground is, along up, where it is not under the model. */
    floor?: number;
    /** The cloth or the soft bodies in the scene, with the material, and what differs from every act's scene. */
    scene(settings: Settings, body: Body): Partial<SceneDescription>;
    /** The distance that particles keep from the model. */
    thickness(settings: Settings, body: Body): number;
    /** A cloth that is not one sheet. The caller deletes its mesh. */
    cloth?(echinus: Echinus, settings: Settings, body: Body): Garment | undefined;
    /** The surfaces of soft bodies. The caller deletes them. */
    bodies?(echinus: Echinus): Mesh[];
    /** Sets velocities of particles before each step. */
    steer?(simulation: Simulation, seconds: number): void;
    /** The model's own motion at a time, where it has one: velocities of the pose of its frame. */
    motion?(seconds: number): { linear: Triple; angular: Triple };
    /** The air's velocity at a time, in radii per second. */
    wind?(seconds: number): Triple;
    /** How far down the visitor may push the model; by default onto the ground. */
    deepest?: number;
    /** Until then nothing counts as at rest, in seconds. */
    lasts: number;
}

export interface Garment {
    mesh: Mesh;
    /** [2 particles] places on the fabric, in units of length. */
    weave: Float32Array<ArrayBuffer>;
    /** [particles] places on the scale of colours, 0 to 1, where pieces differ in colour. */
    tints?: Float32Array<ArrayBuffer>;
    /** The edge of its sheets on the fabric, where they are squares with a border. */
    hem?: number;
}

/** @param unit  the length that places on the fabric are measured by */
export function garmentOf(echinus: Echinus, { vertices, faces, weave, tints }: SheetMesh & { tints?: number[] }, { unit = 1, hem }: { unit?: number; hem?: number } = {}): Garment {
    return { mesh: echinus.makeMesh(vertices, faces), weave: Float32Array.from(weave, (part) => part / unit), ...(tints && { tints: new Float32Array(tints) }), ...(hem && { hem }) };
}
