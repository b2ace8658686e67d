/// <reference lib="esnext.disposable" />

/**
 * Echinus for JavaScript: maps of rigid meshes, queries for many particles, and cloth. docs/wasm.md is the guide.
 *
 * Frames, units and terms are those of the C++ library (docs/conventions.md). All failures throw an EchinusError. An
 * object with a delete() holds memory of the module: delete it (or declare it with `using`) when it is no longer
 * needed. Otherwise the garbage collector frees it, possibly late.
 *
 * Nothing here is asynchronous except load(): in a page, run long work in a worker. An instance belongs to the thread
 * that loaded it.
 */

export type Vec3 = readonly [number, number, number] | Float32Array | Float64Array | readonly number[];

/** `code` is for programs; `message` is one sentence for people. */
export class EchinusError extends Error {
    readonly name: 'EchinusError';
    readonly code: ErrorCode;
}

export type ErrorCode =
    // as in echinus/error.hpp
    | 'Unreadable' | 'WrongFormat' | 'Damaged' | 'UnsupportedVersion'
    | 'InvalidMesh' | 'InvalidOptions' | 'InvalidScene'
    | 'Diverged'
    /** Out of memory. The module still works: delete something, or request less. */
    | 'OutOfMemory'
    /** An argument of the wrong kind or size. */
    | 'InvalidArgument'
    /** The object was deleted. */
    | 'Deleted'
    /** The host lacks the features that missingFeatures() names. */
    | 'Unsupported'
    /** The module has crashed because of a bug. Every further call throws this error: load() the module again. */
    | 'Crashed'
    | 'Internal';

/** The features that the host lacks to run the module, for instance ['WebAssembly SIMD']; [] when it lacks none. */
export function missingFeatures(): string[];

/**
 * Loads the module. Each call makes an instance with its own memory; a compiled module loads again quickly and can be
 * posted to workers.
 * @param source  the address of echinus.wasm, as for fetch(): a relative one is relative to the page or the worker; in
 *                Node also the path of a file. It may also be the bytes of the file, or the compiled module. By default
 *                the file is looked up next to this module
 * @throws Unsupported, or Unreadable when the file is not there
 */
export function load(source?: URL | string | Response | Promise<Response> | BufferSource | WebAssembly.Module): Promise<Echinus>;

/** Holds memory of the module until delete(). Deleting twice is harmless; any other use afterwards throws `Deleted`. */
declare abstract class Deletable {
    /** Only the module constructs these. */
    protected constructor();
    readonly deleted: boolean;
    delete(): void;
    [Symbol.dispose](): void;
}

/** One instance of the module. */
export class Echinus {
    /** Only load() constructs these. */
    private constructor();

    /** The size of the memory that the instance has allocated from the host; it never shrinks, and is at most 4 GiB. */
    readonly memoryByteCount: number;
    /**
     * 'wasm', or 'scalar' for the reference implementation, which gives the same answers more slowly. Applies to the
     * whole instance.
     */
    instructionSet: 'wasm' | 'scalar';

    // Memory for batches.
    makePoints(length: number): PointBuffer;
    makeFlags(length: number): FlagBuffer;
    makeContacts(length: number): ContactBuffer;

    /**
     * Copies the arrays.
     * @param vertices  [3 vertex_count]
     * @param faces     [3 face_count] vertices, counter-clockwise seen from outside
     * @throws InvalidMesh when there is no face, an index is out of range or a used vertex is not finite
     */
    makeMesh(vertices: ArrayLike<number>, faces: ArrayLike<number>): Mesh;
    /**
     * Polygons are triangulated; a polygon of k corners becomes k - 2 faces, in order.
     * @param corners       vertices, polygon after polygon
     * @param cornerCounts  [polygon_count]
     */
    makeMeshFromPolygons(vertices: ArrayLike<number>, corners: ArrayLike<number>, cornerCounts: ArrayLike<number>): Mesh;
    /**
     * Reads an OBJ, PLY, STL or OFF file, text or binary, depending on the extension of its name; vertices at equal
     * positions are welded. For glTF, GLB and 3DS use a different reader, makeMesh() and weld().
     * @throws WrongFormat, Damaged or InvalidMesh; the message begins with the name, and names the line or byte
     */
    readMesh(bytes: ArrayBuffer | ArrayBufferView, name: string): Mesh;
    /** Makes a torus about the z axis. @throws InvalidOptions */
    makeTorus(majorRadius: number, minorRadius: number, majorSegments: number, minorSegments: number): Mesh;
    makeSphere(radius: number, meridianCount: number, parallelCount: number): Mesh;
    makeBox(size: Vec3, segments?: number): Mesh;
    /**
     * Finds the meshes that intersect each other or themselves, and the pairs of which one mesh has a vertex inside the
     * other (echinus/intersections.hpp). All meshes must be in the same frame. Mesh.intersections() returns the curves.
     */
    check(meshes: readonly Mesh[]): CheckedMeshes[];

    /**
     * @param options  as under `map` in a scene (docs/scenes.md), as an object or a JSON text; {} is an exact map
     * @throws InvalidScene for an option that does not exist or is out of range, InvalidMesh, InvalidOptions
     */
    buildMap(mesh: Mesh, options: DistanceMapOptions): DistanceMap;
    buildMap(mesh: Mesh, options?: ExactMapOptions): ExactMap;
    buildMap(mesh: Mesh, options?: MapOptions | string): AnyMap;
    /**
     * Loads a map from the bytes of a map file, which are copied and checked.
     * @param name  the beginning of error messages
     * @throws WrongFormat, UnsupportedVersion, Damaged
     */
    loadMap(bytes: ArrayBuffer | ArrayBufferView, name?: string): AnyMap;

