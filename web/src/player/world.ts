import * as THREE from 'three';
import { AXES, type Axis } from '../frames';
import type { ClothNews, FrameArrays } from '../protocol';
import { ClothView } from '../view/cloth_view';
import { ModelView } from '../view/model_view';
import type { Stage } from '../view/stage';
import type { Description, Part, Pose, RecordedFrame, Recording } from './recording';
import { surfaceNormals } from '../normals';

/** By how much of its width a flat cloth may rise, and a square one be shorter. */
const FLAT = 0.001;

/** Model and cloth of a recording on a stage. */
export class World {
    readonly #recording: Recording;
    readonly #cloth = new ClothView();
    readonly #models: ModelView[] = [];
    #spare: FrameArrays;
    readonly #ahead: Float32Array;
    #begun = false;

    constructor(stage: Stage, recording: Recording) {
        this.#recording = recording;
        const { figures, model } = recording.description;
        this.#spare = arraysFor(figures.particles);
        this.#ahead = new Float32Array(3 * figures.particles);
        const parts: Part[] = model.parts ?? [model];
        let firstVertex = 0, firstFace = 0;
        for (const { vertices, faces } of parts) {
            this.#addModel(
                recording.modelVertices.slice(3 * firstVertex, 3 * (firstVertex + vertices)),
                recording.modelFaces.slice(3 * firstFace, 3 * (firstFace + faces)),
            );
            firstVertex += vertices;
            firstFace += faces;
        }

        const { axis, turn } = upright(figures.gravity);
        const group = new THREE.Group();
        group.quaternion.copy(turn);
        group.add(...this.#models.map((view) => view.group), this.#cloth.group);
        stage.scene.add(group);
        const first = posesOf(recording.description.frames[0])!;
        // Of several colliders it is where they start.
        const centre = model.parts ? new THREE.Vector3(...model.centre) : placed(model.centre, first[0]);
        const placing = model.parts ? undefined : first[0];
        const floor = lowest(recording.modelVertices, placing, turn, axis);
        stage.lookAt({ centre: centre.applyQuaternion(turn).toArray(), radius: model.radius, up: axis, floor });
        stage.onLook = (fine) => (this.#cloth.fine = fine);
        stage.look = 'auto';
    }

    #addModel(vertices: Float32Array<ArrayBuffer>, faces: Uint32Array<ArrayBuffer>): void {
        const none = new Uint32Array(0);
        const view = new ModelView();
        view.show({
            vertices,
            faces,
            faults: { borderEdges: none, nonmanifoldEdges: none, misorientedEdges: none, duplicateFaces: none, degenerateFaces: none },
        });
        this.#models.push(view);
    }

    /** Once the first frame has been read. */
    #begin(): void {
        const { figures, model } = this.#recording.description;
        this.#recording.positionsOf(0, this.#ahead);
        this.#cloth.begin({ faces: this.#recording.clothFaces, thickness: figures.thickness, ...fabricOf(this.#ahead, model.radius) });
        this.#begun = true;
    }

    /** @param share  of the way to the next frame */
    show(frame: number, share: number): void {
        const { frames, figures } = this.#recording.description;
        if (!this.#begun) this.#begin();
        const arrays = this.#spare;
        this.#recording.positionsBetween(frame, share, arrays.positions, this.#ahead);
        surfaceNormals(arrays.positions, this.#recording.clothFaces, arrays.normals);
        this.#spare = this.#cloth.show(arrays) ?? arraysFor(figures.particles);
        const next = share > 0 ? posesOf(frames[frame + 1]) : undefined;
        posesOf(frames[frame])?.forEach((pose, i) => this.#models[i].follow(next ? between(pose, next[i], share) : pose));
    }
}

/** Of a cloth that begins flat: its places on the fabric, in radii, and the border of a square one. Of others no fabric is known. */
function fabricOf(positions: Float32Array, radius: number): Partial<ClothNews> {
    const bounds = [0, 1, 2].map((k) => {
        let least = Infinity, most = -Infinity;
        for (let i = k; i < positions.length; i += 3) [least, most] = [Math.min(least, positions[i]), Math.max(most, positions[i])];
        return { k, least, size: most - least };
    });
    const [wide, long, high] = bounds.sort((a, b) => b.size - a.size || a.k - b.k);
    if (high.size > FLAT * wide.size) return {};
    const weave = new Float32Array((2 * positions.length) / 3);
    let toCorner = Infinity; // a disc has none
    for (let i = 0; i < weave.length; i += 2) {
        [wide, long].forEach(({ k, least }, j) => (weave[i + j] = (positions[1.5 * i + k] - least) / radius));
        toCorner = Math.min(toCorner, weave[i] + weave[i + 1]);
    }
    const edge = wide.size / radius;
    return { weave, ...(long.size > (1 - FLAT) * wide.size && toCorner < FLAT * edge && { hem: edge }) };
}

function between(from: Pose, to: Pose, share: number): Pose {
    const turn = ({ rotation: [w, x, y, z] }: Pose) => new THREE.Quaternion(x, y, z, w);
    const { x, y, z, w } = turn(from).slerp(turn(to), share);
    const position = new THREE.Vector3(...from.position).lerp(new THREE.Vector3(...to.position), share);
    return { position: position.toArray(), rotation: [w, x, y, z] };
}

/** Of a model where it starts; of several as they lie in their files. */
function lowest(vertices: Float32Array, pose: Pose | undefined, turn: THREE.Quaternion, up: Axis): number {
    const k = AXES.indexOf(up);
    let least = Infinity;
    const point: [number, number, number] = [0, 0, 0];
    for (let i = 0; i < vertices.length; i += 3) {
        point[0] = vertices[i];
        point[1] = vertices[i + 1];
        point[2] = vertices[i + 2];
        const place = pose ? placed(point, pose) : new THREE.Vector3(...point);
        least = Math.min(least, place.applyQuaternion(turn).getComponent(k));
    }
    return least;
}

const posesOf = (frame: RecordedFrame): Pose[] | undefined => frame.poses ?? (frame.pose && [frame.pose]);

function placed(point: [number, number, number], { position, rotation: [w, x, y, z] }: Pose): THREE.Vector3 {
    return new THREE.Vector3(...point).applyQuaternion(new THREE.Quaternion(x, y, z, w)).add(new THREE.Vector3(...position));
}

const arraysFor = (particles: number): FrameArrays => ({
    positions: new Float32Array(3 * particles),
    normals: new Float32Array(3 * particles),
    depths: new Float32Array(particles),
});

/** The axis that points up, and the rotation that aligns a slanted gravity with it. */
function upright(gravity: Description['figures']['gravity']): { axis: Axis; turn: THREE.Quaternion } {
    const up = new THREE.Vector3(...gravity).negate();
    if (up.lengthSq() === 0) up.set(0, 0, 1);
    up.normalize();
    const sizes = up.toArray().map(Math.abs);
    const k = sizes.indexOf(Math.max(...sizes));
    const axis = new THREE.Vector3().setComponent(k, 1);
    return { axis: AXES[k], turn: new THREE.Quaternion().setFromUnitVectors(up, axis) };
}
