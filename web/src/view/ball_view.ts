import * as THREE from 'three';
import type { Triple } from '../protocol';
import { TOOL } from './colours';
import { matte } from './matte';

/** The ball that the visitor leads. */
export class BallView {
    readonly mesh = new THREE.Mesh(new THREE.SphereGeometry(1, 40, 24), matte(TOOL));

    constructor() {
        this.mesh.visible = false;
        this.mesh.castShadow = this.mesh.receiveShadow = true;
    }

    show(ball: { radius: number; position?: Triple } | undefined): void {
        this.mesh.visible = ball?.position !== undefined;
        if (!ball?.position) return;
        this.mesh.position.set(...ball.position);
        this.mesh.scale.setScalar(ball.radius);
    }
}