    /**
     * Collision for particles that another solver moves.
     * @throws InvalidOptions for invalid options and, with `surfaces`, for an initial state in which surfaces
     * intersect
     */
    makeCollision(options: CollisionOptions): Collision;

    /**
     * @param scene  as in docs/scenes.md, as an object or as a JSON text, which may have comments
     * @throws InvalidScene, which names the key and the most similar known key
     */
    parseScene(scene: SceneDescription | string, name?: string): Scene;
}

// ---- Buffers

/**
 * Memory of the WebAssembly module that both JavaScript and the module read and write.
 *
 * A view is valid until the module's memory grows, which any call into the module may cause; then the old array is
 * empty, and the getter returns a new one. So keep the buffer and get `.view` at each use, which costs a comparison.
 */
export class PointBuffer extends Deletable {
    readonly length: number;
    /** [3 length] x, y, z of each point in turn. */
    readonly view: Float32Array;
}
export class FlagBuffer extends Deletable {
    readonly length: number;
    /** [length] 1 inside, 0 outside. */
    readonly view: Uint8Array;
}
export class ContactBuffer extends Deletable {
    static readonly BYTES: 36;
    /** Distance from one contact to the next, in elements of `floats` and `ints`. */
    static readonly STRIDE: 9;
    static readonly POINT: 0;
    static readonly NORMAL: 3;
    static readonly DEPTH: 6;
    static readonly FACE: 7;
    /** This offset and the next two are in `bytes`. */
    static readonly INSIDE: 32;
    static readonly CERTAIN: 33;
    static readonly FEATURE: 34;

    readonly length: number;
    /** [9 length] The point of contact i is at 9i, its normal at 9i + 3, its depth at 9i + 6. */
    readonly floats: Float32Array;
    /** [9 length] The face of contact i is at 9i + 7; -1 if it is not known. */
    readonly ints: Int32Array;
    /** [36 length] `inside` of contact i is at 36i + 32, `certain` at 36i + 33, `feature` at 36i + 34. */
    readonly bytes: Uint8Array;
    /** A copy of one contact. */
    at(index: number): Contact;
}

/** As in echinus/contact.hpp. */
export interface Contact {
    point: [number, number, number];
    normal: [number, number, number];
    /** Positive inside, negative outside, 0 for no contact. */
    depth: number;
    face: number;
    inside: boolean;
    certain: boolean;
    feature: 'unknown' | 'face' | 'edge' | 'vertex';
    /** True if the point is inside, or outside within the margin. */
    found: boolean;
}

// ---- Meshes

export class Mesh extends Deletable {
    readonly vertexCount: number;
    readonly faceCount: number;
    /** [3 vertexCount] a copy, relative to the origin. */
    readonly vertices: Float32Array;
    /** The origin of the vertices' frame in the frame of the file: [0, 0, 0], unless floats could not represent the mesh there. */
    readonly origin: [number, number, number];
    /** [3 faceCount] a copy. */
    readonly faces: Uint32Array;

    report(): MeshReport;
    /** Every fault and its location, for drawing. */
    faults(): MeshFaults;
    /** Joins vertices at equal positions and drops unused ones; faces keep their order. */
    weld(): Mesh;
    /**
     * Makes a copy of a surface such as a garment that is moved, with little stretch, out of models, out of itself, and
     * its layers into their order (docs/surfaces.md). The report counts what still intersects. It may take up to minutes
     * for 10 000 vertices on a detailed model. @throws InvalidMesh, InvalidOptions
     */
    part(models?: readonly Mesh[], options?: PartOptions): { mesh: Mesh; report: PartReport };
    /** Makes a repaired copy. @param repairs  by default all */
    repair(repairs?: readonly Repair[]): { mesh: Mesh; report: RepairReport };
    /**
     * The pairs of intersecting faces, found by exact tests (echinus/intersections.hpp): a face of this mesh and a face
     * of the other, ascending. Both meshes must be in the same frame. @returns [2 pair_count]
     */
    intersectingPairs(other: Mesh): Uint32Array;
    /** Pairs of faces of this mesh that intersect other than in shared vertices and edges, ascending. @returns [2 pair_count] */
    selfIntersectingPairs(): Uint32Array;
    /** The intersecting faces of this mesh and the other, or of this mesh alone, and the curves along which they cross. */
    intersections(other?: Mesh): Intersections;
    /**
     * The winding number of the surface around a point, by brute force over all faces, as a reference: 1 inside a
     * closed mesh, 0 outside.
     */
    windingNumber(point: Vec3): number;
    unsignedDistance(point: Vec3): number;
}

/** Where surfaces intersect. */
export interface Intersections {
    /** [2 pair_count] */
    pairs: Uint32Array;
    /** The points [3 point_count] of polylines; a closed one also joins its last point to its first. */
    curves: { points: Float32Array; closed: boolean }[];
}

/** How far the vertices of one mesh are inside another: the depth is the distance of the deepest one from the other surface. */
export interface Penetration {
    vertexCount: number;
    /** null if no vertex is inside. */
    deepestVertex: number | null;
    depth: number;
}

/** A pair of the meshes that were checked, by index, or one mesh and itself. */
export interface CheckedMeshes {
    a: number;
    b: number;
    pairCount: number;
    curveCount: number;
    curveLength: number;
    /** null if the other mesh is not closed or no exact map of it is possible, or if both are the same mesh. */
    aInB: Penetration | null;
    bInA: Penetration | null;
}

export type Repair = 'duplicate_faces' | 'doubled_patches' | 'inside_out' | 'seams' | 'slivers' | 'orientation';
/** Repairs that only a scene can request. */
export type MakeSolid = 'small_holes' | 'inner_faces' | 'sheets';

