import type { DistanceMapOptions, ExactMapOptions } from 'echinus';
import type { Axis } from '../axes';
import type { Settings } from '../settings';

/** The settings as `map` of a scene. @param up  the axis of a grid's poles */
export function mapOptions(settings: Settings, up: Axis): ExactMapOptions | DistanceMapOptions {
    return settings.map === 'exact' ? exactOptions(settings) : distanceOptions(settings, up);
}

function exactOptions({ cells }: Settings): ExactMapOptions {
    return { kind: 'exact', ...(cells !== 'auto' && { cells_per_octant: Number(cells) }) };
}

function distanceOptions({ grid, directions }: Settings, up: Axis): DistanceMapOptions {
    switch (grid) {
        case 'spherical':
        case 'ellipsoidal': {
            const side = Math.round(Math.sqrt(directions));
            return { kind: 'distance', grid, directions: [side, side], pole_axis: up };
        }
        // n divisions give (n + 1)^2 directions, the unfolded octahedron being one square, and the cube six.
        case 'octahedral':
            return { kind: 'distance', grid, divisions: Math.round(Math.sqrt(directions)) - 1 };
        case 'cube':
            return { kind: 'distance', grid, divisions: Math.round(Math.sqrt(directions / 6)) - 1 };
    }
}
