import { AXES, type Axis } from './frames';
import * as standpoint from './standpoint';

/** All of the visitor's choices. A link contains them, the panel shows them, the worker applies them. */
export interface Settings {
    model: Sample;
    view: 'cloth' | 'map';
    map: 'exact' | 'distance';
    /** Exact map: cells per octant of directions; 'auto' depends on the mesh. */
    cells: (typeof CELLS)[number];
    /** The paper's map: how directions are divided, and into about how many. */
    grid: (typeof GRIDS)[number];
    directions: number;
    /** Of all cloths; rounded to a square number for one. */
    particles: number;
    /** How many sheets fall on a model around which nothing else happens. */
    cloths: number;
    friction: number;
    /** With the exact map: faces of the cloth keep off the model, too, not only its particles. */
    surfaces: boolean;
    /** And off each other; only together with `surfaces`. */
    self: boolean;
    /** The distance that particles keep from the model, in spacings of the particles. */
    thickness: number;
    /** Radii of the model per second. */
    wind: number;
    motion: 'still' | 'turning' | 'swinging';
    /** Which axis of the model points up; 'auto' depends on the model. */
    up: 'auto' | Axis;
    /** Mend what Mesh.repair() can mend, before the map is built. */
    mend: boolean;
    colour: 'fabric' | 'depth';
    /** The action of the pointer: it pulls the cloth, moves a ball, or grabs the model. */
    hand: 'cloth' | 'ball' | 'model';
    /** The cloth in the other half of the picture: the same on the paper's map, or with collision of particles only. */
    beside: 'nothing' | 'map' | 'particles';
    /** How the cloth is drawn; 'auto' depends on how long a picture takes. */
    look: 'auto' | 'fine' | 'light';
    /** The quantity that the colours show in the view of the map. */
    shown: 'surface' | 'cells';
    /** Where the map is cut open, along the view's up axis: -1 to 1 radii. 1 leaves it whole. */
    slice: number;
    /** Where the camera stands (standpoint.ts); '' is the page's default. */
    camera: string;
}

export type Sample = 'horse' | 'torus' | 'sphere' | 'figure' | 'organ' | 'ring' | 'flag' | 'layers';
/** Whether the horse was available when the page was built (vite.config.js). */
declare const HAS_HORSE: boolean;

/** On these samples, and on every file, sheets fall; around the others something else happens. */
export const UNDER_SHEETS: readonly Sample[] = ['horse', 'torus', 'sphere'];
export const CELLS = ['auto', '16', '64', '256', '1024', '4096', '16384', '65536'] as const;
const GRIDS = ['spherical', 'octahedral', 'cube', 'ellipsoidal'] as const;

const MADE_HERE: readonly Sample[] = ['torus', 'sphere', 'figure', 'organ', 'ring', 'flag', 'layers'];
export const SAMPLES: readonly Sample[] = HAS_HORSE ? ['horse', ...MADE_HERE] : MADE_HERE;
/** Their names in the list of models. */
export const SAMPLE_NAMES: Readonly<Record<Sample, string>> = {
    horse: 'Horse', torus: 'Torus', sphere: 'Sphere', figure: 'Dancer and skirt', organ: 'Organ and probe', ring: 'Ring and kerchief', flag: 'Flag', layers: 'Five layers',
};

export const DEFAULTS: Readonly<Settings> = {
    model: SAMPLES[0],
    view: 'cloth',
    map: 'exact',
    cells: 'auto',
    grid: 'spherical',
    directions: 40_000,
    particles: 1600,
    cloths: 1,
    friction: 0.5,
    surfaces: true,
    self: true,
    thickness: 0.2,
    wind: 0,
    motion: 'still',
    up: 'auto',
    mend: true,
    colour: 'fabric',
    hand: 'cloth',
    beside: 'nothing',
    look: 'auto',
    shown: 'surface',
    slice: 1,
    camera: '',
};

const CHOICES: { [K in keyof Settings]?: readonly Settings[K][] } = {
    model: SAMPLES,
    view: ['cloth', 'map'],
    map: ['exact', 'distance'],
    cells: CELLS,
    grid: GRIDS,
    motion: ['still', 'turning', 'swinging'],
    up: ['auto', ...AXES],
    colour: ['fabric', 'depth'],
    hand: ['cloth', 'ball', 'model'],
    beside: ['nothing', 'map', 'particles'],
    look: ['auto', 'fine', 'light'],
    shown: ['surface', 'cells'],
};