export interface Fault {
    count: number;
    /** At most 8, ascending. */
    firstFaces: number[];
}
export interface MeshReport {
    faceCount: number;
    vertexCount: number;
    componentCount: number;
    /** Every edge is balanced: the same number of faces traverse it in either direction. */
    closed: boolean;
    manifold: boolean;
    /** Faces can be flipped so that neighbours agree about the outside; those of a Moebius strip cannot. */
    orientable: boolean;
    borderEdges: Fault;
    nonmanifoldEdges: Fault;
    misorientedEdges: Fault;
    duplicateFaces: Fault;
    degenerateFaces: Fault;
    /** Positive if faces point outwards. */
    signedVolume: number;
    boundingSphere: { centre: [number, number, number]; radius: number };
    /** The spacing of floats at the mesh, if all coordinates are floats and this spacing is too coarse; otherwise 0. */
    roundingStep: number;
}
export interface MeshFaults {
    /** Two vertices for each edge. */
    borderEdges: Uint32Array;
    nonmanifoldEdges: Uint32Array;
    misorientedEdges: Uint32Array;
    /** Faces. */
    duplicateFaces: Uint32Array;
    degenerateFaces: Uint32Array;
}
export interface PartOptions {
    /** Distance from which contact pushes the surface off the models; by default a tenth of the mean edge length. */
    thickness?: number;
    /** [vertexCount] 1 for vertices that stay where they are. */
    pinned?: ArrayLike<number>;
    /** [vertexCount] The layer of each vertex, a larger number farther outside, 0 to 255; each face is in a single one. */
    layers?: ArrayLike<number>;
}
/** What still intersects after Mesh.part(), and how much edges are stretched. */
export interface PartReport {
    ownPairs: number;
    /** Pairs of a face of the surface and a face of a model, of all models. */
    modelPairs: number;
    /** Vertices inside a closed model. */
    insideCount: number;
    /** The share of edges whose length changed by more than 5 %. */
    stretchedShare: number;
    /** The largest length of an edge over its length before, minus 1. */
    largestStretch: number;
}
export interface RepairReport {
    duplicateFacesDropped: number;
    doubledPatchFacesDropped: number;
    componentsFlipped: number;
    /** Only a scene can request the repairs of this count and the next three; otherwise they are 0. */
    holesClosed: number;
    holesLeft: number;
    innerFacesDropped: number;
    sheetsThickened: number;
    facesAdded: number;
    verticesWelded: number;
    sliversDropped: number;
    /** Faces flipped so that neighbours agree. */
    facesTurned: number;
    /** Filled holes of zero width. */
    seamsFilled: number;
    /** The indices of all dropped faces, ascending; faces that fill a hole have indices after those of the mesh. */
    droppedFaces: Uint32Array;
}

// ---- Maps

/** Keys and limits: docs/scenes.md, `map`. */
export interface ExactMapOptions {
    kind?: 'exact';
    // Options: exact_map. Generated by bindings/generate_options; edit bindings/options.toml.
    /**
     * Cells in each octant of directions, rounded down to a square number; 0: chosen according to the mesh. More cells
     * take memory and save time; they do not change any answer (0 to 262144). Default: according to the mesh.
     */
    cells_per_octant?: number;
    /**
     * The largest size of the map, which gets as many cells as fit; 0: no limit. It cannot be combined with a number of
     * cells (0 to 4e9 bytes). Default: none.
     */
    budget?: number;
    /**
     * The points that count as inside where parts of the model overlap: those in any part, or those in an odd number of
     * parts. Default: `"nonzero"`.
     */
    rule?: 'nonzero' | 'parity';
    /**
     * The origin of the rays: the centre of the bounding sphere, or a point found by a search for the fewest face tests
     * per query. Default: `"sphere"`.
     */
    centre?: 'sphere' | 'search';
    // End of options.
}
export interface DistanceMapOptions {
    kind: 'distance';
    // Options: distance_map. Generated by bindings/generate_options; edit bindings/options.toml.
    /** The grid of directions. Default: `"spherical"`. */
    grid?: 'spherical' | 'octahedral' | 'cube' | 'ellipsoidal';
    /**
     * Spherical and ellipsoidal grid: the numbers of samples of longitude and of colatitude (4 to 8192). Default:
     * `[200, 200]`.
     */
    directions?: readonly [number, number];
    /** Octahedral and cube grid: the number of parts into which each edge is divided (4 to 4096). Default: 100. */
    divisions?: number;
    /** The correction for vertices of the mesh between the samples. Default: `"signed"`. */
    correction?: 'none' | 'paper' | 'signed';
    /**
     * The format of a stored distance; `unorm16` takes half the bytes, with an error of at most 7.6e-6 R, or 1.4e-5 R
     * on octahedral and ellipsoidal grids. Default: `"float32"`.
     */
    entries?: 'float32' | 'unorm16';
    /**
     * Spherical and ellipsoidal grid: the axis of the mesh on which the poles of the grid lie, where samples crowd.
     * Default: `"z"`.
     */
    pole_axis?: 'x' | 'y' | 'z';
    /**
     * The origin of the rays: the centre of the bounding sphere, or a point found by a search for the fewest wrong
     * answers near the surface. Default: `"sphere"`.
     */
    centre?: 'sphere' | 'search';
    // End of options.
}
export type MapOptions = ExactMapOptions | DistanceMapOptions;
export type AnyMap = ExactMap | DistanceMap;

/**
 * Points are in the frame of the mesh, relative to its origin. A point with NaN or infinity is outside and has no
 * contact; for a point with NaN an exact map is not certain of this.
 */
declare abstract class MapOfEitherKind extends Deletable {
    /** The size of all data that a query reads. */
    readonly byteCount: number;
    readonly centre: [number, number, number];
    /** The origin of the mesh: subtract it from points of the file's frame, as numbers, before they become floats. */
    readonly origin: [number, number, number];
    /** Every vertex lies within this distance of the centre. */
    readonly radius: number;

