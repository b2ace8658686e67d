import { isInsideOut } from '../inside_out';
import type { ModelNews } from '../protocol';
import { FAULT } from '../view/colours';
import { byId, make, swatch } from './elements';
import { count, numbered } from './numbers';

/** The mesh report: closed or not, and each fault with the colour that marks it on the model. */
export function showReport({ report, mendedFaces, flippedParts, certainShare }: ModelNews): void {
    const parts = report.componentCount === 1 ? 'one part' : `${count(report.componentCount)} parts`;
    const lines = [
        make('p', `${numbered(report.faceCount, 'face', 'faces')}, ${numbered(report.vertexCount, 'vertex', 'vertices')}, ${parts}`),
        make('p', report.closed ? 'Closed: inside and outside are exact' : 'Open: sides are estimated near the gaps', report.closed ? 'good' : 'bad'),
        ...(report.closed ? [] : [make('p', whatOpenMeans(certainShare), 'note')]),
        ...(isInsideOut(report) ? [make('p', 'Inside out: its faces look inwards', 'bad')] : []),
        ...faultLine(report.borderEdges.count, 'border edge', 'border edges', FAULT.borderEdges),
        ...faultLine(report.nonmanifoldEdges.count, 'edge of more than two faces', 'edges of more than two faces', FAULT.nonmanifoldEdges),
        ...faultLine(report.misorientedEdges.count, 'edge between faces turned apart', 'edges between faces turned apart', FAULT.misorientedEdges),
        ...faultLine(report.duplicateFaces.count, 'face that is there twice', 'faces that are there twice', FAULT.faces),
        ...faultLine(report.degenerateFaces.count, 'face without area', 'faces without area', FAULT.faces),
    ];
    if (mendedFaces > 0) lines.push(make('p', `${numbered(mendedFaces, 'face', 'faces')} left out that repeated others`));
    if (flippedParts > 0) lines.push(make('p', `${numbered(flippedParts, 'inside-out part', 'inside-out parts')} turned round`));
    byId('report').replaceChildren(...lines);
}

/** For somebody who has never had to think about it. */
function whatOpenMeans(certainShare: number): string {
    const share = `${(100 * certainShare).toFixed(certainShare > 0.995 && certainShare < 1 ? 2 : 0)}\u2009%`;
    return `Its faces do not enclose a solid, so near its gaps what is inside is a guess; in ${share} of the ball around it the answer is certain. As long as surfaces collide, no face of the cloth gets through it all the same. Close its holes in the program it came from, or by "echinus mesh repair", and all answers are certain.`;
}

function faultLine(number: number, one: string, many: string, colour: number): HTMLElement[] {
    if (number === 0) return [];
    const line = make('p', numbered(number, one, many));
    line.prepend(swatch(colour));
    return [line];
}
