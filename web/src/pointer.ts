import * as THREE from 'three';
import type { Triple } from './protocol';
import type { ClothView } from './view/cloth_view';
import type { Stage } from './view/stage';

export interface PointerWishes {
    grab(particle: number, target: Triple): void;
    drag(target: Triple): void;
    release(): void;
    /** The pointer moved over the canvas without holding anything. */
    hover(ray: THREE.Raycaster): void;
    /** The objects that can hide the cloth. */
    obstacle: THREE.Object3D;
    mayGrab(): boolean;
}

/**
 * Pulls the cloth where the pointer grabs it, in the plane across the view; elsewhere the view turns. A second finger
 * releases the cloth: two fingers zoom.
 */
export function enablePointer(canvas: HTMLCanvasElement, stage: Stage, cloth: ClothView, wishes: PointerWishes): void {
    const ray = new THREE.Raycaster();
    const plane = new THREE.Plane();
    const target = new THREE.Vector3();
    /** The last event of the pointer that holds the cloth. */
    let hold: PointerEvent | undefined;

    const aim = ({ clientX, clientY }: PointerEvent) => {
        const { left, top, width, height } = canvas.getBoundingClientRect();
        ray.setFromCamera(new THREE.Vector2((2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height), stage.camera);
    };

    // Before the orbit controls receive it, so that they can be disabled.
    canvas.addEventListener(
        'pointerdown',
        (event) => {
            if (hold && hold.pointerId !== event.pointerId) {
                const first = hold;
                release();
                canvas.dispatchEvent(new PointerEvent('pointerdown', first)); // which the controls have missed
                return;
            }
            if (event.button !== 0 || !event.isPrimary || !event.isTrusted) return;
            aim(event);
            if (!wishes.mayGrab()) return wishes.hover(ray); // a finger hovers by touching
            const hit = cloth.pick(ray);
            if (!hit) return;
            const hidden = ray.intersectObject(wishes.obstacle, false).some(({ distance }) => distance < 0.99 * hit.distance);
            if (hidden) return;
            stage.orbiting = false;
            hold = event;
            canvas.setPointerCapture(event.pointerId);
            canvas.classList.add('dragging');
            plane.setFromNormalAndCoplanarPoint(stage.camera.getWorldDirection(new THREE.Vector3()), hit.point);
            wishes.grab(hit.particle, hit.point.toArray());
        },
        { capture: true },
    );
    canvas.addEventListener('pointermove', (event) => {
        aim(event);
        if (!hold) return wishes.hover(ray);
        if (event.pointerId !== hold.pointerId) return;
        hold = event;
        if (ray.ray.intersectPlane(plane, target)) wishes.drag(target.toArray());
    });
    const release = () => {
        hold = undefined;
        stage.orbiting = true;
        canvas.classList.remove('dragging');
        wishes.release();
    };
    for (const kind of ['pointerup', 'pointercancel'] as const)
        canvas.addEventListener(kind, (event) => event.pointerId === hold?.pointerId && release());
}
