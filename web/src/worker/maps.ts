import type { AnyMap, DistanceMapOptions, Echinus, ExactMap, ExactMapOptions, Mesh } from 'echinus';
import type { Axis } from '../frames';
import type { MapNews } from '../protocol';
import type { Settings } from '../settings';

/** The settings as `map` of a scene. @param up  the axis of a grid's poles */
function mapOptions(settings: Settings, up: Axis): ExactMapOptions | DistanceMapOptions {
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

interface Built {
    map: AnyMap;
    news: MapNews;
    /** The options it was built with. */
    options: string;
}

/** The maps of one mesh, which must outlive them: the exact one always, the paper's on demand. */
export class Maps {
    readonly #echinus: Echinus;
    readonly #mesh: Mesh;
    readonly #up: Axis;
    readonly #built = new Map<Settings['map'], Built>();

    /** @throws EchinusError when no exact map of the mesh is possible */
    constructor(echinus: Echinus, mesh: Mesh, up: Axis, settings: Settings) {
        this.#echinus = echinus;
        this.#mesh = mesh;
        this.#up = up;
        this.by({ ...settings, map: 'exact' });
    }

    get exact(): ExactMap {
        return this.#built.get('exact')!.map as ExactMap;
    }

    /** Is the map of the settings there already? */
    has(settings: Settings): boolean {
        return this.#built.get(settings.map)?.options === this.#optionsOf(settings);
    }

    /** The map of the settings; builds it unless the last of its kind was built with the same options. */
    by(settings: Settings): Readonly<Built> {
        const present = this.#built.get(settings.map);
        if (present && this.has(settings)) return present;
        const built = this.build(settings);
        this.#built.set(settings.map, built);
        present?.map.delete();
        return built;
    }

    /** Owned by the caller, who must delete it. */
    build(settings: Settings): Built {
        const options = this.#optionsOf(settings);
        const begin = performance.now();
        const map = this.#echinus.buildMap(this.#mesh, options);
        const buildMs = performance.now() - begin;
        return { map, news: { kind: map.kind, byteCount: map.byteCount, buildMs, description: map.description }, options };
    }

    #optionsOf(settings: Settings): string {
        return JSON.stringify(mapOptions(settings, this.#up));
    }

    delete(): void {
        for (const { map } of this.#built.values()) map.delete();
        this.#built.clear();
    }
}
