import * as THREE from 'three';
import type { Cut, FromWorker, ModelNews, SurfaceNews, Triple } from '../protocol';
import { BAND, CLOTH, INK, LAYERS, LAYER_BACK, SCALE } from './colours';
import { clear } from './model_view';

/** What a map holds: its surface in colour, a cut through it, a ray, and where two maps differ. */
export class MapView {
    readonly group = new THREE.Group();
    readonly #surface = new THREE.Group();
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
        this.#up.set(...({ x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] } as Record<string, Triple>)[model.up]);
        for (const part of [this.#surface, this.#cut, this.#ray]) clear(part);
    }

    /** @returns the value at which the scale of colours ends */
    showSurface(news: SurfaceNews): number {
        clear(this.#surface);
        const largest = Math.max(1, largestOf(news.values));
        const colours = news.mapKind === 'exact' ? scaleTo(largest) : (layer: number) => new THREE.Color(LAYERS[layer % LAYERS.length]);
        const geometry = perFace(news, colours);
        const planes = [this.#plane()];
        const front = new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.9, side: THREE.FrontSide, clippingPlanes: planes });
        const back = new THREE.MeshStandardMaterial({ color: LAYER_BACK, roughness: 0.9, side: THREE.BackSide, clippingPlanes: planes });
        this.#surface.add(new THREE.Mesh(geometry, front), new THREE.Mesh(geometry, back));
        if (news.disagreements.length > 0) {
            const points = new THREE.BufferGeometry();
            points.setAttribute('position', new THREE.BufferAttribute(news.disagreements, 3));
            const material = new THREE.PointsMaterial({ clippingPlanes: planes, color: 0xd1242f, size: 3.5, sizeAttenuation: false, depthTest: false, transparent: true, opacity: 0.85 });
            this.#surface.add(new THREE.Points(points, material));
        }
        return largest;
    }

    showCut(cut: Cut): void {
        clear(this.#cut);
        this.#height = cut.height;
        const plane = this.#plane();
        for (const child of this.#surface.children)
            if (child instanceof THREE.Mesh || child instanceof THREE.Points) (child.material as THREE.Material).clippingPlanes = [plane];
        if (!this.#model || cut.height >= 1) return;
        const { radius, centre, up } = this.#model;
        const texture = new THREE.DataTexture(stainOf(cut), cut.side, cut.side);
        texture.colorSpace = THREE.SRGBColorSpace;
        texture.needsUpdate = true;
        const sheet = new THREE.Mesh(
            new THREE.PlaneGeometry(2 * radius, 2 * radius),
            new THREE.MeshBasicMaterial({ map: texture, transparent: true, side: THREE.DoubleSide, depthWrite: false }),
        );
        // Columns run along the axis after up, rows along the one after that: cutAt() of the worker.
        const axes: Record<string, [Triple, Triple, Triple]> = {
            x: [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
            y: [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
            z: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
        };
        const [across, along, upward] = axes[up].map((axis) => new THREE.Vector3(...axis));
        sheet.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(across, along, upward));
        sheet.position.set(...centre).addScaledVector(this.#up, cut.height * radius);
        this.#cut.add(sheet);
    }

    /** The ray from the centre: thick where it is inside, with the bands in which the map looks for surface. */
    showRay(ray: FromWorker & { kind: 'ray' }): void {
        clear(this.#ray);
        if (!this.#model) return;
        const { centre, radius } = this.#model;
        const origin = new THREE.Vector3(...centre);
        const direction = new THREE.Vector3(...ray.direction).normalize();
        const at = (distance: number) => origin.clone().addScaledVector(direction, distance);
        for (const { from, to, inside } of ray.intervals)
            this.#ray.add(rod(at(from), at(to), (inside ? 0.009 : 0.0025) * radius, inside ? CLOTH : INK));
        for (const [from, to] of ray.bands) this.#ray.add(rod(at(from), at(to), 0.022 * radius, BAND, 0.45));
        for (const crossing of ray.crossings) this.#ray.add(ball(at(crossing), 0.018 * radius, INK));
        if (ray.outline.length === 3) this.#ray.add(this.#outline(ray.outline, origin, radius));
    }

    /** The first point of the surface under a ray that the cut has left. */
    pick(ray: THREE.Raycaster): THREE.Vector3 | undefined {
        const kept = this.#plane();
        return ray.intersectObjects(this.#surface.children.filter((child) => child instanceof THREE.Mesh)).find(({ point }) => kept.distanceToPoint(point) >= 0)?.point;
    }

    /** The cell: its three edges on the bounding sphere, and the way to them. */
    #outline(corners: Triple[], origin: THREE.Vector3, radius: number): THREE.LineSegments {
        const far = corners.map((corner) => origin.clone().addScaledVector(new THREE.Vector3(...corner), radius));
        const geometry = new THREE.BufferGeometry().setFromPoints([0, 1, 2].flatMap((k) => [origin, far[k], far[k], far[(k + 1) % 3]]));
        return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: INK, transparent: true, opacity: 0.55, depthTest: false }));
    }

    /** Keeps what lies below the cut. */
    #plane(): THREE.Plane {
        const centre = this.#model?.centre ?? [0, 0, 0];
        const radius = this.#model?.radius ?? 1;
        // The whole map, and a little more so that its top is not cut by rounding.
        const height = this.#height >= 1 ? 1.1 : this.#height;
        return new THREE.Plane(this.#up.clone().negate(), this.#up.dot(new THREE.Vector3(...centre)) + height * radius);
    }
}

/** Every face by itself, so that each has its own colour. */
function perFace({ vertices, faces, values }: SurfaceNews, colourOf: (value: number) => THREE.Color): THREE.BufferGeometry {
    const positions = new Float32Array(3 * faces.length);
    const colours = new Float32Array(3 * faces.length);
    for (let corner = 0; corner < faces.length; ++corner) {
        for (let k = 0; k < 3; ++k) positions[3 * corner + k] = vertices[3 * faces[corner] + k];
        if (corner % 3 === 0) {
            const { r, g, b } = colourOf(values[corner / 3]);
            for (let k = 0; k < 3; ++k) colours.set([r, g, b], 3 * (corner + k));
        }
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3));
    geometry.computeVertexNormals();
    return geometry;
}

function scaleTo(largest: number): (value: number) => THREE.Color {
    const stops = SCALE.map((hex) => new THREE.Color(hex));
    return (value) => {
        const place = ((stops.length - 1) * Math.min(value, largest)) / largest;
        const stop = Math.min(stops.length - 2, Math.floor(place));
        return stops[stop].clone().lerp(stops[stop + 1], place - stop);
    };
}

function largestOf(values: Uint32Array): number {
    let largest = 0;
    for (const value of values) largest = Math.max(largest, value);
    return largest;
}

/** Inside red, outside nearly nothing. */
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
/** Through the surface, which would hide nearly all of a ray. */
const ink = (color: number, opacity = 1) => new THREE.MeshBasicMaterial({ color, opacity, depthTest: false, transparent: true });
