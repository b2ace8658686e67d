import type { ColliderState } from 'echinus';
import type { Client } from './client';
import { Pairs } from './pairs';
import type { ClothNews, Cuts, FromWorker, ModelNews, ModelShape, Triple } from './protocol';
import { ClothView } from './view/cloth_view';

/** How many sets of arrays are in circulation: one is shown while the other is filled. */
const FRAMES_UNDER_WAY = 2;

type Frame = FromWorker & { kind: 'frame' };

/** The faults of a cloth, as far as they have been counted. */
export interface Counts {
    /** Of a closed model. */
    inside?: number;
    withModel?: number;
    own?: number;
}

/** By how many frames one of two cloths side by side may be ahead. */
const AHEAD = 8;

/** A cloth: the worker that simulates it, its picture, and what is wrong with it. The page has one, or two side by side. */
export class Side {
    readonly client: Client;
    readonly view = new ClothView();
    collider: ColliderState | undefined;
    /** Of the model, where it has deformed. */
    shape: ModelShape | undefined;
    ball: { radius: number; position?: Triple } | undefined;
    counts: Counts = {};
    frame = 0;
    keepsOffItself = false;
    news: ClothNews | undefined;
    /** Called with the counts of faces that intersect. */
    onCuts = (_cuts: Cuts) => {};
    readonly #pairs = new Pairs((cuts) => this.#showCuts(cuts));
    /** The number of the cloth shown; frames of earlier ones are dropped. */
    #cloth = 0;
    #framesAsked = 0;
    #arrived: Frame[] = [];
    #atRest = false;

    constructor(client: Client) {
        this.client = client;
    }

    set model(model: ModelNews) {
        this.#arrived = []; // of the model before
        this.shape = undefined;
        this.#pairs.model = model;
    }

    /** @returns whether the message was about the cloth itself */
    hear(message: FromWorker): boolean {
        switch (message.kind) {
            case 'cloth':
                ++this.#cloth;
                this.#arrived = [];
                this.news = message;
                this.frame = 0;
                this.shape = undefined;
                this.#atRest = false;
                this.counts = {};
                this.view.begin(message);
                this.#setBall(message.ball);
                return true;
            case 'hand':
                this.#setBall(message.ball);
                return true;
            case 'frame':
                this.#framesAsked = Math.max(0, this.#framesAsked - 1);
                if (message.cloth === this.#cloth) this.#arrived.push(message);
                return true;
        }
        return false;
    }

    #setBall(radius: number | undefined): void {
        this.ball = radius === undefined ? undefined : { ...this.ball, radius };
    }

    /** The last frame to which a half beside this one may go: they keep in step until one of them rests. */
    get limit(): number {
        return this.#atRest ? Infinity : this.frame + AHEAD;
    }

    /** The answer to a question may never come. */
    forgive(): void {
        this.#framesAsked = 0;
    }
    /** Asks for a single step, whose answer is a frame. */
    step(): void {
        ++this.#framesAsked;
        this.client.tell({ kind: 'step' });
    }
    /** Another worker will count its cloths anew. */
    forget(): void {
        this.#cloth = 0;
        this.#arrived = [];
        this.#framesAsked = 0;
        this.frame = 0;
    }

    /**
     * Shows the next frame, and asks for more where `asks`.
     * @param until  the last frame that may be made @returns the frame that is new
     */
    advance(asks: boolean, until: number): Frame | undefined {
        const next = this.#arrived.shift();
        let spare;
        if (next) {
            spare = this.view.show(next.arrays);
            this.view.markWrong(next.wrong);
            this.collider = next.collider;
            this.shape = next.shape;
            this.frame = next.figures.frame;
            this.#atRest = next.figures.atRest;
            this.counts = { ...this.counts, inside: next.figures.inside };
            if (this.ball && next.ball) this.ball.position = next.ball;
            this.#pairs.consider(this.#cloth, next.figures.frame, next.arrays.positions, this.view.faces, next.collider, next.shape?.vertices);
        }
        while (asks && this.#framesAsked < FRAMES_UNDER_WAY && this.#arrived.length === 0) {
            ++this.#framesAsked;
            const question = { kind: 'frame' as const, ...(spare && { arrays: spare }), ...(Number.isFinite(until) && { until }) };
            this.client.tell(question, spare ? [spare.positions.buffer, spare.normals.buffer, spare.depths.buffer] : []);
            spare = undefined;
        }
        return next;
    }

    #showCuts(cuts: Cuts): void {
        if (cuts.number !== this.#cloth) return;
        // A cloth that need not keep off itself does nothing wrong.
        this.view.markCut(this.keepsOffItself ? Uint32Array.from(new Set([...cuts.cutFaces, ...cuts.ownFaces])) : cuts.cutFaces);
        this.counts = { ...this.counts, withModel: cuts.withModel, own: cuts.own };
        this.onCuts(cuts);
    }

    stop(): void {
        this.client.stop();
        this.#pairs.stop();
        this.view.dispose();
    }
}
