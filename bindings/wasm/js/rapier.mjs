/** Soft bodies of Rapier, the packages rapier3d and rapier3d-compat, kept out of models by their maps. */
import { EngineCollision } from './engine_collision.mjs';
import { refuse } from './errors.mjs';

export class RapierCollision extends EngineCollision {
    #softBody;

    constructor(echinus, softBody, options) {
        super(echinus, softBody.particlePositions(), options?.surfaces ? { faces: softBody.boundary(), ...options } : options, poseOf);
        this.#softBody = softBody;
    }

    step(seconds) {
        const { collision } = this;
        const now = this.#softBody.particlePositions();
        if (now.length !== collision.positions.length) refuse(`the soft body has ${now.length / 3} particles now, and had ${collision.particleCount}: make a new collision for it`);
        collision.positions.set(now);
        this.followBodies();
        const count = collision.correct(seconds);
        const { corrected, positions, velocities } = collision;
        for (const i of corrected) {
            if (this.#softBody.isParticlePinned(i)) continue;
            this.#softBody.setParticlePosition(i, vectorAt(positions, i));
            this.#softBody.setParticleVelocity(i, vectorAt(velocities, i));
        }
        return count;
    }
}

const vectorAt = (numbers, i) => ({ x: numbers[3 * i], y: numbers[3 * i + 1], z: numbers[3 * i + 2] });

function poseOf(body) {
    const position = body.translation();
    const rotation = body.rotation();
    return { position: [position.x, position.y, position.z], rotation: [rotation.w, rotation.x, rotation.y, rotation.z] };
}
