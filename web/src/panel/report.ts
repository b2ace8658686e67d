import { isInsideOut } from '../inside_out';
import type { ModelNews } from '../protocol';
import { FAULT } from '../view/colours';
import { byId, make, swatch } from './elements';
import { count } from './numbers';

/** The mesh report: closed or not, and each fault with the colour that marks it on the model. */
export function showReport({ report, mendedFaces, flippedParts }: ModelNews): void {
    const parts = report.componentCount === 1 ? 'one part' : `${count(report.componentCount)} parts`;
    const lines = [
        make('p', `${count(report.faceCount)} faces, ${count(report.vertexCount)} vertices, ${parts}`),
        make('p', report.closed ? 'Closed: inside and outside are exact' : 'Open: sides are estimated near the gaps', report.closed ? 'good' : 'bad'),
        ...(isInsideOut(report) ? [make('p', 'Inside out: its faces look inwards', 'bad')] : []),
        ...faultLine(report.borderEdges.count, 'border edges', FAULT.borderEdges),
        ...faultLine(report.nonmanifoldEdges.count, 'edges of more than two faces', FAULT.nonmanifoldEdges),
        ...faultLine(report.misorientedEdges.count, 'edges between faces turned apart', FAULT.misorientedEdges),
        ...faultLine(report.duplicateFaces.count, 'faces that are there twice', FAULT.faces),
        ...faultLine(report.degenerateFaces.count, 'faces without area', FAULT.faces),
    ];
    if (mendedFaces > 0) lines.push(make('p', `${count(mendedFaces)} doubled faces left out`));
    if (flippedParts > 0) lines.push(make('p', `${count(flippedParts)} inside-out ${flippedParts === 1 ? 'part' : 'parts'} turned round`));
    byId('report').replaceChildren(...lines);
}

function faultLine(number: number, what: string, colour: number): HTMLElement[] {
    if (number === 0) return [];
    const line = make('p', `${count(number)} ${what}`);
    line.prepend(swatch(colour));
    return [line];
}
