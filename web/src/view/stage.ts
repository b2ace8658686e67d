import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Triple } from '../protocol';
import type { Axis } from '../settings';
import { BACKDROP } from './colours';

const UP: Record<Axis, Triple> = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

/** The canvas, the camera and the light: what is the same whatever is shown. */
export class Stage {
    readonly scene = new THREE.Scene();
    readonly camera = new THREE.PerspectiveCamera(30, 1, 0.01, 100);
    readonly renderer: THREE.WebGLRenderer;
    #controls: OrbitControls;
    readonly #sun = new THREE.DirectionalLight(0xfff4e6, 2.7);
    readonly #sky = new THREE.HemisphereLight(0xffffff, 0x6f675d, 1.25);
    readonly #canvas: HTMLCanvasElement;

    constructor(canvas: HTMLCanvasElement) {
        this.#canvas = canvas;
        this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: false });
        this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
        this.renderer.localClippingEnabled = true;
        this.#controls = new OrbitControls(this.camera, canvas);
        this.scene.add(this.#sun, this.#sun.target, this.#sky);

        const dark = matchMedia('(prefers-color-scheme: dark)');
        const paint = () => (this.scene.background = new THREE.Color(dark.matches ? BACKDROP.dark : BACKDROP.light));
        dark.addEventListener('change', paint);
        paint();
        new ResizeObserver(() => this.#fit()).observe(canvas);
        this.#fit();
    }

    /** Puts the camera where all of a sphere, and the cloth above it, is in sight. */
    lookAt(centre: Triple, radius: number, up: Axis): void {
        const [a, b, c] = UP[up];
        this.camera.up.set(a, b, c);
        // The controls take the camera's up when they are made.
        this.#controls.dispose();
        this.#controls = new OrbitControls(this.camera, this.#canvas);
        this.#controls.enableDamping = true;
        this.#controls.dampingFactor = 0.12;
        this.#controls.minDistance = 0.2 * radius;
        this.#controls.maxDistance = 20 * radius;

        const upward = new THREE.Vector3(a, b, c);
        const middle = new THREE.Vector3(...centre).addScaledVector(upward, 0.12 * radius);
        const sideways = new THREE.Vector3(b, c, a), forward = new THREE.Vector3(c, a, b);
        // Narrow screens see less to the sides, so the camera steps back.
        const distance = 5.6 * radius * Math.max(1, 1.2 / this.camera.aspect);
        const from = sideways.clone().multiplyScalar(0.8).addScaledVector(forward, 0.55).addScaledVector(upward, 0.34).normalize();
        this.camera.position.copy(middle).addScaledVector(from, distance);
        this.camera.near = 0.02 * radius;
        this.camera.far = 40 * radius;
        this.camera.updateProjectionMatrix();
        this.#controls.target.copy(middle);
        this.#controls.update();

        // Low and from the side: folds show by their shadows.
        this.#sun.position.copy(middle).addScaledVector(upward, 2.2 * radius).addScaledVector(sideways, -0.6 * radius).addScaledVector(forward, 2.6 * radius);
        this.#sun.target.position.copy(middle);
        this.#sky.position.copy(upward);
    }

    set orbiting(enabled: boolean) {
        this.#controls.enabled = enabled;
    }

    draw(): void {
        this.#controls.update();
        this.renderer.render(this.scene, this.camera);
    }

    /** What is on the canvas now, as a PNG file. */
    picture(): Promise<Blob> {
        this.draw(); // the browser may have cleared the canvas since
        return new Promise((resolve, reject) =>
            this.#canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('the browser gives no picture of its canvas'))), 'image/png'),
        );
    }

    #fit(): void {
        const { clientWidth: width, clientHeight: height } = this.#canvas;
        if (width === 0 || height === 0) return;
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
    }
}
