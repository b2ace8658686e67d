import * as THREE from 'three';
import { UNIT, following } from '../frames';
import type { CellNews, ColouredFaces, Cut, FromWorker, ModelNews, SurfaceNews, Triple } from '../protocol';
import type { Settings } from '../settings';
import { BAND, CHALK, CLOTH, FAULT, INK, LAYER_BACK } from './colours';
import { matte } from './material';
import { clear } from './model_view';

/** The contents of a map: its surface in colour, a cut through it, a ray, and where two maps differ. */
export class MapView {
    readonly group = new THREE.Group();
    readonly #surface = new THREE.Group();
    /** Part of the surface's group. */
    readonly #cells = new THREE.Group();
    readonly #cut = new THREE.Group();
    readonly #ray = new THREE.Group();
    #model: ModelNews | undefined;
    #up = new THREE.Vector3(0, 0, 1);
    #height = 1;

    constructor() {
        this.group.add(this.#surface, this.#cut, this.#ray);
        this.group.visible = false;
    }

    begin(model: ModelNews): void {
        this.#model = model;
        this.#up.set(...UNIT[model.up]);
        this.forget();
    }

    /** Clears the view, which belongs to another map. */
    forget(): void {
        clear(this.#cells);
        for (const part of [this.#surface, this.#cut, this.#ray]) clear(part);
    }

    showSurface(news: SurfaceNews): void {
        clear(this.#surface);
        this.#surface.add(...shells(news.faces));
        for (const { points } of news.differences ? [news.differences.everywhere, news.differences.near] : []) if (points.length > 0) this.#surface.add(dots(points));
        this.#surface.add(this.#cells);
        this.#clip();
    }

    showCells({ faces }: CellNews): void {
        clear(this.#cells);
        this.#cells.add(...shells(faces));
        this.#clip();
    }

    /** Call before each picture: of what has many faces, one part more is drawn, for what is new has to be handed to the graphics driver. */
    reveal(): void {
        if (!this.group.visible) return;
        for (const group of this.#cells.visible ? [this.#cells, this.#surface] : [this.#surface]) {
            const next = group.children.find((part) => part instanceof THREE.Mesh && !part.visible);
            if (!next) continue;
            next.visible = true;
            return;
        }
    }

    set shown(what: Settings['shown']) {
        this.#cells.visible = what === 'cells';
    }

    /** Cells hide the surface where they are not cut away. */
    get showsCells(): boolean {
        return this.#cells.visible && this.#cells.children.length > 0;
    }

    showCut(cut: Cut): void {
        clear(this.#cut);
        this.#height = cut.height;
        this.#clip();
        if (!this.#model || cut.height >= 1) return;
        const { radius, centre, up } = this.#model;
        const texture = new THREE.DataTexture(stainOf(cut), cut.side, cut.side);
        texture.colorSpace = THREE.SRGBColorSpace;
        texture.needsUpdate = true;
        const sheet = new THREE.Mesh(
            new THREE.PlaneGeometry(2 * radius, 2 * radius),
            new THREE.MeshBasicMaterial({ map: texture, transparent: true, side: THREE.DoubleSide, depthWrite: false }),
        );
        // Columns and rows as in the worker's cutAt().
        const [across, along] = following(up).map((axis) => new THREE.Vector3(...UNIT[axis]));
        sheet.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(across, along, this.#up));
        sheet.position.set(...centre).addScaledVector(this.#up, cut.height * radius);
        this.#cut.add(sheet);
    }

    /** The ray from the centre: thick where it is inside, with the bands in which the map searches for surface. */
    showRay(ray: FromWorker & { kind: 'ray' }): void {
        clear(this.#ray);
        if (!this.#model) return;
        const { centre, radius } = this.#model;
        const origin = new THREE.Vector3(...centre);
        const direction = new THREE.Vector3(...ray.direction).normalize();
        const at = (distance: number) => origin.clone().addScaledVector(direction, distance);
        for (const { from, to, inside } of ray.intervals)
            this.#ray.add(rod(at(from), at(to), (inside ? 0.016 : 0.005) * radius, inside ? CLOTH : lineColour()));
        for (const [from, to] of ray.bands) this.#ray.add(rod(at(from), at(to), 0.034 * radius, BAND, 0.8));
        for (const crossing of ray.crossings) this.#ray.add(ball(at(crossing), 0.024 * radius, lineColour()));
        if (ray.outline.length === 3) this.#ray.add(...outline(ray.outline, origin, radius));
    }

    hideRay(): void {
        clear(this.#ray);
    }

    /** The part of a ray inside the remainder of the bounding sphere below the cut. */
    wayOf({ ray }: THREE.Raycaster): { from: Triple; to: Triple } | undefined {
        if (!this.#model) return undefined;
        const { centre, radius } = this.#model;
        const toMiddle = new THREE.Vector3(...centre).sub(ray.origin).dot(ray.direction);
        const half = Math.sqrt(radius * radius - ray.distanceSqToPoint(new THREE.Vector3(...centre)));
        const plane = this.#plane();
        // Where the ray meets the cut: there it enters or leaves the part that is kept, which lies below.
        const sinking = ray.direction.dot(plane.normal);
        const cut = -plane.distanceToPoint(ray.origin) / sinking;
        const from = Math.max(0, toMiddle - half, sinking > 0 ? cut : 0);
        const to = Math.min(toMiddle + half, sinking < 0 ? cut : Infinity);
        if (!(from < to)) return undefined; // also where it misses the sphere and half is NaN
        return { from: ray.at(from, new THREE.Vector3()).toArray(), to: ray.at(to, new THREE.Vector3()).toArray() };
    }

    #clip(): void {
        const planes = [this.#plane()];
        this.#surface.traverse((part) => {
            if (part instanceof THREE.Mesh || part instanceof THREE.Points) (part.material as THREE.Material).clippingPlanes = planes;
        });
    }

    /** Keeps the part below the cut. */
    #plane(): THREE.Plane {
        const centre = this.#model?.centre ?? [0, 0, 0];
        const radius = this.#model?.radius ?? 1;
        // The whole map, and a little more, so that rounding does not cut its top.
        const height = this.#height >= 1 ? 1.1 : this.#height;
        return new THREE.Plane(this.#up.clone().negate(), this.#up.dot(new THREE.Vector3(...centre)) + height * radius);
    }
}

/** In parts of so many faces: to hand 40 MB to the driver at once holds up the page for 0.4 s. */
const PART = 30_000;

/** Coloured in front, paper behind. The first part is visible. */
function shells({ positions, normals, colours }: ColouredFaces): THREE.Mesh[] {
    const parts: THREE.Mesh[] = [];
    for (let from = 0; from < positions.length; from += 9 * PART) {
        const geometry = new THREE.BufferGeometry();
        for (const [name, numbers] of [['position', positions], ['normal', normals], ['color', colours]] as const)
            geometry.setAttribute(name, new THREE.BufferAttribute(numbers.subarray(from, from + 9 * PART), 3));
        const material = matte(0xffffff, LAYER_BACK);
        material.vertexColors = true;
        const mesh = new THREE.Mesh(geometry, material);
        mesh.frustumCulled = false; // it fills the picture, and to find its bounds takes time
        mesh.visible = from === 0;
        parts.push(mesh);
    }
    return parts;
}

function dots(positions: Float32Array): THREE.Points {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    const material = new THREE.PointsMaterial({ color: FAULT.faces, size: 3.5, sizeAttenuation: false, depthTest: false, transparent: true, opacity: 0.85 });
    return new THREE.Points(geometry, material);
}

/** Inside red, outside nearly transparent. */
function stainOf({ inside, side }: Cut): Uint8Array<ArrayBuffer> {
    const pixels = new Uint8Array(4 * side * side);
    inside.forEach((flag, i) => pixels.set(flag ? [0xb4, 0x58, 0x4e, 0xe6] : [0x80, 0x80, 0x80, 0x18], 4 * i));
    return pixels;
}

function rod(from: THREE.Vector3, to: THREE.Vector3, radius: number, colour: number, opacity = 1): THREE.Mesh {
    const length = from.distanceTo(to);
    const mesh = new THREE.Mesh(new THREE.CylinderGeometry(radius, radius, length, 14), ink(colour, opacity));
    mesh.position.copy(from).lerp(to, 0.5);
    mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), to.clone().sub(from).normalize());
    mesh.renderOrder = 3;
    return mesh;
}
function ball(at: THREE.Vector3, radius: number, colour: number): THREE.Mesh {
    const mesh = new THREE.Mesh(new THREE.SphereGeometry(radius, 14, 10), ink(colour));
    mesh.position.copy(at);
    mesh.renderOrder = 4;
    return mesh;
}
/** The cell: its three edges on the bounding sphere, and the lines from the centre to its corners. */
function outline(corners: Triple[], origin: THREE.Vector3, radius: number): THREE.Mesh[] {
    const far = corners.map((corner) => origin.clone().addScaledVector(new THREE.Vector3(...corner), radius));
    return far.flatMap((corner, k) => [rod(origin, corner, 0.003 * radius, lineColour(), 0.5), rod(corner, far[(k + 1) % 3], 0.003 * radius, lineColour(), 0.5)]);
}
const lineColour = (): number => (matchMedia('(prefers-color-scheme: dark)').matches ? CHALK : INK);

/** Drawn through the surface, which would hide nearly all of a ray. */
const ink = (color: number, opacity = 1) => new THREE.MeshBasicMaterial({ color, opacity, depthTest: false, transparent: true });
