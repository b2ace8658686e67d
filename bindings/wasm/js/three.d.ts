/** Converts geometries of three.js to meshes, and makes the geometry of a cloth: docs/wasm.md. */
import type { BufferGeometry, Matrix4 } from 'three';
import type { Echinus, Mesh, Simulation } from 'echinus';

/**
 * The triangles of a geometry, indexed or not, with any kind of position attribute. Vertices whose positions agree to a
 * millionth of the largest coordinate are joined before `matrix` is applied, so the order of vertices changes.
 * drawRange, groups, morph targets and skins are ignored. Delete the mesh after use.
 * @param matrix  applied to the vertices, for instance object.matrixWorld; one that mirrors reverses the faces
 * @throws InvalidMesh as makeMesh() does
 */
export function meshOfGeometry(echinus: Echinus, geometry: BufferGeometry, matrix?: Matrix4 | null): Mesh;

/** A copy of a mesh, with smooth normals. */
export function geometryOfMesh(mesh: Mesh): BufferGeometry;

/** The cloth of a simulation: call update() after stepping. The caller deletes the simulation. */
export class ClothGeometry extends BufferGeometry {
    constructor(simulation: Simulation);
    /** Updates positions, normals and bounding sphere from the simulation. */
    update(): void;
    /** A copy as a plain geometry, which does not follow the simulation. */
    clone(): this;
}
