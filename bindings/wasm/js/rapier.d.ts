/** Soft bodies of Rapier kept out of models by their maps. docs/wasm.md. */
import type { RigidBody, SoftBody } from '@dimforge/rapier3d-compat';
import type { Collision, CollisionOptions, Echinus, PlacedMap } from 'echinus';

export interface RapierCollisionOptions extends Omit<CollisionOptions, 'positions' | 'colliders'> {
    /** A collider with a body stands where its body does, and moves along: `position` and `rotation` are then the body's. */
    colliders: readonly (PlacedMap & { body?: RigidBody })[];
}

/**
 * After each World.step(), step() takes back what led the particles of a soft body into a model. Give the same model no
 * collider that meets the soft body in Rapier. Pinned particles stay as they are. With `surfaces`, `faces` is the body's
 * boundary() unless given. A body that tears needs a new collision. Four steps of 1/240 s stretch a cloth less than one of 1/60 s.
 */
export class RapierCollision {
    constructor(echinus: Echinus, softBody: SoftBody, options: RapierCollisionOptions);
    readonly collision: Collision;
    /** @param seconds  World.timestep  @returns how many particles were moved */
    step(seconds: number): number;
    delete(): void;
    [Symbol.dispose](): void;
}
