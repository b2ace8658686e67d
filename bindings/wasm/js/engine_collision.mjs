import { refuse } from './errors.mjs';

/** Common to the adapters to engines: a collision whose colliders follow rigid bodies of the engine. */
export class EngineCollision {
    #collision;
    #followers;

    /**
     * @param positions  [3 n] of the soft body's particles
     * @param poseOf     position and rotation (w, x, y, z) of a rigid body of the engine
     */
    constructor(echinus, positions, { colliders, ...options } = {}, poseOf) {
        if (!Array.isArray(colliders) || colliders.some((collider) => collider === null || typeof collider !== 'object'))
            refuse('colliders must be an array of objects, each with a map');
        const placed = colliders.map(({ body, ...collider }) => (body ? { ...collider, ...poseOf(body) } : collider));
        this.#followers = colliders.flatMap(({ body }, i) => (body ? [{ i, pose: () => poseOf(body), last: placed[i] }] : []));
        this.#collision = echinus.makeCollision({ ...options, positions, colliders: placed });
    }

    get collision() {
        return this.#collision;
    }

    /** Colliders of bodies that have moved since the last step move with them. */
    followBodies() {
        for (const follower of this.#followers) {
            const pose = follower.pose();
            if (isSame(pose, follower.last)) continue;
            follower.last = pose;
            this.#collision.setColliderPose(follower.i, pose.position, pose.rotation);
        }
    }

    delete() {
        this.#collision.delete();
    }
}
EngineCollision.prototype[Symbol.dispose ?? Symbol.for('Symbol.dispose')] = EngineCollision.prototype.delete;

const isSame = (a, b) => a.position.every((c, k) => c === b.position[k]) && a.rotation.every((c, k) => c === b.rotation[k]);