export const RANGES = {
    directions: [400, 640_000],
    particles: [100, 100_000],
    cloths: [1, 5],
    friction: [0, 1.5],
    thickness: [0.1, 2],
    wind: [0, 10],
    slice: [-1, 1],
} as const satisfies { [K in keyof Settings]?: readonly [number, number] };

/** The differences from the defaults, as the part of a link after #. */
export function toLink(settings: Settings): string {
    const changed = new URLSearchParams();
    for (const key of Object.keys(DEFAULTS) as (keyof Settings)[])
        if (settings[key] !== DEFAULTS[key]) changed.set(key, String(settings[key]));
    return changed.toString();
}

/** The settings of a link. Numbers are clamped to their range; other invalid values fall back to their defaults, since links outlive pages. */
export function fromLink(hash: string): Settings {
    const said = partsOf(hash);
    const settings: Record<string, unknown> = { ...DEFAULTS };
    for (const [key, text] of said) {
        const value = valueIn(key, text);
        if (value !== undefined) settings[key] = value;
    }
    return consistent(settings as unknown as Settings, said.has('beside') ? 'beside' : 'surfaces');
}

/** The parts of a link that the page does not take as they stand: it has no such setting or value, or another part contradicts it. */
export function notTakenIn(hash: string): string[] {
    const taken = fromLink(hash);
    return [...partsOf(hash)].flatMap(([key, text]) => {
        if (valueIn(key, text) === undefined) return [`${key}=${text}`];
        const value = taken[key as keyof Settings];
        const same = typeof value === 'number' ? value === Number(text) : String(value) === text;
        return same ? [] : [`${key}=${text} (but ${value})`];
    });
}

const partsOf = (hash: string): URLSearchParams => new URLSearchParams(hash.replace(/^#/, ''));

/** A setting's value in a link, if it is one. */
function valueIn(key: string, text: string): string | number | boolean | undefined {
    if (!Object.hasOwn(DEFAULTS, key)) return undefined;
    const choices = CHOICES[key as keyof Settings] as readonly string[] | undefined;
    const range = RANGES[key as keyof typeof RANGES] as readonly [number, number] | undefined;
    if (choices) return choices.includes(text) ? text : undefined;
    if (range) return text !== '' && Number.isFinite(Number(text)) ? Math.min(range[1], Math.max(range[0], Number(text))) : undefined;
    if (key === 'camera') return standpoint.fromText(text) && text;
    return text === 'true' ? true : text === 'false' ? false : undefined;
}

/** @param changed  the key that wins where two contradict each other */
export function consistent(settings: Settings, changed: keyof Settings): Settings {
    const parted = withHalves(withCloths(settings, changed), changed);
    if (!parted.self || parted.surfaces) return parted;
    return changed === 'self' ? { ...parted, surfaces: true } : { ...parted, self: false };
}

/** Whoever asks for another cloth sees it lie on the first. */
function withCloths(settings: Settings, changed: keyof Settings): Settings {
    const whole = { ...settings, cloths: Math.round(settings.cloths) };
    return changed === 'cloths' && whole.cloths > 1 ? { ...whole, map: 'exact', surfaces: true, self: true } : whole;
}

/** The left half is the exact map with surfaces, or there would be nothing to compare. */
function withHalves(settings: Settings, changed: keyof Settings): Settings {
    if (settings.beside === 'nothing' || (settings.map === 'exact' && settings.surfaces)) return settings;
    return changed === 'map' || changed === 'surfaces' ? { ...settings, beside: 'nothing' } : { ...settings, map: 'exact', surfaces: true };
}

/** Whether surfaces collide with the model, and with each other: the paper's map has no faces. */
export function collisionOf({ map, surfaces, self }: Settings): { surfaces: boolean; self: boolean } {
    const withModel = map === 'exact' && surfaces;
    return { surfaces: withModel, self: withModel && self };
}

/** The settings of the other half. */
export const besideOf = (settings: Settings): Settings =>
    settings.beside === 'map' ? { ...settings, map: 'distance', self: false } : { ...settings, surfaces: false, self: false };
