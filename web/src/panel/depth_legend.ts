import { FAULT } from '../view/colours';
import { byId, make, scaleBar, swatch } from './elements';

/** What the colours of the cloth mean: depth in the layer of contact, as the worker measures it (depth.ts there). */
export function fillDepthLegend(): void {
    const ends = make('div', '', 'ends');
    ends.append(make('span', 'no contact'), make('span', 'lies on it'), make('span', 'on the surface'));
    const inside = make('span', 'inside');
    inside.prepend(swatch(FAULT.faces));
    byId('depth-legend').replaceChildren(scaleBar(), ends, inside);
}
