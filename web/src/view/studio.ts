import * as THREE from 'three';
import { BACKDROP, GROUND } from './colours';
import { spot } from './material';

/** Of the ground, in radii of what is in sight. */
const GROUND_RADIUS = 5;

/** Resolution of the shadow, and how far from what is in sight it reaches, in radii. */
const SHADOW_SIDE = 2048, SHADOW_REACH = 2.3;

/** Light, ground and backdrop, about what is in sight. */
export class Studio {
    readonly #scene: THREE.Scene;
    readonly #sun = new THREE.DirectionalLight(0xfff4e6, 2.7);
    /** From the camera, so that surfaces seen from below, away from sun and sky, keep their colour. */
    readonly #lamp = new THREE.DirectionalLight(0xffffff, 0.7);
    readonly #sky = new THREE.HemisphereLight(0xffffff, 0x6f675d, 1.25);
    /** From behind, which parts the model from the backdrop. */
    readonly #rim = new THREE.DirectionalLight(0xcfe0f2, 0);
    /** Where the light falls on the ground. */
    readonly #pool = new THREE.Mesh(new THREE.CircleGeometry(GROUND_RADIUS, 48), new THREE.MeshBasicMaterial({ map: spot(), transparent: true, depthWrite: false }));
    /** Under the model, in place of a shadow in the light look. */
    readonly #stain = new THREE.Mesh(this.#pool.geometry, new THREE.MeshBasicMaterial({ map: spot(), color: 0, transparent: true, opacity: 0.3, depthWrite: false }));
    readonly #shadow = new THREE.Mesh(this.#pool.geometry, new THREE.ShadowMaterial({ opacity: 0.34 }));
    readonly ground = new THREE.Group();
    #fine = false;

    constructor(scene: THREE.Scene) {
        this.#scene = scene;
        this.ground.add(this.#pool, this.#stain, this.#shadow);
        [this.#pool, this.#stain, this.#shadow].forEach((part, order) => (part.renderOrder = order - 4)); // before everything else that is transparent
        this.#shadow.receiveShadow = true;
        const { shadow } = this.#sun;
        shadow.mapSize.setScalar(SHADOW_SIDE);
        shadow.radius = 3.5;
        scene.add(this.#sun, this.#sun.target, this.#sky, this.#lamp, this.#lamp.target, this.#rim, this.#rim.target, this.ground);
        const dark = matchMedia('(prefers-color-scheme: dark)');
        dark.addEventListener('change', () => this.#paint(dark.matches));
        this.#paint(dark.matches);
        this.fine = false;
    }

    #paint(dark: boolean): void {
        this.#scene.background = new THREE.Color(dark ? BACKDROP.dark : BACKDROP.light);
        this.#pool.material.color.set(dark ? GROUND.dark : GROUND.light);
        this.#shadow.material.opacity = dark ? 0.55 : 0.34;
        this.#stain.material.opacity = dark ? 0.45 : 0.17;
    }

    /** @param axes  up, the axis before it and the one after it @param floor  along up */
    surround(centre: THREE.Vector3, radius: number, [upward, sideways, forward]: readonly THREE.Vector3[], floor: number): void {
        const from = (up: number, side: number, front: number) =>
            centre.clone().addScaledVector(upward, up * radius).addScaledVector(sideways, side * radius).addScaledVector(forward, front * radius);
        // Low and from the side, so that shadows reveal the folds.
        this.#sun.position.copy(this.#fine ? from(3.4, -0.3, 2.1) : from(2.2, -0.6, 2.6));
        this.#sun.target.position.copy(centre);
        this.#rim.position.copy(from(1.6, -2, -2));
        this.#rim.target.position.copy(centre);
        this.#sky.position.copy(upward);
        const { camera } = this.#sun.shadow;
        camera.left = camera.bottom = -SHADOW_REACH * radius;
        camera.right = camera.top = SHADOW_REACH * radius;
        camera.near = 0.5 * radius;
        camera.far = 8 * radius;
        camera.updateProjectionMatrix();
        this.#sun.shadow.bias = -0.0006;
        this.#sun.shadow.normalBias = 0.012 * radius;
        this.ground.position.copy(centre).addScaledVector(upward, floor - upward.dot(centre));
        this.ground.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), upward);
        this.ground.scale.setScalar(radius);
        this.#stain.scale.setScalar(1.05 / GROUND_RADIUS);
        this.#surrounded = [centre.clone(), radius, [upward, sideways, forward], floor];
    }
    #surrounded: Parameters<Studio['surround']> | undefined;

    follow(camera: THREE.Camera, target: THREE.Vector3): void {
        this.#lamp.position.copy(camera.position);
        this.#lamp.target.position.copy(target);
    }

    set fine(on: boolean) {
        this.#fine = on;
        this.#sun.castShadow = on;
        this.#shadow.visible = on;
        this.#stain.visible = !on;
        this.#sun.intensity = on ? 2.6 : 2.7;
        this.#lamp.intensity = on ? 0.35 : 0.7;
        this.#sky.intensity = on ? 1.35 : 1.25;
        this.#rim.intensity = on ? 0.9 : 0;
        this.#rim.visible = on;
        if (this.#surrounded) this.surround(...this.#surrounded);
    }
}
