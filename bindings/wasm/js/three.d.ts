/** Geometries of three.js: as meshes for maps, and of a cloth. docs/wasm.md. */
import type { BufferGeometry, Matrix4 } from 'three';
import type { Echinus, Mesh, Simulation } from 'echinus';

/**
 * The triangles of a geometry, indexed or not, with any kind of position attribute. Vertices at the same
 * place are joined, to a millionth of the largest coordinate, before `matrix` moves them, so the order of vertices is another one. drawRange, groups,
 * morph targets and skins are not regarded. Delete it.
 * @param matrix  applied to the vertices, for instance object.matrixWorld; one that mirrors turns the faces round
 * @throws InvalidMesh as makeMesh()
 */
export function meshOfGeometry(echinus: Echinus, geometry: BufferGeometry, matrix?: Matrix4 | null): Mesh;

/** A copy of a mesh, with smooth normals. */
export function geometryOfMesh(mesh: Mesh): BufferGeometry;

/** The cloth of a simulation: call update() after stepping. Deleting the simulation is the caller's. */
export class ClothGeometry extends BufferGeometry {
    constructor(simulation: Simulation);
    /** Positions, normals and bounding sphere as the simulation has the particles now. */
    update(): void;
    /** A plain geometry as this one is now; it does not follow the simulation. */
    clone(): this;
}