    contains(point: Vec3): boolean;
    /** @param margin  points outside also get a contact if the surface is at most this far away */
    contact(point: Vec3, margin?: number): Contact;
    /**
     * contains() for many points. A PointBuffer is not copied; a Float32Array is copied first.
     * @param count  the number of points to query, from the first on; by default all
     * @returns `inside`
     */
    containsBatch(points: PointBuffer | Float32Array, inside: FlagBuffer, count?: number): FlagBuffer;
    /** contact() for many points. @returns `contacts` */
    contactsBatch(points: PointBuffer | Float32Array, margin: number, contacts: ContactBuffer, count?: number): ContactBuffer;

    /** The bytes of a map file. */
    save(): Uint8Array;
}

/**
 * A segment of a ray from the centre, given by distances from the centre; the last segment ends at the bounding sphere.
 */
export interface RayInterval {
    from: number;
    to: number;
    inside: boolean;
    certain: boolean;
}

export class ExactMap extends MapOfEitherKind {
    readonly kind: 'exact';
    readonly description: ExactMapDescription;
    /**
     * contains(), and whether the answer is certain: `certain` is false if the mesh is open and the winding number is
     * near one half.
     */
    classify(point: Vec3): { inside: boolean; certain: boolean };
    /** The first crossing of the line segment between two points with the surface. */
    sweep(from: Vec3, to: Vec3): SweepHit;
    /** The map's data along a ray from its centre. @param direction  of any length but 0 */
    ray(direction: Vec3): ExactRay;
    /**
     * The mesh on the map's lattice, and for each face the length of the longest band list that contains it. Delete the
     * mesh after use.
     */
    surface(): { mesh: Mesh; longestLists: Uint32Array };
    /**
     * Data for drawing: for each cell the number of its bands, the number of faces in their lists, and unit vectors to
     * its three corners (9 numbers).
     */
    cells(): { bandCounts: Uint32Array; faceCounts: Uint32Array; corners: Float32Array };
}

export class DistanceMap extends MapOfEitherKind {
    readonly kind: 'distance';
    readonly description: DistanceMapDescription;
    /**
     * The number of samples around a point that are used in the interpolation; 0 if queries do not interpolate there.
     */
    usableSampleCount(point: Vec3): number;
    ray(direction: Vec3): DistanceRay;
    /**
     * The surface of the map, and for each face its layer, 0 for the nearest to the centre. Delete the mesh after use.
     */
    surface(): { mesh: Mesh; layers: Uint32Array };
}

export interface SweepHit {
    /** Position on the segment: 0 at its start, 1 at its end or without a crossing. */
    fraction: number;
    point: [number, number, number];
    normal: [number, number, number];
    face: number;
    entering: boolean;
    found: boolean;
}

export interface ExactRay {
    cell: number;
    /** Unit vectors. */
    cellCorners: [number, number, number][];
    /**
     * The intervals that may contain parts of the surface; windingBelow is the winding number in the gap next to the
     * interval, towards the centre, or null if there is no single number.
     */
    bands: { from: number; to: number; faceCount: number; windingBelow: number | null }[];
    /** The distances from the centre at which the ray meets the surface. */
    crossings: number[];
    intervals: RayInterval[];
}
export interface DistanceRay {
    /** The indices of the samples around the ray; in an octahedral map the fourth is one of the other three. */
    samples: number[];
    /** The number of entries of each sample. */
    sampleEntryCounts: number[];
    /** True for samples with the same number of entries as the nearest one; the others are ignored. */
    samplesUsed: boolean[];
    /** The interpolated entries. */
    crossings: number[];
    intervals: RayInterval[];
}

interface MapDescription {
    centre: [number, number, number];
    radius: number;
    byteCount: number;
    /** 16 hexadecimal digits that identify the mesh and the options. */
    sourceHash: string;
    faceCount: number;
    droppedFaces: number;
}
export interface ExactMapDescription extends MapDescription {
    kind: 'exact';
    divisions: number;
    rule: 'nonzero' | 'parity';
    closed: boolean;
    cellCount: number;
    bandCount: number;
    referenceCount: number;
    longestList: number;
    meanList: number;
    expectedTests: number;
    certainShare: number;
    uncertainDirections: number;
}
export interface DistanceMapDescription extends MapDescription {
    kind: 'distance';
    grid: 'spherical' | 'octahedral' | 'cube' | 'ellipsoidal';
    longitudeCount: number;
    colatitudeCount: number;
    divisions: number;
    poleAxis: 'x' | 'y' | 'z';
    entryFormat: 'float32' | 'unorm16';
    correction: 'none' | 'paper' | 'signed';
    centreInside: boolean;
    directionCount: number;
    entryCount: number;
    /** The numbers of directions with 0, 1, 2 ... entries. */
    entryHistogram: number[];
    maxEntries: number;
    correctedEntries: number;
    clampedEntries: number;
    wrongParityShare: number;
}

// ---- Collision in another engine

/** The pose of a model: point_world = rotation applied to (scale * point_local), + position. */
export interface PlacedMap {
    map: AnyMap;
    position?: Vec3;
    /** A unit quaternion w, x, y, z. */
    rotation?: readonly number[];
    scale?: number | Vec3;
}

