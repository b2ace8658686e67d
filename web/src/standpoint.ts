/** Where the camera stands, in a few characters of a link. */

export interface Standpoint {
    /** Degrees about the model's up axis, and above the horizon. */
    azimuth: number;
    elevation: number;
    /** Radii of the model. */
    distance: number;
    /** The target, in radii from the model's centre: along up, the axis before it and the one after it. */
    target: readonly [number, number, number];
}

const LIMITS: readonly (readonly [number, number])[] = [
    [-180, 180],
    [-90, 90],
    [0.1, 50],
    [-20, 20],
    [-20, 20],
    [-20, 20],
];

/** A hundredth of a radius and a whole degree: finer than anyone aims. Numbers are separated by underscores, which links keep unescaped. */
export function toText({ azimuth, elevation, distance, target }: Standpoint): string {
    const lengths = [distance, ...target].map((length) => Math.round(100 * length) / 100);
    return [Math.round(azimuth), Math.round(elevation), ...lengths].map((number) => number || 0).join('_');
}

/** @returns undefined for text that toText() does not produce */
export function fromText(text: string): Standpoint | undefined {
    const parts = text.split('_');
    const numbers = parts.map(Number);
    const right = parts.length === LIMITS.length && parts.every((part) => part !== '') && LIMITS.every(([least, most], i) => numbers[i] >= least && numbers[i] <= most);
    if (!right) return undefined;
    const [azimuth, elevation, distance, ...target] = numbers;
    return { azimuth, elevation, distance, target: target as [number, number, number] };
}
