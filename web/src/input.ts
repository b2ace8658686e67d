import * as THREE from 'three';
import type { Triple } from './protocol';
import type { Settings } from './settings';
import type { ClothView } from './view/cloth_view';
import type { Stage } from './view/stage';

/** Calls the action of a key, by `event.key` in lower case, unless the control that has the focus needs that key itself. */
export function enableKeys(actions: Record<string, () => void>): void {
    addEventListener('keydown', (event) => {
        const action = actions[event.key.toLowerCase()];
        if (!action || (event.repeat && !REPEATED.has(event.key.toLowerCase())) || event.ctrlKey || event.metaKey || event.altKey || isOfControl(event)) return;
        event.preventDefault();
        action();
    });
    releaseLists();
}

/** A list from which the pointer has chosen gives the keys back; one that keys operate goes on having them. */
function releaseLists(): void {
    let byPointer = false;
    addEventListener('pointerdown', () => (byPointer = true), { capture: true });
    addEventListener('keydown', () => (byPointer = false), { capture: true });
    addEventListener('change', ({ target }) => byPointer && target instanceof HTMLSelectElement && target.blur());
}

/** These repeat while held down: they step or turn by a little. */
const REPEATED = new Set(['s', 'arrowleft', 'arrowright', 'arrowup', 'arrowdown', '+', '-']);

/** Lists search their entries by letters; buttons and check boxes take space; sliders and choices take arrow keys. */
function isOfControl({ key, target }: KeyboardEvent): boolean {
    if (!(target instanceof HTMLElement)) return false;
    if (target.matches('select')) return true;
    if (key === ' ') return target.matches('button, summary, input:not([type=range])');
    return key.startsWith('Arrow') && target.matches('input');
}

interface PointerWishes {
    /** The action of the pointer; undefined: it only turns the view. */
    hand(): Settings['hand'] | undefined;
    /** The cloth in the half of the picture at this share of its width. */
    clothAt(x: number): ClothView;
    grab(particle: number, target: Triple): void;
    drag(target: Triple): void;
    /** The model is held, this far from where it was. */
    hold(offset: Triple): void;
    release(): void;
    /** The pointer's line, for the ball. */
    lead(ray: THREE.Ray): void;
    /** The pointer moved over the canvas without holding anything. */
    hover(ray: THREE.Raycaster): void;
    /** The model, which can hide the cloth. */
    obstacle: THREE.Object3D;
}

/** A model may be a thin rod, as the probe is: places around the pointer where it is held, too, in pixels. */
const AROUND = [[0, 0], [5, 0], [-5, 0], [0, 5], [0, -5], [10, 0], [-10, 0], [0, 10], [0, -10]] as const;
const EXACTLY = AROUND.slice(0, 1);

/** How often the cloth under the pointer is looked for. */
const LOOK_MS = 80;

/**
 * Pulls the cloth or the model where the pointer grabs it, in the plane across the view, or leads the ball; elsewhere the view turns. A second
 * finger releases what is held: two fingers zoom.
 */
export function enablePointer(canvas: HTMLCanvasElement, stage: Stage, wishes: PointerWishes): void {
    const ray = new THREE.Raycaster();
    const plane = new THREE.Plane();
    const target = new THREE.Vector3();
    const begin = new THREE.Vector3();
    /** The last event of the pointer that holds something, and what. */
    let hold: PointerEvent | undefined;
    let held: Settings['hand'] = 'cloth';
    let looked = 0;

    const aim = ({ clientX, clientY }: PointerEvent, [right, down]: readonly [number, number] = [0, 0]): number => {
        const { left, top, width, height } = canvas.getBoundingClientRect();
        const x = (clientX + right - left) / width;
        ray.setFromCamera(stage.inHalf(x, (clientY + down - top) / height), stage.camera);
        return x;
    };
    /** The place where the pointer would hold the cloth or the model. Aims at the pointer in the end. */
    const under = (event: PointerEvent, hand: Settings['hand'], places: readonly (readonly [number, number])[]) => {
        let hit: { point: THREE.Vector3; particle?: number } | undefined;
        for (const offset of places) {
            const x = aim(event, offset);
            const onModel = ray.intersectObject(wishes.obstacle, false)[0];
            const onCloth = wishes.clothAt(x).pick(ray);
            if (hand === 'model') hit = onModel ?? onCloth;
            else if (onCloth && !(onModel && onModel.distance < 0.99 * onCloth.distance)) hit = onCloth;
            if (hit) break;
        }
        aim(event);
        return hit;
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
            const hand = wishes.hand();
            if (!hand) return wishes.hover(ray); // a finger hovers by touching
            if (hand === 'ball' && event.pointerType === 'mouse') return; // which leads it without a button
            const hit = hand === 'ball' ? { point: begin } : under(event, hand, hand === 'model' ? AROUND : EXACTLY);
            if (!hit) return;
            stage.orbiting = false;
            hold = event;
            held = hand;
            canvas.setPointerCapture(event.pointerId);
            canvas.classList.add('dragging');
            if (hand === 'ball') return wishes.lead(ray.ray);
            plane.setFromNormalAndCoplanarPoint(stage.camera.getWorldDirection(new THREE.Vector3()), hit.point);
            ray.ray.intersectPlane(plane, begin);
            if (hand === 'cloth' && 'particle' in hit && hit.particle !== undefined) wishes.grab(hit.particle, hit.point.toArray());
        },
        { capture: true },
    );
    canvas.addEventListener('pointermove', (event) => {
        aim(event);
        if (!hold) return look(event);
        if (event.pointerId !== hold.pointerId) return;
        hold = event;
        if (held === 'ball') return wishes.lead(ray.ray);
        if (!ray.ray.intersectPlane(plane, target)) return;
        if (held === 'cloth') wishes.drag(target.toArray());
        else wishes.hold(target.clone().sub(begin).toArray());
    });
    const look = (event: PointerEvent) => {
        wishes.hover(ray);
        const hand = wishes.hand();
        if (hand === 'ball' && event.buttons === 0) wishes.lead(ray.ray);
        if (event.buttons > 0 || event.timeStamp - looked < LOOK_MS) return;
        looked = event.timeStamp;
        canvas.classList.toggle('over-cloth', hand !== undefined && hand !== 'ball' && under(event, hand, EXACTLY) !== undefined);
    };
    const release = () => {
        hold = undefined;
        stage.orbiting = true;
        canvas.classList.remove('dragging');
        wishes.release();
    };
    for (const kind of ['pointerup', 'pointercancel'] as const)
        canvas.addEventListener(kind, (event) => event.pointerId === hold?.pointerId && release());
}