export interface CollisionOptions {
    /** [3 particle_count] The initial positions, outside the models. */
    positions: ArrayLike<number>;
    colliders: readonly PlacedMap[];
    /** The distance, in units, that particles keep from the models. */
    thickness: number;
    /** [3 face_count] The particles of each face; required by `surfaces`. */
    faces?: ArrayLike<number>;
    /** Keep not only particles but also faces off models (docs/surfaces.md). Needs exact maps. Default: false. */
    surfaces?: boolean;
    // Options of collisions. Generated by bindings/generate_options; edit bindings/options.toml.
    /** Coulomb's coefficient of friction; 0: no friction (0 to 1e9). Default: 0.5. */
    friction?: number;
    /** Accept exact maps of open meshes, for which nothing is guaranteed. Default: false. */
    allowOpenColliders?: boolean;
    /**
     * With `surfaces`: distance that layers keep from each other; less near small faces. By default the thickness (0 to
     * 1e9).
     */
    selfThickness?: number;
    /** With `surfaces`: faces do not intersect each other either. Default: true. */
    selfCollision?: boolean;
    /**
     * With `surfaces`: separate an initial state in which surfaces intersect or particles are inside the model, instead
     * of rejecting it. Default: false.
     */
    untangle?: boolean;
    // End of options.
}

/**
 * Keeps particles that another solver moves out of models: after each of its steps, particles that entered
 * or crossed a model are moved back out. A particle that began outside is outside after every correct()
 * with exact maps, however fast it or the model moved; the limits are those of ParticleCollision and, with
 * `surfaces`, SurfaceCollision (docs/own_solver.md).
 *
 * After each step of the solver, write its positions into `positions`, call correct(), and pass the
 * positions and velocities of the particles in `corrected` back to the solver. The views are valid as long as those of
 * a buffer.
 */
export class Collision extends Deletable {
    readonly particleCount: number;
    readonly colliderCount: number;
    /**
     * [3 particleCount] world units. A particle whose position is not finite, or is farther than 1e12 units from 0, is
     * not changed, and the next step continues from its previous position.
     */
    readonly positions: Float32Array;
    /** [3 particleCount] The velocities of the particles in `corrected`, units per second. */
    readonly velocities: Float32Array;
    /** The particles that the last correct() moved, ascending. */
    readonly corrected: Uint32Array;
    /**
     * With `surfaces`: the number of unresolved pairs of elements, for which no free space was proven. If it is 0, no
     * faces intersect.
     */
    readonly unresolvedCount: number;

    /**
     * Moves a collider to a pose during the solver's next step, rotating along the shorter arc; then it
     * stops.
     * @param rotation  a unit quaternion w, x, y, z
     */
    setColliderPose(collider: number, position: Vec3, rotation?: readonly number[]): void;
    /** @param seconds  the duration of the solver's step  @returns the number of corrected particles */
    correct(seconds: number): number;
}

// ---- Scenes and simulations

/** A generated mesh. */
export type Shape = { torus: object } | { sphere: object } | { box: object };

