/** Soft bodies of Jolt, the package jolt-physics, kept out of models by their maps. */
import { EngineCollision } from './engine_collision.mjs';
import { EchinusError } from './errors.mjs';

export class JoltCollision extends EngineCollision {
    #jolt;
    #body;
    #vertices;

    constructor(echinus, jolt, body, options) {
        const motion = jolt.castObject(body.GetMotionProperties(), jolt.SoftBodyMotionProperties);
        const vertices = verticesOf(jolt, motion.GetVertices());
        const positions = new Float32Array(3 * vertices.count);
        readPositions(jolt.HEAPF32, vertices, centreOf(body), positions);
        super(echinus, positions, { faces: facesOf(motion.GetFaces()), ...options }, poseOf);
        this.#jolt = jolt;
        this.#body = body;
        this.#vertices = vertices;
    }

    step(seconds) {
        const { collision } = this;
        const centre = centreOf(this.#body);
        readPositions(this.#jolt.HEAPF32, this.#vertices, centre, collision.positions);
        this.followBodies();
        const count = collision.correct(seconds);
        writeCorrected(this.#jolt.HEAPF32, this.#vertices, centre, collision);
        return count;
    }
}

/**
 * Where the vertices of a soft body lie in the memory of Jolt, which is asked there: calls of Jolt for each of them would
 * take longer than the collision. In floats of the memory.
 */
function verticesOf(jolt, array) {
    const count = array.size();
    const first = jolt.getPointer(array.at(0));
    const traits = jolt.SoftBodyVertexTraits.prototype;
    return {
        count,
        position: (first + traits.mPositionOffset) >>> 2,
        velocity: (first + traits.mVelocityOffset) >>> 2,
        array,
        stride: count > 1 ? (jolt.getPointer(array.at(1)) - first) >>> 2 : 0,
    };
}

/** Vertices lie relative to this point, along the world's axes. @throws EchinusError for a body that is turned */
function centreOf(body) {
    const rotation = body.GetRotation();
    if (Math.abs(rotation.GetW()) < 1 - 1e-6)
        throw new EchinusError('InvalidArgument', 'the soft body is turned: leave mMakeRotationIdentity of its settings true');
    const centre = body.GetPosition();
    return [centre.GetX(), centre.GetY(), centre.GetZ()];
}

function readPositions(heap, { count, position, stride }, [x, y, z], positions) {
    for (let i = 0, from = position; i < count; ++i, from += stride) {
        positions[3 * i] = heap[from] + x;
        positions[3 * i + 1] = heap[from + 1] + y;
        positions[3 * i + 2] = heap[from + 2] + z;
    }
}

function writeCorrected(heap, { array, position, velocity, stride }, centre, { corrected, positions, velocities }) {
    for (const i of corrected) {
        if (array.at(i).mInvMass === 0) continue; // pinned
        for (let k = 0; k < 3; ++k) {
            heap[position + i * stride + k] = positions[3 * i + k] - centre[k];
            heap[velocity + i * stride + k] = velocities[3 * i + k];
        }
    }
}

function facesOf(faces) {
    return Uint32Array.from({ length: 3 * faces.size() }, (_, i) => faces.at(Math.floor(i / 3)).get_mVertex(i % 3));
}

function poseOf(body) {
    const position = body.GetPosition();
    const place = [position.GetX(), position.GetY(), position.GetZ()]; // read before Jolt uses its memory for the rotation
    const rotation = body.GetRotation();
    return { position: place, rotation: [rotation.GetW(), rotation.GetX(), rotation.GetY(), rotation.GetZ()] };
}
