import type { CellNews, Difference, FromWorker, MapNews, SurfaceNews } from '../protocol';
import type { Settings } from '../settings';
import { LAYERS } from '../view/colours';
import { byId, bytes, count, make, milliseconds, scaleBar, swatch } from './elements';

/** The map in numbers. */
export function showMapFigures({ description, byteCount, buildMs }: MapNews): void {
    const rows: [string, string][] = [
        ['memory', bytes(byteCount)],
        ['built in', milliseconds(buildMs)],
    ];
    if (description.kind === 'exact')
        rows.push(
            ['cells', count(description.cellCount)],
            ['bands', count(description.bandCount)],
            ['longest list of faces', count(description.longestList)],
            ['mean tests of a query near the surface', description.expectedTests.toFixed(2)],
        );
    else
        rows.push(
            ['directions', count(description.directionCount)],
            ['distances stored', count(description.entryCount)],
            ['most along one direction', count(description.maxEntries)],
            ['distances corrected', count(description.correctedEntries)],
        );
    byId('map-figures').replaceChildren(
        ...rows.map(([name, value]) => {
            const row = document.createElement('tr');
            row.append(make('th', name), make('td', value));
            return row;
        }),
    );
}

/** The meaning of the colours, and how often the two kinds of map differ. @param cells  where they are there */
export function showLegend(surface: SurfaceNews, cells: CellNews | undefined, shown: Settings['shown']): void {
    if (surface.mapKind === 'distance') return byId('legend').replaceChildren(...layerLegend(surface));
    if (shown === 'cells' && cells) byId('legend').replaceChildren(...scaleLegend('Number of faces that a cell of directions lists', 0, cells.largest));
    else byId('legend').replaceChildren(...scaleLegend('Number of faces that a query near the surface may have to test', 1, surface.largest));
}

function scaleLegend(title: string, least: number, largest: number): HTMLElement[] {
    const ends = make('div', '', 'ends');
    ends.append(make('span', String(least)), make('span', String(largest)));
    return [make('span', title), scaleBar(), ends];
}

function layerLegend({ largest, differences }: SurfaceNews): HTMLElement[] {
    const layers = make('div', '', 'layers');
    for (let layer = 0; layer <= largest; ++layer) {
        const item = make('span', `layer ${layer + 1}`);
        item.prepend(swatch(LAYERS[layer % LAYERS.length]));
        layers.append(item);
    }
    return [layers, ...(differences ? [make('p', sentenceOn(differences), 'note')] : [])];
}

function sentenceOn({ near, everywhere }: NonNullable<SurfaceNews['differences']>): string {
    const percent = ({ points, sampleCount }: Difference) => `${((100 * points.length) / 3 / sampleCount).toFixed(2)}\u2009%`;
    return `The answer, inside or outside, differs from that of the exact map at ${percent(near)} of the points within ${near.within}\u2009R of the surface, and at ${percent(everywhere)} of all points in the bounding sphere. The picture shows these points in red.`;
}

export function forgetRay(): void {
    byId('ray').textContent = 'Point at the surface.';
}

export function showRay({ intervals, bands }: FromWorker & { kind: 'ray' }, radius: number): void {
    const inside = intervals.filter((interval) => interval.inside);
    const places = inside.map(({ from, to }) => `${(from / radius).toFixed(3)} to ${(to / radius).toFixed(3)}\u2009R`);
    const where = places.length === 0 ? 'Outside along its whole length.' : `Inside from ${places.join(', from ')}.`;
    byId('ray').textContent = bands.length === 0 ? where : `${where} The map looks for surface in ${bands.length === 1 ? 'one band' : `${count(bands.length)} bands`}, in blue.`;
}
