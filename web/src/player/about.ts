import { byId, count, make, milliseconds, perSecond, writeCount } from '../panel/elements';
import type { Description, RecordedFrame } from './recording';

/** The facts that do not change during playback. */
export function showAbout(description: Description): void {
    const { scene, model, figures } = description;
    document.title = `${scene}: a simulation by Echinus`;
    byId('subtitle').textContent = `${scene}, recorded`;
    byId('scene').textContent = scene;
    byId('about').replaceChildren(...rowsOf(description).map(([name, value]) => row(name, value)));
    byId('precision').textContent = precisionOf(description);
    showMeans(figures);
    byId('model-notice').hidden = model.notice === '';
    byId('model-notice').querySelector('pre')!.textContent = model.notice;
}

/** The facts of one frame. */
export function showFrame({ number, inside, intersecting_pairs, self_intersecting_pairs }: RecordedFrame, timeStep: number): void {
    showCount('figure-inside', inside);
    showCount('figure-pairs', intersecting_pairs);
    showCount('figure-own-pairs', self_intersecting_pairs);
    byId('figure-time').textContent = `${(number * timeStep).toFixed(2)}\u2009s`;
    byId('figure-frame').textContent = count(number);
}

/** A figure that a recording does not count is not shown. */
function showCount(id: string, number: number | undefined): void {
    writeCount(id, number);
    byId(id).parentElement!.hidden = number === undefined;
}

function showMeans({ particles, ms_per_frame: ms, ns_per_query }: Description['figures']): void {
    byId('figure-particles').textContent = count(particles);
    byId('figure-step').textContent = milliseconds(ms.total);
    byId('figure-constraints').textContent = milliseconds(ms.constraints);
    byId('figure-collision').textContent = milliseconds(ms.collision);
    byId('figure-queries').textContent = perSecond(1e9 / ns_per_query);
    byId('figure-queries').parentElement!.hidden = ns_per_query === 0; // newton asks a map about few of its particles
}

function rowsOf({ model, figures, frames, cloth_faces, machine, version }: Description): [string, string][] {
    const rest = figures.frames_to_rest;
    return [
        ['model', model.name],
        ['its faces', count(model.faces)],
        ['faces of the cloth', count(cloth_faces)],
        ['push-out', figures.map_kind === 'exact' ? 'nearest, exact map' : 'radial, the paper\u2019s map'],
        ['solver', figures.solver + (figures.solver === 'newton' ? '' : `, ${figures.iterations} relaxations`)],
        ['time steps of', milliseconds(1e3 * figures.time_step)],
        ['at rest after', rest === null ? 'not yet' : `${count(rest)} steps`],
        ['recorded frames', count(frames.length)],
        ['machine', machine],
        ['Echinus', version],
    ];
}

function precisionOf({ lattice_step, model }: Description): string {
    const error = 0.5 * lattice_step;
    return `Positions are rounded, each coordinate by at most ${error.toPrecision(2)} (${(error / model.radius).toPrecision(2)}\u2009R).`;
}

function row(name: string, value: string): HTMLElement {
    const element = document.createElement('tr');
    element.append(make('th', name), make('td', value));
    return element;
}
