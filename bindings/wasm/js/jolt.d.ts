/** Keeps soft bodies of Jolt out of models: docs/wasm.md. */
import type Jolt from 'jolt-physics';
import type { Collision, CollisionOptions, Echinus, PlacedMap } from 'echinus';

export interface JoltCollisionOptions extends Omit<CollisionOptions, 'positions' | 'faces' | 'colliders'> {
    /** A collider with a body follows it: `position` and `rotation` are then those of the body. */
    colliders: readonly (PlacedMap & { body?: Jolt.Body })[];
}

/**
 * After each JoltInterface.Step(), step() moves vertices of the soft body that entered or crossed a model back out. Use
 * object layers to disable Jolt's own collision between the soft body and the same model. Vertices whose mInvMass is 0
 * at that time are not moved. Four steps of 1/240 s stretch a cloth less than one of 1/60 s.
 */
export class JoltCollision {
    /**
     * @param jolt  the result of the package's function
     * @param body  a soft body that was created with mMakeRotationIdentity
     */
    constructor(echinus: Echinus, jolt: typeof Jolt, body: Jolt.Body, options: JoltCollisionOptions);
    readonly collision: Collision;
    /** @param seconds  the duration of Step()  @returns the number of vertices that were moved */
    step(seconds: number): number;
    delete(): void;
    [Symbol.dispose](): void;
}
