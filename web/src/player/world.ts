import * as THREE from 'three';
import { AXES, type Axis } from '../axes';
import type { FrameArrays } from '../protocol';
import { ClothView } from '../view/cloth_view';
import { ModelView } from '../view/model_view';
import type { Stage } from '../view/stage';
import type { Description } from './description';
import { surfaceNormals } from './normals';
import type { Recording } from './recording';

/** Model and cloth of a recording on a stage. */
export class World {
    readonly #recording: Recording;
    readonly #cloth = new ClothView();
    readonly #model = new ModelView();
    #spare: FrameArrays;

    constructor(stage: Stage, recording: Recording) {
        this.#recording = recording;
        const { figures, model } = recording.description;
        this.#spare = arraysFor(figures.particles);
        const none = new Uint32Array(0);
        this.#model.show({
            vertices: recording.modelVertices,
            faces: recording.modelFaces,
            faults: { borderEdges: none, nonmanifoldEdges: none, misorientedEdges: none, duplicateFaces: none, degenerateFaces: none },
        });
        this.#cloth.begin(recording.clothFaces);

        const { axis, turn } = upright(figures.gravity);
        const group = new THREE.Group();
        group.quaternion.copy(turn);
        group.add(this.#model.group, this.#cloth.mesh);
        stage.scene.add(group);
        const { position, rotation: [w, x, y, z] } = recording.description.frames[0].pose!;
        const centre = new THREE.Vector3(...model.centre).applyQuaternion(new THREE.Quaternion(x, y, z, w)).add(new THREE.Vector3(...position));
        stage.lookAt(centre.applyQuaternion(turn).toArray(), model.radius, axis);
    }

    show(frame: number): void {
        const { frames, figures } = this.#recording.description;
        const arrays = this.#spare;
        this.#recording.positionsOf(frame, arrays.positions);
        surfaceNormals(arrays.positions, this.#recording.clothFaces, arrays.normals);
        this.#spare = this.#cloth.show(arrays) ?? arraysFor(figures.particles);
        const { pose } = frames[frame];
        if (pose) this.#model.follow(pose);
    }
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
