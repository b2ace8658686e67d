/** Soft bodies of Jolt kept out of models by their maps. docs/wasm.md. */
import type Jolt from 'jolt-physics';
import type { Collision, CollisionOptions, Echinus, PlacedMap } from 'echinus';

export interface JoltCollisionOptions extends Omit<CollisionOptions, 'positions' | 'faces' | 'colliders'> {
    /** A collider with a body stands where its body does, and moves along: `position` and `rotation` are then the body's. */
    colliders: readonly (PlacedMap & { body?: Jolt.Body })[];
}

/**
 * After each JoltInterface.Step() of the soft body, step() takes back what led its vertices into a model. Leave shapes of
 * the same model out of the soft body's collision in Jolt, by its object layers. Vertices whose mInvMass is 0 at that time stay as they are. Four steps of 1/240 s stretch a cloth less than one of 1/60 s.
 */
export class JoltCollision {
    /**
     * @param jolt  what the package's function resolves to
     * @param body  a soft body, whose mMakeRotationIdentity was true
     */
    constructor(echinus: Echinus, jolt: typeof Jolt, body: Jolt.Body, options: JoltCollisionOptions);
    readonly collision: Collision;
    /** @param seconds  that Step() took  @returns how many vertices were moved */
    step(seconds: number): number;
    delete(): void;
    [Symbol.dispose](): void;
}
