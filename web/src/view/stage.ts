import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Axis } from '../frames';
import type { Triple } from '../protocol';
import type { Settings } from '../settings';
import { type Standpoint, fromText, toText } from '../standpoint';
import { ContactShading } from './contact_shading';
import { Studio } from './studio';

/** A picture that takes longer than this is drawn more lightly. */
const LONG_MS = 26;
/** Of so many pictures. */
const COUNT = 40;
/** Compiling takes long, and is not repeated. */
const FIRST = 20;

/** Judges whether pictures come quickly enough, by the times between them. */
class Pace {
    #last = 0;
    #times: number[] = [];
    #seen = 0;

    /** Call for each picture. @returns whether the typical one has taken too long, once, after enough of them */
    isSlow(now: number): boolean {
        const took = now - this.#last;
        this.#last = now;
        // A hidden page draws nothing, and is not slow.
        if (++this.#seen < FIRST || took > 500) return false;
        this.#times.push(took);
        if (this.#times.length < COUNT) return false;
        const median = this.#times.sort((a, b) => a - b)[COUNT >> 1];
        this.#times = [];
        return median > LONG_MS;
    }
}

/** Does the processor draw, in place of a graphics card? */
function drawsInSoftware(context: WebGL2RenderingContext | WebGLRenderingContext): boolean {
    const info = context.getExtension('WEBGL_debug_renderer_info');
    const name = String(context.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : context.RENDERER));
    return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

type Axes = readonly [THREE.Vector3, THREE.Vector3, THREE.Vector3];

/** Up, the axis before it and the one after it. */
function axesOf(up: Axis): Axes {
    const [x, y, z] = [new THREE.Vector3(1, 0, 0), new THREE.Vector3(0, 1, 0), new THREE.Vector3(0, 0, 1)];
    const axes: Record<Axis, Axes> = { x: [x, z, y], y: [y, x, z], z: [z, y, x] };
    return axes[up];
}

/** Degrees. Seen from straight above, no direction is up. */
const MOST_ELEVATION = 89;

/** Radii. The camera stays outside of the model and the cloth on it. */
const NEAREST = 1.25;

/** How long the camera must be still to count as arrived. */
const ARRIVAL_MS = 250;

/** The visible sphere, and the ground below it. */
interface Sight {
    centre: Triple;
    radius: number;
    up: Axis;
    /** Along up. */
    floor: number;
}

/** The canvas, the camera and the light, shared by all views. */
export class Stage {
    readonly scene = new THREE.Scene();
    readonly camera = new THREE.PerspectiveCamera(30, 1, 0.01, 100);
    readonly renderer: THREE.WebGLRenderer;
    #controls: OrbitControls;
    readonly #studio: Studio;
    readonly #pace = new Pace();
    #shading: ContactShading | undefined;
    #wish?: Settings['look'];
    #fine = false;
    /** The functions that select the objects of each half of the picture; one if there are no halves. */
    #halves: (() => void)[] = [() => {}];
    /** The look has changed. */
    onLook = (_fine: boolean) => {};
    readonly #canvas: HTMLCanvasElement;
    /** The argument of the last lookAt(). */
    #model = { centre: new THREE.Vector3(), radius: 1, axes: axesOf('z') };
    #home = '';
    #sight: Sight | undefined;
    #arrival = 0;
    /** Where the camera was at its last change. */
    #last = '';
    /** The camera was moved, and stands at `standpoint` now. */
    onArrival = () => {};
    /** The graphics context was lost; three.js continues once it is restored. */
    onLoss = () => {};

    constructor(canvas: HTMLCanvasElement) {
        this.#canvas = canvas;
        this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: false });
        this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
        this.renderer.localClippingEnabled = true;
        this.#controls = new OrbitControls(this.camera, canvas);
        this.renderer.shadowMap.type = THREE.PCFShadowMap;
        this.#studio = new Studio(this.scene);
        canvas.addEventListener('webglcontextlost', () => this.onLoss());
        new ResizeObserver(() => this.#fit()).observe(canvas);
        this.#fit();
    }

    /** Places the camera so that a whole sphere, and the cloth above it, is in sight. */
    lookAt(sight: Sight): void {
        const { centre, radius, up, floor } = sight;
        this.#sight = sight;
        const axes = axesOf(up);
        const [upward, sideways, forward] = axes;
        this.#model = { centre: new THREE.Vector3(...centre), radius, axes };
        this.camera.up.copy(upward);
        // The controls copy the camera's up when they are constructed.
        this.#controls.dispose();
        this.#controls = new OrbitControls(this.camera, this.#canvas);
        this.#controls.enableDamping = true;
        this.#controls.dampingFactor = 0.12;
        this.#controls.minDistance = NEAREST * radius;
        this.#controls.maxDistance = 20 * radius;

        const middle = new THREE.Vector3(...centre).addScaledVector(upward, 0.12 * radius);
        // Narrow screens show less to the sides, so the camera moves back.
        const distance = 4.8 * radius * Math.max(1, 1.3 / this.camera.aspect);
        const from = sideways.clone().multiplyScalar(0.8).addScaledVector(forward, 0.55).addScaledVector(upward, 0.3).normalize();
        this.camera.position.copy(middle).addScaledVector(from, distance);
        this.camera.near = 0.02 * radius;
        this.camera.far = 40 * radius;
        this.camera.updateProjectionMatrix();
        this.#controls.target.copy(middle);
        this.#controls.update();
        this.#home = this.#last = toText(this.#stand());
        this.#controls.addEventListener('change', () => {
            const now = toText(this.#stand());
            if (now === this.#last) return; // at the least distance the controls report a change with each picture
            this.#last = now;
            clearTimeout(this.#arrival);
            this.#arrival = window.setTimeout(() => this.onArrival(), ARRIVAL_MS);
        });

        this.#studio.surround(middle, radius, axes, floor);
    }

    /** 'auto' begins with the fine look where there is a graphics card, and keeps it while pictures come quickly. */
    set look(wish: Settings['look']) {
        if (wish === this.#wish) return;
        this.#wish = wish;
        this.#refine(wish === 'fine' || (wish === 'auto' && !drawsInSoftware(this.renderer.getContext())));
    }
    get fine(): boolean {
        return this.#fine;
    }

    #refine(fine: boolean): void {
        if (fine === this.#fine) return;
        this.#fine = fine;
        this.#studio.fine = fine;
        this.renderer.shadowMap.enabled = fine;
        this.#shading?.dispose();
        this.#shading = fine ? new ContactShading() : undefined;
        this.onLook(fine);
    }

    /** @param shows  makes the scene show what belongs to a part of the picture: one for all of it, or two for its halves */
    set halves(shows: (() => void)[]) {
        this.#halves = shows;
        this.#fit();
    }

    /** A place in the canvas in the camera's coordinates, -1 to 1. @param x, y  shares of its width and height */
    inHalf(x: number, y: number): THREE.Vector2 {
        const across = (x * this.#halves.length) % 1;
        return new THREE.Vector2(2 * across - 1, 1 - 2 * y);
    }

    /** In which the picture goes up and right. */
    get directions(): { up: Triple; right: Triple } {
        const [right, up] = [0, 1].map((column) => new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, column).toArray());
        return { up, right };
    }

    get ground(): THREE.Object3D {
        return this.#studio.ground;
    }

    /** For a link (standpoint.ts); '' restores the camera of lookAt(). Any other invalid text changes nothing. */
    get standpoint(): string {
        const text = toText(this.#stand());
        return text === this.#home ? '' : text;
    }
    set standpoint(text: string) {
        const stand = fromText(text || this.#home);
        if (stand) this.#put(stand);
    }

    #put(stand: Standpoint): void {
        const { centre, radius, axes } = this.#model;
        const [azimuth, elevation] = [stand.azimuth, stand.elevation].map(THREE.MathUtils.degToRad);
        const away = [Math.sin(elevation), Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth)];
        const moved = (from: THREE.Vector3, along: readonly number[], length: number) =>
            axes.reduce((point, axis, k) => point.addScaledVector(axis, along[k] * length), from.clone());
        this.#controls.target.copy(moved(centre, stand.target, radius));
        this.camera.position.copy(moved(this.#controls.target, away, stand.distance * radius));
        this.#controls.update();
    }

    /** Turns the view, by degrees, and takes the camera nearer or further. */
    turn(azimuth: number, elevation: number, nearer = 1): void {
        const stand = this.#stand();
        const height = Math.min(MOST_ELEVATION, Math.max(-MOST_ELEVATION, stand.elevation + elevation));
        this.#put({ ...stand, azimuth: stand.azimuth + azimuth, elevation: height, distance: stand.distance / nearer });
    }

    #stand(): Standpoint {
        const { centre, radius, axes } = this.#model;
        const along = (from: THREE.Vector3, to: THREE.Vector3) => axes.map((axis) => axis.dot(to.clone().sub(from)) / radius) as Triple;
        const { target } = this.#controls;
        const [up, side, front] = along(target, this.camera.position);
        return {
            azimuth: THREE.MathUtils.radToDeg(Math.atan2(front, side)),
            elevation: THREE.MathUtils.radToDeg(Math.atan2(up, Math.hypot(side, front))),
            distance: Math.hypot(up, side, front),
            target: along(centre, target),
        };
    }

    set orbiting(enabled: boolean) {
        this.#controls.enabled = enabled;
    }

    draw(): void {
        this.#controls.update();
        this.#studio.follow(this.camera, this.#controls.target);
        const { clientWidth: width, clientHeight: height } = this.#canvas;
        const share = width / this.#halves.length;
        const ratio = this.renderer.getPixelRatio();
        this.#halves.forEach((show, k) => {
            show();
            this.renderer.setViewport(k * share, 0, share, height);
            this.renderer.setScissor(k * share, 0, share, height);
            this.renderer.setScissorTest(this.#halves.length > 1);
            if (this.#shading) this.#shading.render(this.renderer, this.scene, this.camera, new THREE.Vector2(ratio * share, ratio * height), this.#model.radius);
            else this.renderer.render(this.scene, this.camera);
        });
        if (this.#wish === 'auto' && this.#fine && this.#pace.isSlow(performance.now())) this.#refine(false);
    }

    /** The canvas as a PNG file. */
    picture(): Promise<Blob> {
        this.draw(); // the browser may have cleared the canvas since
        return new Promise((resolve, reject) =>
            this.#canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('the browser gives no picture of its canvas'))), 'image/png'),
        );
    }

    #fit(): void {
        const { clientWidth: width, clientHeight: height } = this.#canvas;
        if (width === 0 || height === 0) return;
        const isHome = this.#sight !== undefined && this.standpoint === '';
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / this.#halves.length / height;
        this.camera.updateProjectionMatrix();
        if (isHome) this.lookAt(this.#sight!); // where it is narrower, from farther away
    }
}