/** Keys and limits: docs/scenes.md. Angles are degrees. */
export interface SceneDescription {
    /** Either this or `colliders` is required. */
    model?: string | Shape;
    repair?: readonly (Repair | MakeSolid)[];
    /** Only with 'small_holes'. */
    hole_edges?: number;
    /** Only with 'sheets'. */
    sheet_thickness?: number;
    /** Only with 'seams'. */
    weld_distance?: number;
    map?: MapOptions;
    collider?: Placement;
    colliders?: readonly (Placement & { model: string | Shape; repair?: readonly (Repair | MakeSolid)[] })[];
    /** Required without `bodies`. */
    cloth?: (Sheet | MeshCloth) & {
        density?: number;
        position?: Vec3;
        rotation?: { axis: Vec3; degrees: number };
        velocity?: Vec3;
        /** Degrees per second, about the centre of mass. */
        angular_velocity?: Vec3;
        // Options: thickness. Generated by bindings/generate_options; edit bindings/options.toml.
        /**
         * Distance that the deformable keeps from colliders, by default half the mean rest length of structural
         * constraints or, for soft bodies, half the mean edge length (0 to 1e9). Default: half the spacing.
         */
        thickness?: number;
        /**
         * `newton` only: distance that layers keep from each other if they collide; less near small faces. By default
         * the thickness (0 to 1e9). Default: `cloth.thickness`.
         */
        self_thickness?: number;
        // End of options.
        /** The numbers of the colliders that the cloth passes through. */
        ignores?: readonly number[];
    };
    bodies?: readonly Body[];
    /**
     * Cuts: in the first frame that begins at `time` or later, these colliders and, by default, the deformable are
     * teleported.
     */
    teleports?: readonly {
        time: number;
        displacement?: Vec3;
        rotation?: { axis: Vec3; degrees: number };
        colliders?: readonly number[];
        deformable?: boolean;
    }[];
    material?: {
        /** Without a cloth, these two keys replace those of `cloth`. */
        thickness?: number;
        self_thickness?: number;
        // Options: jakobsen. Generated by bindings/generate_options; edit bindings/options.toml.
        /** `jakobsen` only: stiffness between neighbours in a row or column, or along an edge of a mesh, against stretching; 0 to 1.99. Default: 1. */
        structural?: number;
        /** `jakobsen` only: stiffness between neighbours along a diagonal, against shear; 0 to 1.99. Default: 1. */
        shear?: number;
        /** `jakobsen` only: stiffness between a particle and the next but one in a row or column, or across an edge between two faces, against bending; 0 to 1.99. Default: 0.3. */
        bending?: number;
        // End of options.
        // Options: newton. Generated by bindings/generate_options; edit bindings/options.toml.
        /** `newton` only, like the next four options: mass of the cloth per area (1e-6 to 1e6 kg/m^2). Default: 0.2. */
        density?: number;
        /** Force per width that resists stretching of warp and weft (1e-6 to 1e9 N/m). Default: 1000. */
        stretch_stiffness?: number;
        /** Force per width that resists shear between warp and weft (0 to 1e9 N/m). Default: 400. */
        shear_stiffness?: number;
        /** Moment per width and curvature that resists bending (0 to 1e6 N m). Default: 1e-5. */
        bending_stiffness?: number;
        /** Viscosity of the cloth divided by its stiffness (0 to 1e6 s). Default: 0.01. */
        damping?: number;
        /**
         * `newton` only: pressure inside closed pieces of cloth in excess of the surrounding pressure; it is constant,
         * as if a pump maintained it (0 to 1e9 N/m^2). Default: 0.
         */
        pressure?: number;
        // End of options.
        // Options: material. Generated by bindings/generate_options; edit bindings/options.toml.
        /**
         * `jakobsen` only: share of the velocity that is lost per frame; its effect depends on `time_step` (0 to 1).
         * Default: 0.005.
         */
        drag?: number;
        /**
         * Coulomb's coefficient of friction, for contacts with models and, if layers collide, between layers; 0: no
         * friction (0 to 1e9). Default: 0.5.
         */
        friction?: number;
        /**
         * `newton` only: resistance of still air, the rate at which the velocity of a free particle decays; 0 is a
         * vacuum (0 to 1e6 1/s). Default: 0.5.
         */
        air_drag?: number;
        // End of options.
    };
    // Options: surfaces. Generated by bindings/generate_options; edit bindings/options.toml.
    /**
     * The parts that collide; with `jakobsen` only particles do. `particles`: particles collide with models;
     * `surfaces`: edges and faces do, too, so none of them intersects a model at the end of a frame, within limits;
     * `surfaces_and_self`: in addition, faces do not intersect each other. Default: `surfaces_and_self` with an exact
     * map, otherwise `particles`.
     */
    collision?: 'particles' | 'surfaces' | 'surfaces_and_self';
    /**
     * `newton` only: separate, before the first frame, an initial state in which surfaces intersect or particles are
     * inside the model, instead of rejecting it; needs the collision of surfaces. Default: false.
     */
    untangle?: boolean;
    // End of options.
    // Options: solver. Generated by bindings/generate_options; edit bindings/options.toml.
    /**
     * Seconds per frame. The paper's solver needs smaller steps: there, halving the step doubles the computing time and
     * reduces the stretch to a quarter (1e-9 to 1e9 s). Default: 1/60; 1/240 with `jakobsen`.
     */
    time_step?: number;
    /**
     * `newton`: a continuous material in SI units; `jakobsen`: the paper's solver, with distance constraints and
     * collision of particles only. Default: `"newton"`.
     */
    solver?: 'newton' | 'jakobsen';
    /**
     * `jakobsen` only: relaxations per frame, each of all distance constraints and then of all contacts; more
     * relaxations take longer and leave less stretch (1 to 1e6). Default: 10.
     */
    iterations?: number;
    /**
     * `newton` only: the largest number of steps of Newton's method per frame or substep, or twice that number while
     * there is no contact; fewer are taken if it converges (1 to 1000). Default: 4.
     */
    newton_steps?: number;
    /**
     * The acceleration of gravity. A model whose y axis points up needs `[0, -9.81, 0]` (-1e9 to 1e9 length/s^2).
     * Default: `[0, 0, -9.81]`.
     */
    gravity?: Vec3;
    /**
     * Threads that compute a frame; 0: all cores. The results are bit-identical for any number (0 to 1024). Default: 1.
     */
    thread_count?: number;
    /**
     * `newton` only: tolerance of Newton's method, relative to the mean edge length. It has converged if the decrease
     * of the energy corresponds to a root-mean-square displacement of at most the tolerance times that length (0 to 1).
     * Default: 0.0005.
     */
    newton_tolerance?: number;
    /** Velocity of the air; needs `wind_rate` (-1e9 to 1e9 length/s). Default: `[0, 0, 0]`. */
    wind?: Vec3;
    /**
     * The rate at which particles take on the air's velocity relative to a face, along the face's normal; higher for
     * lighter cloth. 0: no air. Without `wind` the air is at rest and slows motion (0 to 1e9 1/s). Default: 0.
     */
    wind_rate?: number;
    // End of options.
    frame_limit?: number;
    at_rest?: {
        // Options: rest. Generated by bindings/generate_options; edit bindings/options.toml.
        /**
         * The number of consecutive frames for which all particles must be slow and near one position (1 to 1e9).
         * Default: 60.
         */
        frames?: number;
        /** The distance from one position within which a particle at rest stays (0 to 1e9). Default: 0.001. */
        distance?: number;
        /** The largest speed of a particle at rest at the end of a frame (at least 0 length/s). Default: 0.1. */
        speed?: number;
        // End of options.
    };
}

/** The pose and motion of a model, in degrees per second. */
export interface Placement {
    position?: Vec3;
    rotation?: { axis: Vec3; degrees: number };
    scale?: number | Vec3;
    linear_velocity?: Vec3;
    angular_velocity?: Vec3;
    /** With a mass, in kg, the model moves freely from its velocities. */
    mass?: number;
    /** Keyframes are given instead of position, rotation, velocities and mass. */
    keyframes?: readonly Keyframe[];
}

/** A keyframe: a pose at a time in seconds. */
export interface Keyframe {
    time: number;
    position?: Vec3;
    rotation?: { axis: Vec3; degrees: number };
}

/** The path of a handle and its release time in seconds. Without keyframes the handle does not move. */
export interface Handle {
    keyframes?: readonly Keyframe[];
    release?: number;
}

