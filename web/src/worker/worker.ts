import { type Echinus, EchinusError, load } from 'echinus';
import type { FrameArrays, FromWorker, Stage, ToWorker } from '../protocol';
import { buffersOf, cellsOf, cutAt, lookAlong, lookAt, surfaceOf } from './looking';
import { type Reading, fetchSample, named, prepareFile } from './models';
import { type Look, Playground } from './playground';

/** Segments of a torus. The first is small: it gets each function compiled once, and costs no more than that saves. */
const FIRST = { major: 12, minor: 8 };
const LATER = { major: 60, minor: 24 };

/** By then the host has optimised the code. */
const MOST_ROUNDS = 8;

/**
 * Builds maps and discards them, as long as there is nothing else to do. A host compiles a function of the module on
 * its first call and optimises it after many calls: without this the first model's map takes three times as long.
 * @param needed  called after each round; messages and files are handled in between
 */
async function warmUp(echinus: Echinus, needed: () => boolean): Promise<void> {
    for (let round = 0; round < MOST_ROUNDS && !needed(); ++round) {
        buildOnce(echinus, round === 0 ? FIRST : LATER);
        await nextTask();
    }
}

function buildOnce(echinus: Echinus, { major, minor }: typeof FIRST): void {
    const torus = echinus.makeTorus(1, 0.4, major, minor);
    const { mesh } = torus.repair();
    const map = echinus.buildMap(mesh, { kind: 'exact' });
    for (const made of [map, mesh, torus]) made.delete();
}

/** Resumes after the messages that have arrived since. Not a timer: those wait four milliseconds. */
function nextTask(): Promise<void> {
    return new Promise((resolve) => {
        const { port1, port2 } = new MessageChannel();
        port1.onmessage = () => {
            port1.close();
            resolve();
        };
        port2.postMessage(null);
    });
}

/** The worker: one instance of the module, one playground, and a loop that the page drives frame by frame. */

/** The first model waits for the module only. */
let modelIsThere = false;
/** Started at once, while the page is still loading. */
const starting = load().then(
    async (echinus) => {
        await warmUp(echinus, () => modelIsThere);
        return echinus;
    },
    (error) => {
        throw new Error(`the WebAssembly module could not be loaded (${error.message}): load the page again`);
    },
);
starting.catch(() => {}); // opening a model reports the error

let playground: Playground | undefined;
/** The turn that opened the model. */
let opened = 0;
let paused = false;
/** Counts cloths, so that the page can recognise a late frame of an earlier one. */
let cloth = 0;
/** Files are read one after the other, so that answers keep the order of the requests. */
let queue = Promise.resolve();

self.onmessage = ({ data }: MessageEvent<ToWorker>) => {
    // Opening takes time; everything else queues behind it, so that a change never sees a half-built playground.
    queue = queue.then(() => answer(data));
};

async function answer(message: ToWorker): Promise<void> {
    const turn = 'turn' in message ? message.turn : undefined;
    try {
        await handle(message);
    } catch (error) {
        fail(error, turn);
    }
    if (turn !== undefined) tell({ kind: 'settled', turn, ...(playground && { inForce: { turn: opened, settings: playground.settings } }) });
}

async function handle(message: ToWorker): Promise<void> {
    switch (message.kind) {
        case 'open':
            return open(message);
        case 'pause':
            paused = message.paused;
            return;
    }
    if (!playground) return;
    const echinus = await starting;
    switch (message.kind) {
        case 'change': {
            const before = playground.mapNews;
            // Settings that only opening applies stay as opened: the change may belong to a model that then failed.
            const { model, mend, up, hand } = playground.settings;
            const anew = playground.change({ ...message.settings, model, mend, up }, (stage) => tell({ kind: 'progress', turn: message.turn, stage }));
            if (playground.mapNews !== before) tell({ kind: 'map', map: playground.mapNews });
            if (anew) tellCloth(playground, before === playground.mapNews ? 'changed' : 'map');
            else if (playground.settings.hand !== hand) tell({ kind: 'hand', ...(playground.clothNews.ball && { ball: playground.clothNews.ball }) });
            return;
        }
        case 'restart':
            playground.restart();
            return tellCloth(playground);
        case 'step':
            return tellFrame(playground.stepOnce(undefined));
        case 'frame':
            return tellFrame(advance(playground, message.arrays, message.until));
        case 'grab':
            return playground.grab(message.particle, message.target);
        case 'drag':
            return playground.hand.drag(message.target);
        case 'release':
            playground.shake.release();
            return playground.hand.release();
        case 'hold':
            return playground.hold(message.offset);
        case 'pointer':
            return playground.point(message.from, message.to);
        case 'ray':
            return tell(lookAlong(playground, message.direction));
        case 'point':
            return tell(lookAt(playground, message.from, message.to));
        case 'surface': {
            const news = surfaceOf(echinus, playground);
            return tell({ kind: 'surface', ...news }, buffersOf(news.faces));
        }
        case 'cells': {
            const news = cellsOf(playground);
            return news && tell({ kind: 'cells', ...news }, buffersOf(news.faces));
        }
        case 'rebuild':
            return tell({ kind: 'rebuilt', map: playground.rebuild() });
        case 'slice':
            return tell({ kind: 'cut', ...cutAt(echinus, playground, message.height) });
    }
}

async function open({ turn, settings, page, file, companions }: ToWorker & { kind: 'open' }): Promise<void> {
    const report = (stage: Stage) => tell({ kind: 'progress', turn, stage });
    report('reading');
    const read = await (file ? readFile(file, companions) : fetchSample(settings.model, page));
    modelIsThere = true;
    const echinus = await starting;
    const model = read(echinus);
    const next = named(model.name, () => new Playground(echinus, model, settings, report));
    playground?.delete(); // only now: a file that cannot be opened leaves the previous model
    playground = next;
    opened = turn;
    tellModel(playground);
    tellCloth(playground);
}

/** Queued with everything else, so that the later of two files stays. */
async function readFile(file: File, companions: readonly File[] = []): Promise<Reading> {
    const bytes = await file.arrayBuffer().catch(() => {
        throw new Error(`${file.name}: the browser cannot read this file`);
    });
    return prepareFile(file.name, bytes, companions);
}

/** A cloth that diverged stops; its last positions stay visible. */
function advance(playground: Playground, arrays: FrameArrays | undefined, until: number | undefined): Look {
    try {
        return playground.advance(paused, arrays, until);
    } catch (error) {
        paused = true;
        fail(error);
        return playground.advance(true, arrays);
    }
}

function tellModel(playground: Playground): void {
    tell({ kind: 'model', ...playground.news() });
}
/** @param why  it starts anew, unless it was asked for */
function tellCloth(playground: Playground, why?: 'changed' | 'map'): void {
    ++cloth;
    tell({ kind: 'cloth', ...playground.clothNews, ...(why && { why }) });
}
function tellFrame({ arrays, ...look }: Look): void {
    if (!playground) return;
    tell({ kind: 'frame', arrays, ...look, collider: playground.collider, cloth }, [
        arrays.positions.buffer,
        arrays.normals.buffer,
        arrays.depths.buffer,
        ...(look.shape ? [look.shape.vertices.buffer, look.shape.normals.buffer] : []),
    ]);
}

function fail(error: unknown, turn?: number): void {
    const sentence = error instanceof Error ? error.message : String(error);
    tell({ kind: 'failed', sentence, code: error instanceof EchinusError ? error.code : 'Internal', ...(turn !== undefined && { turn }) });
}
function tell(message: FromWorker, transfer: Transferable[] = []): void {
    self.postMessage(message, { transfer });
}
