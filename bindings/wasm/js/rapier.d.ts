/** Keeps soft bodies of Rapier out of models: docs/wasm.md. */
import type { RigidBody, SoftBody } from '@dimforge/rapier3d-compat';
import type { Collision, CollisionOptions, Echinus, PlacedMap } from 'echinus';

export interface RapierCollisionOptions extends Omit<CollisionOptions, 'positions' | 'colliders'> {
    /** A collider with a body follows it: `position` and `rotation` are then those of the body. */
    colliders: readonly (PlacedMap & { body?: RigidBody })[];
}

/**
 * After each World.step(), step() moves particles of the soft body that entered or crossed a model back out. In Rapier
 * the same model must have no collider that meets the soft body. Pinned particles are not moved. With `surfaces`,
 * `faces` is by default the body's boundary(). A body that tears needs a new collision. Four steps of 1/240 s stretch a
 * cloth less than one of 1/60 s.
 */
export class RapierCollision {
    constructor(echinus: Echinus, softBody: SoftBody, options: RapierCollisionOptions);
    readonly collision: Collision;
    /** @param seconds  World.timestep  @returns the number of particles that were moved */
    step(seconds: number): number;
    delete(): void;
    [Symbol.dispose](): void;
}
