import { WRONG } from '../view/colours';
import { byId, make, scaleBar, swatch } from './elements';

/** The legend of the cloth's colours: depth in the layer of contact, as measured by the worker (worker/depth.ts). */
export function fillDepthLegend(): void {
    const ends = make('div', '', 'ends');
    ends.append(make('span', 'no contact'), make('span', 'lies on it'), make('span', 'on the surface'));
    const inside = make('span', 'inside');
    inside.prepend(swatch(WRONG));
    byId('depth-legend').replaceChildren(scaleBar(), ends, inside);
}