/** A soft body. `element` is a length before scaling. */
export interface Body {
    mesh: string | Shape;
    element: number;
    // Options: body. Generated by bindings/generate_options; edit bindings/options.toml.
    /** Water has 1000 kg/m^3 (1e-9 to 1e15 mass/length^3). Default: 1000. */
    density?: number;
    /** Stiffness; soft tissue has 1e3 to 1e5 Pa (1e-9 to 1e15 mass/(length s^2)). Default: 10000. */
    young_modulus?: number;
    /** Near 0.5 the volume is preserved (0 to 0.4999). Default: 0.4. */
    poisson_ratio?: number;
    /** Viscosity divided by the shear modulus (0 to 1e9 s). Default: 0. */
    damping?: number;
    /** Scale factor, applied before the pose (1e-9 to 1e9). Default: 1. */
    scale?: number;
    // End of options.
    position?: Vec3;
    rotation?: { axis: Vec3; degrees: number };
    velocity?: Vec3;
    /** Degrees per second, about the centre of mass. */
    angular_velocity?: Vec3;
    pins?: VertexChoice;
    attachments?: VertexChoice | readonly Attachments[];
    handles?: readonly (Handle & { vertices: VertexChoice })[];
    /** The numbers of the colliders that the body passes through. */
    ignores?: readonly number[];
}

/** A rectangular cloth. */
export interface Sheet {
    // Options: sheet. Generated by bindings/generate_options; edit bindings/options.toml.
    /** Lengths along x and y (1e-9 to 1e9). */
    size: readonly [number, number];
    /** Numbers of columns and rows. The time per frame grows with their product (2 to 4096). Default: `[100, 100]`. */
    particles?: readonly [number, number];
    // End of options.
    /** [column, row] of fixed particles. */
    pins?: readonly (readonly [number, number])[];
    /** Particles that move with a collider, by default with the first one. */
    attachments?: readonly (readonly [number, number])[] | readonly { collider: number; particles: readonly (readonly [number, number])[] }[];
    handles?: readonly (Handle & { particles: readonly (readonly [number, number])[] })[];
}

/** Vertices that move with a collider. */
export interface Attachments {
    collider: number;
    vertices: VertexChoice;
}

/** Vertices by index, or all vertices in a box. */
export type VertexChoice = readonly number[] | { from: Vec3; to: Vec3 };

/** A cloth of any shape. */
export interface MeshCloth {
    mesh: string | Shape;
    rest_mesh?: string | Shape;
    // Options: mesh_cloth. Generated by bindings/generate_options; edit bindings/options.toml.
    /** Scale factor, applied before the pose (1e-9 to 1e9). Default: 1. */
    scale?: number;
    // End of options.
    pins?: VertexChoice;
    attachments?: VertexChoice | readonly Attachments[];
    handles?: readonly (Handle & { vertices: VertexChoice })[];
}

/** A validated scene. */
export class Scene extends Deletable {
    /** The name of the model's file in the scene; null when the model is a generated shape. */
    readonly modelFile: string | null;
    readonly repair: (Repair | MakeSolid)[];
    readonly frameLimit: number;
    /** Seconds. */
    readonly timeStep: number;
    /** The names of the files of a mesh cloth; null for a sheet or a generated shape. */
    readonly clothFile: string | null;
    readonly clothRestFile: string | null;
    /** The number of particles of a sheet; null for a mesh cloth, and if there are bodies. */
    readonly particleCount: number | null;
    /** The generated shape, repaired by the scene's options. @throws InvalidScene for a file: read and repair() it instead */
    makeModel(): Mesh;
    /** Builds a map with the scene's options. */
    buildMap(mesh: Mesh): AnyMap;
    /**
     * The scene's cloth, bodies and colliders, ready to step. The map need not be of the kind that the scene requests.
     * @param maps     the map of the collider, or one for each of `colliders`, in their order
     * @param options  allowOpenCollider: accept the exact map of an open mesh, whose holes particles may pass through;
     *                 cloth, clothAtRest: the meshes of clothFile and clothRestFile, welded; bodies: for each body its
     *                 closed surface, which is filled with tetrahedra; null for a generated shape
     * @throws InvalidOptions for the exact map of an open mesh without allowOpenCollider, if the number of maps differs
     * from that of colliders, if a mesh is missing, and if surfaces collide and the initial state intersects;
     * InvalidMesh if a mesh cannot be a cloth
     */
    makeSimulation(
        maps: AnyMap | readonly AnyMap[],
        options?: { allowOpenCollider?: boolean; cloth?: Mesh; clothAtRest?: Mesh; bodies?: readonly (Mesh | null)[] },
    ): Simulation;
}

/** Cloth and soft bodies among colliders. The same scene and map give the same positions, bit for bit, in every browser and in native C++. */
export class Simulation extends Deletable {
    readonly particleCount: number;
    /** [3 particleCount] A read-only view of the simulation's own memory: get it afresh each time, as with a buffer. */
    readonly positions: Float32Array;
    /** [3 particleCount] Units per second; a view like that of the positions. */
    readonly velocities: Float32Array;
    /** [3 face_count] particles; a copy, constant over time. */
    readonly faces: Uint32Array;
    readonly frame: number;
    readonly atRest: boolean;
    /** Units per second; infinite before the first frame. */
    readonly largestSpeed: number;
    /** 16 hexadecimal digits, a hash of the bits of all positions and velocities. */
    readonly stateHash: string;
    /**
     * The relative deviation of structural constraints from their rest lengths at the end of the last
     * frame; 0 without such constraints. With `jakobsen` it is the residual error of the relaxations.
     */
    readonly residual: { readonly rootMeanSquare: number; readonly largest: number };
    /** Times and counts since the simulation began. */
    readonly profile: SimulationProfile;
    readonly colliderCount: number;
    /** The first collider. */
    readonly collider: ColliderState;
    colliderAt(index: number): ColliderState;

