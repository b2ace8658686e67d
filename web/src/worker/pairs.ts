/** A worker of its own, with its own instance of the module, that counts faces which intersect: the cloth never waits for it. */
import { type Echinus, type Mesh, load } from 'echinus';
import type { Cuts, PairsQuestion } from '../protocol';
import { intoFrameOf } from '../frames';

const starting = load();
let model: { faces: Uint32Array; mesh: Mesh } | undefined;
/** Questions are answered in order, also while the module is loading. */
let queue: Promise<void> = Promise.resolve();

self.onmessage = ({ data }: MessageEvent<PairsQuestion>) => {
    queue = queue.then(async () => answer(await starting, data));
};

function answer(echinus: Echinus, question: PairsQuestion): void {
    if (question.model) {
        model?.mesh.delete();
        model = { faces: question.model.faces, mesh: echinus.makeMesh(question.model.vertices, question.model.faces) };
    }
    if (!model) return;
    const begin = performance.now();
    intoFrameOf(question.collider, question.positions, question.positions);
    const cloth = echinus.makeMesh(question.positions, question.faces);
    const now = question.shape && echinus.makeMesh(question.shape, model.faces);
    const withModel = cloth.intersectingPairs(now ?? model.mesh);
    const own = cloth.selfIntersectingPairs();
    cloth.delete();
    now?.delete();
    const cuts: Cuts = {
        number: question.number,
        withModel: withModel.length / 2,
        own: own.length / 2,
        cutFaces: Uint32Array.from(new Set(withModel.filter((_, i) => i % 2 === 0))),
        ownFaces: Uint32Array.from(new Set(own)),
        ms: performance.now() - begin,
    };
    self.postMessage(cuts);
}