    /** @throws Diverged; afterwards only reading is allowed */
    step(frameCount?: number): void;
    /**
     * A simulation of the same particles and colliders in their present state, with the solver, material, thickness and
     * gravity of another scene: for options that change while the cloth falls. The frame number and the profile start
     * again at 0. Delete the old simulation.
     * @param maps  one for each of the scene's colliders. Colliders that this simulation does not have yet are added
     *              with the poses of the scene, and colliders beyond those of the scene are removed. By default the
     *              colliders stay
     * @throws InvalidOptions when surfaces collide in the scene and the cloth intersects something now, unless the
     * scene sets `untangle`
     */
    continueWith(scene: Scene, maps?: AnyMap | readonly AnyMap[]): Simulation;
    /**
     * Moves a collider, the first by default, freely from its present velocities: a rigid body of uniform density,
     * moved by gravity and by contact with the cloth. Needs an exact map of a closed mesh and the solver `newton`.
     * @param mass  kg, 1e-9 to 1e15
     * @throws InvalidOptions; in that case nothing changes
     */
    setColliderFree(mass: number, index?: number): void;
    /**
     * The load that the cloth exerted on a collider in the last frame by contact, friction and attached particles,
     * averaged over the frame; in N and N m.
     */
    loadOn(index?: number): { readonly force: Vec3; readonly torque: Vec3 };
    /** Sets whether the following frames record their contacts; off by default. */
    recordContacts(isOn?: boolean): void;
    /** Copies of the contacts that were recorded in the last frame. */
    readonly contactPoints: ContactPoints;
    /**
     * Sets the velocities of a collider, by default the first, in units and radians per second. The collider keeps them
     * until they are set again.
     */
    setColliderVelocity(linear: Vec3, angular: Vec3, index?: number): void;
    /**
     * Deforms a collider, by default the first: during the next step the vertices of its mesh move to these positions
     * along straight lines; then they stop. The faces stay the same, and the pose is independent and may change at the
     * same time. Faces of the cloth are kept off the moving faces as they are off any others, and attached particles
     * follow the face that was nearest to them when the collider first deformed. The exact map is rebuilt, which takes
     * about a microsecond per face.
     * @param vertices  [3 vertexCount] in the collider's frame, in the order of the mesh from which its
     *                  map was built; copied, unless they are a PointBuffer
     * @throws InvalidOptions for a different number of vertices, a vertex that is not finite, a collider without an
     * exact map, or a scene in which only particles collide; InvalidMesh if no map can be built. If it throws, nothing
     * has changed
     */
    setColliderVertices(vertices: PointBuffer | Float32Array, index?: number): void;

    /**
     * Sets the velocity of a particle, in units per second. Before each step, a page that drags particles with the
     * pointer sets the velocity of the grabbed particle and its near neighbours to (target of the pointer - present
     * position) / (about 5 time steps): the cloth pulls at them and the collider stops them, so none of them is dragged
     * into the model.
     */
    setParticleVelocity(particle: number, velocity: Vec3): void;
    /**
     * Sets the wind for one frame; call it before each step.
     * @param wind  velocity of the air, units per second
     * @param rate  the rate at which the cloth takes on the wind's velocity along the normals of its faces, per second:
     *              1 to 10 for cloth
     */
    blow(wind: Vec3, rate: number): void;

    /** Tells which particles are now inside the first collider, according to its map. */
    containsBatch(inside: FlagBuffer): FlagBuffer;
    /**
     * The contacts of the particles with the first collider, in world units, for instance to colour the cloth by depth.
     */
    contactsBatch(margin: number, contacts: ContactBuffer): ContactBuffer;
}

/** The contacts of the cloth with colliders and with itself in one frame. */
export interface ContactPoints {
    /** [3 count] points of contact on the cloth when the contact last exerted a force, in world coordinates. */
    readonly positions: Float64Array;
    /**
     * [3 count] unit normals, which point towards the cloth or, in self-collision, towards the first of the two
     * elements.
     */
    readonly normals: Float64Array;
    /** [count] the gap when the contact last exerted a force. */
    readonly gaps: Float64Array;
    /**
     * [count] the impulse of the frame along the normal, N s, on the cloth or, in self-collision, on the first element.
     */
    readonly normalImpulses: Float64Array;
    /** [3 count] the impulse of friction in the frame, perpendicular to the normal, N s. */
    readonly frictionImpulses: Float64Array;
    /** [count] the index of the collider; -1 for a contact of the cloth with itself. */
    readonly colliders: Int32Array;
    /**
     * [4 count] the particles of the cloth's element in contact, followed in self-collision by those of the second
     * element: a vertex and the three corners of a face, or the two ends of each edge; -1 for unused entries.
     */
    readonly particles: Int32Array;
}

/** As in echinus/simulation.hpp. Queries are counted for all particles and relaxations. */
export interface SimulationProfile {
    integrationSeconds: number;
    constraintSeconds: number;
    collisionSeconds: number;
    queryCount: number;
    contactCount: number;
    mapQueryCount: number;
    /** Number of times that a particle was moved back to a free position at the end of a frame. */
    rescuedCount: number;
    /**
     * Number of times that a particle that had once been free of an exact map ended a frame inside it or on the other
     * side of its surface.
     */
    lostCount: number;
    /** If surfaces collide: number of times that the displacement of a particle was truncated. */
    truncatedCount: number;
    /** If surfaces collide: number of vertex-face and edge-edge pairs whose distance was measured. */
    measuredPairCount: number;
    /**
     * The number of unresolved pairs of elements, for which no free space was proven, summed over all steps. If it is
     * 0, no faces intersect.
     */
    unresolvedCount: number;
}

/** point_world = rotation applied to (scale * point_local), + position. */
export interface ColliderState {
    position: [number, number, number];
    /** A unit quaternion w, x, y, z. */
    rotation: [number, number, number, number];
    scale: [number, number, number];
    linearVelocity: [number, number, number];
    angularVelocity: [number, number, number];
}

export {};
