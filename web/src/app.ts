/** The page: brings the panel, the pictures and the workers together. */
import { type Ray, Vector3 } from 'three';
import { Address } from './address';
import { Client } from './client';
import { companionsOf, enableFiles } from './files';
import { fillGallery, showChosen } from './gallery';
import { enableKeys, enablePointer } from './input';
import { MapInspector } from './map_inspector';
import { Controls } from './panel/controls';
import { byId, fillDepthLegend, numbered, prefersStillness } from './panel/elements';
import { FigureStrip, showHalf, showHeadline, showReport } from './panel/figures';
import { Keep, type KeepWishes } from './panel/keep';
import { showMapFigures } from './panel/map_figures';
import { beQuiet, enableClosing, remark, say, showProgress } from './panel/notice';
import type { FromWorker, MapNews, ModelNews, ToWorker } from './protocol';
import { SAMPLES, type Sample, type Settings, UNDER_SHEETS, besideOf, collisionOf, consistent, fromLink, toLink, notTakenIn } from './settings';
import { Side } from './side';
import { Tour } from './tour';
import { BallView, ModelView } from './view/model_view';
import { Stage } from './view/stage';

/** By how many degrees a key turns the view, and its zoom factor. */
const TURN = 5;
const ZOOM = 1.1;

/** How often the words beneath the halves and the headline may change. */
const WORDS_MS = 250;

const HINTS: Record<Settings['hand'], (pulled: string, moved: string) => string> = {
    cloth: (pulled) => `Drag the ${pulled}, or the background to turn the view.`,
    ball: () => 'The ball follows the pointer. Drag to turn the view.',
    model: (_, moved) => `Drag the ${moved}, or the background to turn the view.`,
};
/** The deformable of a sample that the pointer pulls, and the model that it moves. */
const PULLED: Partial<Record<Sample, string>> = { figure: 'skirt', organ: 'organ', ring: 'kerchief', flag: 'flag' };
const MOVED: Partial<Record<Sample, string>> = { figure: 'dancer', organ: 'probe', ring: 'ring', flag: 'pole', layers: 'ball' };

/** A requested model: a file, or else the sample of the settings. */
interface Opening {
    turn: number;
    file: File | undefined;
}

class App {
    /** The requested settings. The panel shows them until the answer to the last turn reports those in force. */
    #settings: Settings = fromLink(location.hash);
    #asked: Opening = { turn: 0, file: undefined };
    /** Counts the requests that change the worker's state. */
    #turn = 0;
    /** The models that are shown and that have been requested. */
    #openings: Opening[] = [];
    #model: ModelNews | undefined;
    #map: MapNews | undefined;
    #paused = false;
    #worded = 0;

    readonly #stage = new Stage(byId<HTMLCanvasElement>('canvas'));
    readonly #modelView = new ModelView();
    readonly #ballView = new BallView();
    readonly #inspector = new MapInspector({
        settings: () => this.#settings,
        isGuided: () => this.#tour.runs,
        tell: (message) => this.#main.client.tell(message),
    });
    readonly #figures = new FigureStrip();
    readonly #keep: Keep;
    readonly #controls: Controls;
    readonly #address: Address;
    readonly #main: Side;
    /** The cloth in the other half of the picture. */
    #other: Side | undefined;
    readonly #tour: Tour;

    constructor(client: Client) {
        this.#main = new Side(client);
        this.#main.onCuts = (cuts) => this.#figures.showCuts(cuts);
        this.#stage.scene.add(this.#modelView.group, this.#main.view.group, this.#ballView.mesh, this.#inspector.view.group);
        this.#tour = new Tour({
            model: () => this.#model,
            settings: () => this.#settings,
            choose: (key, value) => this.#settings[key] !== value && this.#change({ ...this.#settings, [key]: value }, key),
            restart: () => this.#restart(),
            enter: () => this.#address.enter(),
            exit: () => this.#address.leave(() => this.#setLink(this.#settings)),
            showRay: (direction) => this.#inspector.showRay(direction),
            cut: (height) => this.#cut(height),
            picture: () => this.#stage.directions,
        });
        this.#controls = new Controls(this.#settings, (settings, key) => this.#follow(settings, key));
        this.#keep = new Keep({
            picture: () => this.#stage.picture(),
            meshes: () => this.#meshes(),
            link: () => this.#link(),
            hasFile: () => this.#asked.file !== undefined,
        });
        this.#bindButtons();
        this.#bindKeys();
        enableFiles((file) => {
            this.#tour.restore();
            this.#open(file);
        });
        this.#bindPointer();
        enableClosing();
        fillDepthLegend();
        fillGallery();
        this.#address = new Address((settings, file) => this.#arrive(settings, file));
        this.#stage.onArrival = () => this.#keepCamera();
        this.#stage.onLoss = () => say('The browser has lost the graphics context. If the picture does not return, load the page again.');
        this.#stage.onLook = () => this.#passLook();
        client.listen((message) => this.#hear(message));
        this.#showAll();
        if (prefersStillness()) this.#beginStill();
        this.#open(undefined);
        this.#sayWhatIsLacking();
        this.#stage.renderer.setAnimationLoop(() => this.#draw());
    }

    /** The visitor has followed a link in the page, or has gone back or forth. */
    #arrive(settings: Settings, file: File | undefined): void {
        const notTaken = notTakenIn(location.hash); // the page soon writes its own settings there
        this.#tour.end();
        if (toLink(settings) === toLink(this.#settings) && file === this.#asked.file) {
            beQuiet();
            this.#setLink(settings);
        } else {
            this.#settings = settings;
            this.#inView = '';
            this.#controls.show(settings);
            this.#showAll();
            this.#open(file);
        }
        this.#sayWhatIsLacking(notTaken);
    }

    #sayWhatIsLacking(notTaken = notTakenIn(location.hash)): void {
        if (this.#address.lost) say(`${this.#address.lost} was open here. The page loses files when it is loaded again: open the file once more.`);
        else if (notTaken.length > 0) say(`The page cannot take these parts of the link: ${shortened(notTaken.join(', '))}.`);
    }

    // ---- The worker

    #open(file: File | undefined): void {
        this.#tour.leave();
        beQuiet();
        byId('subtitle').textContent = file ? `Opening ${file.name}` : 'Loading';
        this.#controls.showFile(file?.name);
        this.#controls.show(this.#settings);
        this.#asked = { turn: ++this.#turn, file };
        this.#openings.push(this.#asked);
        this.#main.client.tell(this.#opening(this.#settings));
        if (this.#other) this.#endBeside();
    }

    #opening(settings: Settings): ToWorker {
        const { turn, file } = this.#asked;
        return { kind: 'open', turn, settings, page: document.baseURI, ...(file && { file, companions: companionsOf(file) }) };
    }

    #hear(message: FromWorker): void {
        if (this.#inspector.hear(message)) return;
        if (this.#main.hear(message)) {
            if (message.kind === 'cloth') this.#beginCloth(message.why);
            return;
        }
        switch (message.kind) {
            case 'model':
                return this.#showModel(message);
            case 'progress':
                return this.#showProgress(message);
            case 'map':
                return this.#useMap(message.map);
            case 'rebuilt':
                return this.#showMap(message.map);
            case 'failed':
                return this.#fail(message);
            case 'settled':
                return this.#settle(message);
        }
    }

    #beginCloth(why: 'changed' | 'map' | undefined): void {
        if (why) this.#letFall();
        this.#figures.forgetCounts();
        this.#main.view.byDepth = this.#settings.colour === 'depth';
        if (why) remark(why === 'map' ? 'The cloth starts again, on the other map.' : startsAgain(this.#particles, this.#cloths));
        if (this.#settings.beside !== 'nothing' && !this.#other) this.#beginBeside();
    }

    get #particles(): number {
        if (this.#main.view.positions) return this.#main.view.positions.length / 3;
        return this.#cloths * Math.round(Math.sqrt(this.#settings.particles / this.#cloths)) ** 2; // it has not fallen yet
    }

    #showProgress({ turn, stage }: FromWorker & { kind: 'progress' }): void {
        const { file } = this.#asked;
        const isSample = !file && turn === this.#asked.turn; // which is there at once
        if (turn !== this.#turn || isSample) return; // or there are newer requests
        showProgress(file ? `${file.name}: ${stage}` : stage[0].toUpperCase() + stage.slice(1), () => this.#cancel());
    }

    /** Opens again what was open before, with the settings that were in force. */
    #cancel(): void {
        const before = this.#openings[0];
        this.#main.client.stop();
        this.#main.forget();
        this.#openings = [];
        this.#inspector.forgive();
        showProgress(undefined);
        if (this.#inForce) this.#settings = this.#withOwn(this.#inForce);
        this.#showAll();
        this.#open(before?.file);
        remark('Cancelled.');
    }
    /** The settings of the present model, map and cloth, as the last answer reported them. */
    #inForce: Settings | undefined;

    #fail({ sentence, code, turn }: FromWorker & { kind: 'failed' }): void {
        if (turn === undefined) {
            this.#inspector.forgive();
            this.#main.forgive(); // the frame may have been waiting for one of these
        } else if (turn < this.#asked.turn) return; // another model has been opened since
        if (code === 'Diverged') this.#pause(true);
        if (code === 'Crashed') this.#beginAgain();
        showProgress(undefined);
        if (!this.#model && turn === this.#asked.turn && this.#settings.model === 'horse') return this.#openInstead(sentence);
        say(sentence);
    }

    /** The horse is a file, which a server may lack. */
    #openInstead(sentence: string): void {
        this.#change({ ...this.#settings, model: 'torus' }, 'model');
        say(`${sentence}. The page shows a torus instead.`);
    }

    /** After a crash the page returns to a sample, unless no model was open: then the sample may be the cause. */
    #beginAgain(): void {
        const wasWell = this.#model !== undefined;
        this.#model = undefined;
        this.#openings = [];
        this.#asked = { turn: 0, file: undefined };
        this.#main.forget();
        this.#endBeside();
        this.#controls.showFile(undefined);
        this.#controls.show(this.#settings);
        byId('subtitle').textContent = '';
        if (wasWell) this.#open(undefined);
    }

    /** The panel must show exactly the settings in force, after a refusal too. */
    #settle({ turn, inForce }: FromWorker & { kind: 'settled' }): void {
        this.#openings = this.#openings.filter((opening) => opening.turn === inForce?.turn || opening.turn > turn);
        if (inForce) this.#inForce = inForce.settings;
        if (turn !== this.#turn) return; // there are newer requests
        showProgress(undefined);
        const shown = this.#openings[0];
        const settings = inForce ? this.#withOwn(inForce.settings) : this.#settings;
        if (shown === this.#asked && toLink(settings) === toLink(this.#settings)) return;
        this.#asked = shown ?? { turn: 0, file: undefined };
        this.#setLink(settings);
        this.#controls.showFile(this.#asked.file?.name);
        this.#controls.show(settings);
        this.#showColours();
        this.#showHand();
        if (this.#model) this.#showNote(settings.map);
        if (this.#model) this.#showTitle(this.#model);
        else byId('subtitle').textContent = '';
    }

    /** Settings of the worker, with what only the page knows. */
    #withOwn(settings: Settings): Settings {
        const { view, shown, slice, camera, look, beside } = this.#settings;
        return { ...settings, view, shown, slice, camera, look, beside };
    }

    #showModel(model: ModelNews): void {
        this.#letFall();
        this.#model = model;
        this.#main.model = model;
        this.#modelView.show(model);
        byId('poster').hidden = true;
        this.#inspector.model = model;
        this.#pointCamera(model);
        this.#showTitle(model);
        showReport(model);
        this.#useMap(model.map);
        byId('horse-notice').hidden = !SAMPLES.includes('horse');
    }

    /** The same model again, for instance mended: the camera stays. */
    #pointCamera({ name, sight, floor, up }: ModelNews): void {
        const inView = JSON.stringify([name, sight, up]);
        if (inView === this.#inView) return;
        this.#inView = inView;
        this.#stage.lookAt({ ...sight, up, floor });
        if (this.#asked.file) this.#setLink({ ...this.#settings, camera: '' }); // that camera was for another model
        else if (this.#settings.camera) this.#stage.standpoint = this.#settings.camera;
    }
    #inView = '';

    #useMap(map: MapNews): void {
        this.#showMap(map);
        this.#showNote(map.kind);
        document.body.classList.toggle('map-exact', map.kind === 'exact');
        document.body.classList.toggle('map-distance', map.kind === 'distance');
        this.#inspector.map = map;
    }

    #showNote(map: MapNews['kind']): void {
        byId('map-note').textContent = mapNote(map, this.#model!.report.closed, this.#settings.surfaces);
    }

    #showMap(map: MapNews): void {
        this.#map = map;
        showMapFigures(map);
        this.#figures.showMap(map);
    }

    #showTitle(model: ModelNews): void {
        byId('subtitle').textContent = `${model.name}, ${numbered(model.report.faceCount, 'face', 'faces')}`;
        this.#setLink(this.#settings); // the history knows the model now
        this.#showHand();
        byId('cloths').hidden = !this.#hasSheets;
    }

    get #hasSheets(): boolean {
        return this.#asked.file !== undefined || UNDER_SHEETS.includes(this.#settings.model);
    }

    get #cloths(): number {
        return this.#hasSheets ? this.#settings.cloths : 1;
    }

    /** For now: the visitor's own setting stays. */
    #cut(height: number): void {
        this.#controls.show({ ...this.#settings, slice: height });
        this.#main.client.tell({ kind: 'slice', height });
    }

    // ---- The other half

    #beginBeside(): void {
        const other = new Side(new Client());
        this.#other = other;
        other.model = this.#model!;
        other.view.fine = this.#stage.fine;
        other.view.byDepth = this.#settings.colour === 'depth';
        this.#stage.scene.add(other.view.group);
        other.client.listen((message) => {
            if (other.hear(message) || this.#other !== other) return;
            if (message.kind === 'failed') {
                say(`In the other half: ${message.sentence}`);
                this.#choose('beside', 'nothing');
            }
        });
        other.client.tell(this.#opening(besideOf(this.#settings)));
        this.#stage.halves = [() => this.#showSide(this.#main, other), () => this.#showSide(other, this.#main)];
        byId('halves').hidden = false;
        this.#main.client.tell({ kind: 'restart' });
        this.#letFall();
    }

    #endBeside(): void {
        this.#other?.stop();
        this.#other = undefined;
        this.#stage.halves = [() => {}];
        this.#main.view.group.visible = this.#settings.view === 'cloth';
        byId('halves').hidden = true;
    }

    /** Updates the objects that the scene shows in one half. */
    #showSide(side: Side, hidden: Side): void {
        const cloth = this.#settings.view === 'cloth';
        side.view.group.visible = cloth;
        hidden.view.group.visible = false;
        if (side.collider) this.#modelView.follow(side.collider);
        this.#modelView.deform(side.shape);
        this.#ballView.show(cloth ? side.ball : undefined);
    }

    /** To both, where there are two. */
    #tell(message: ToWorker): void {
        this.#main.client.tell(message);
        this.#other?.client.tell(message);
    }

    // ---- Frames

    #draw(): void {
        const other = this.#other;
        const asks = this.#settings.view === 'cloth' && this.#model !== undefined;
        const next = this.#main.advance(asks, other?.limit ?? Infinity);
        other?.advance(asks && other.news !== undefined, this.#main.limit);
        if (next) {
            this.#figures.add(next.figures);
            // The tests wait for this.
            document.body.dataset.paused = String(next.figures.paused);
            document.body.dataset.rest = String(next.figures.atRest);
            document.body.dataset.frame = String(next.figures.frame);
        }
        if (!other) {
            if (next) this.#modelView.follow(next.collider);
            this.#modelView.deform(this.#main.shape);
            this.#ballView.show(asks ? this.#main.ball : undefined);
        }
        this.#inspector.view.reveal();
        this.#stage.draw();
        this.#figures.countDrawing();
        this.#word();
    }

    #word(): void {
        const now = performance.now();
        if (now - this.#worded < WORDS_MS || !this.#map) return;
        const { news, view, counts } = this.#main;
        const falls = this.#settings.view === 'cloth';
        if (falls && !(news && view.positions)) return;
        this.#worded = now;
        showHeadline(this.#map, falls && news ? { place: this.#other ? 'Left: ' : '', particles: this.#particles, soft: news.soft, counts, ...collisionOf(this.#settings), slowness: this.#figures.slowness.times } : undefined);
        if (!this.#other) return;
        const [left, right] = this.#settings.beside === 'map' ? ['Exact map', 'The paper\u2019s map'] : ['Surface collision', 'Particles only'];
        showHalf('half-left', left, this.#main.counts);
        showHalf('half-right', right, this.#other.counts);
    }

    // ---- The visitor's actions

    /** Applies a choice of the visitor, which ends the tour. */
    #follow(settings: Settings, key: keyof Settings): void {
        this.#tour.leave(); // which may have shown another cut than the visitor's
        this.#change({ ...this.#settings, [key]: settings[key] }, key);
    }

    #change(settings: Settings, key: keyof Settings): void {
        if (key === 'model' || key === 'up') settings = { ...settings, camera: '' };
        settings = consistent(settings, key);
        const before = this.#settings;
        this.#controls.show(settings);
        if (key === 'model') this.#settings = settings; // the entry of an open file stays as it is
        else this.#setLink(settings);
        if (settings.beside !== before.beside) this.#endBeside();
        switch (key) {
            case 'view':
                return this.#showView();
            case 'look':
                return this.#showLook();
            case 'slice':
                return this.#main.client.tell({ kind: 'slice', height: settings.slice });
            case 'shown':
                this.#inspector.askForCells();
                return this.#inspector.showColours();
            case 'model':
                return this.#open(undefined);
            case 'mend':
            case 'up':
                return this.#open(this.#asked.file);
        }
        this.#showColours();
        this.#showHand();
        if (this.#model && (key === 'surfaces' || key === 'self')) this.#showNote(settings.map);
        this.#main.client.tell({ kind: 'change', turn: ++this.#turn, settings });
        this.#other?.client.tell({ kind: 'change', turn: this.#turn, settings: besideOf(settings) });
        if (settings.beside !== 'nothing' && !this.#other && this.#model) this.#beginBeside();
    }

    #keepCamera(): void {
        const camera = this.#stage.standpoint;
        if (camera !== this.#settings.camera) this.#setLink({ ...this.#settings, camera });
    }

    #setLink(settings: Settings): void {
        const { file } = this.#asked;
        this.#settings = settings;
        if (!this.#tour.runs) this.#address.show(settings, file); // which would come back without the tour
        showChosen(file ? undefined : settings);
        byId('whole-view').hidden = settings.camera === '';
    }

    #showAll(): void {
        this.#showView();
        this.#showColours();
        this.#showHand();
        this.#showLook();
    }

    #showColours(): void {
        const byDepth = this.#settings.colour === 'depth';
        for (const side of [this.#main, this.#other]) if (side) side.view.byDepth = byDepth;
        byId('depth-legend').hidden = !byDepth;
    }

    #showHand(): void {
        this.#main.keepsOffItself = this.#figures.countsOwn = collisionOf(this.#settings).self;
        const sample = this.#asked.file ? undefined : this.#settings.model;
        const pulled = (sample && PULLED[sample]) ?? 'cloth', moved = (sample && MOVED[sample]) ?? 'model';
        byId('pull').textContent = `Pull ${pulled}`;
        byId('push').textContent = `Push ${pulled}`;
        byId('move').textContent = `Move ${moved}`;
        const hint = HINTS[this.#settings.hand](pulled, moved);
        if (byId('hint').textContent === hint) return;
        byId('hint').textContent = hint;
        if (this.#settings.view === 'cloth' && byId('hint').offsetParent === null) remark(hint); // a small window has no place for it
    }

    #showLook(): void {
        this.#stage.look = this.#settings.look;
        this.#passLook();
    }

    /** The stage chooses the look, if nobody else has. */
    #passLook(): void {
        for (const side of [this.#main, this.#other]) if (side) side.view.fine = this.#stage.fine;
        document.body.dataset.look = this.#stage.fine ? 'fine' : 'light'; // the tests read this
    }

    #showView(): void {
        const map = this.#settings.view === 'map';
        document.body.classList.toggle('view-map', map);
        document.body.classList.toggle('view-cloth', !map);
        this.#modelView.group.visible = !map;
        this.#main.view.group.visible = !map;
        this.#stage.ground.visible = !map;
        this.#inspector.view.group.visible = map;
        if (map) this.#figures.slowness.forget(); // the cloth stands still meanwhile
        if (map && this.#other) this.#endBeside();
        else if (!map && this.#settings.beside !== 'nothing' && this.#model && !this.#other) this.#beginBeside();
        this.#inspector.ask();
    }

    #beginStill(): void {
        this.#pause(true);
        remark('Your system asks for reduced motion: the cloth waits until you resume.');
    }
    #pause(paused: boolean): void {
        this.#paused = paused;
        byId('pause').textContent = paused ? 'Resume' : 'Pause';
        this.#tell({ kind: 'pause', paused });
    }
    /** A new cloth falls; who pauses it after asking for it is heeded. */
    #letFall(): void {
        if (this.#paused && !prefersStillness()) this.#pause(false);
    }
    #step(): void {
        this.#pause(true);
        this.#main.step();
        this.#other?.step();
    }
    #restart(): void {
        beQuiet();
        this.#tell({ kind: 'restart' });
        this.#pause(false);
    }
    #switchView(): void {
        this.#choose('view', this.#settings.view === 'map' ? 'cloth' : 'map');
    }
    #switchMap(): void {
        this.#choose('map', this.#settings.map === 'exact' ? 'distance' : 'exact');
    }
    #switchBeside(): void {
        const next = { nothing: 'map', map: 'particles', particles: 'nothing' } as const;
        this.#choose('beside', next[this.#settings.beside]);
    }
    #compareWith(beside: Settings['beside']): void {
        scrollTo({ top: 0 }); // to the picture, on a small screen
        this.#choose('beside', beside);
    }
    #choose<K extends keyof Settings>(key: K, value: Settings[K]): void {
        this.#follow({ ...this.#settings, [key]: value }, key);
    }

    #bindButtons(): void {
        const actions: Record<string, () => void> = {
            pause: () => this.#pause(!this.#paused),
            step: () => this.#step(),
            restart: () => this.#restart(),
            rebuild: () => this.#main.client.tell({ kind: 'rebuild' }),
            'tour-begin': () => this.#tour.begin(),
            'whole-view': () => this.#showWhole(),
            'see-particles': () => this.#compareWith('particles'),
            'see-map': () => this.#compareWith('map'),
        };
        for (const [id, action] of Object.entries(actions)) byId(id).addEventListener('click', action);
    }

    #bindKeys(): void {
        // These actions have no visible effect in the view of the map.
        const ofCloth = (action: () => void) => () => this.#settings.view === 'cloth' && action();
        enableKeys({
            ' ': ofCloth(() => this.#pause(!this.#paused)),
            s: ofCloth(() => this.#step()),
            r: ofCloth(() => this.#restart()),
            c: ofCloth(() => this.#switchBeside()),
            m: () => this.#switchView(),
            x: () => this.#switchMap(),
            t: () => this.#tour.begin(),
            p: () => void this.#keep.savePicture(),
            enter: () => this.#tour.next(),
            escape: () => this.#tour.end(),
            arrowleft: () => this.#stage.turn(-TURN, 0),
            arrowright: () => this.#stage.turn(TURN, 0),
            arrowup: () => this.#stage.turn(0, TURN),
            arrowdown: () => this.#stage.turn(0, -TURN),
            '+': () => this.#stage.turn(0, 0, ZOOM),
            '-': () => this.#stage.turn(0, 0, 1 / ZOOM),
            '0': () => this.#showWhole(),
        });
    }

    #showWhole(): void {
        this.#stage.standpoint = '';
    }

    #bindPointer(): void {
        enablePointer(byId<HTMLCanvasElement>('canvas'), this.#stage, {
            hand: () => (this.#settings.view === 'cloth' ? this.#settings.hand : undefined),
            clothAt: (x) => (this.#other && x >= 0.5 ? this.#other : this.#main).view,
            grab: (particle, target) => this.#tell({ kind: 'grab', particle, target }),
            drag: (target) => this.#tell({ kind: 'drag', target }),
            hold: (offset) => this.#tell({ kind: 'hold', offset }),
            release: () => this.#tell({ kind: 'release' }),
            lead: (ray) => this.#lead(ray),
            hover: (ray) => this.#inspector.lookUnder(ray),
            obstacle: this.#modelView.clay,
        });
    }

    #lead(ray: Ray): void {
        if (!this.#model) return;
        const { centre, radius } = this.#model.sight;
        const reach = ray.origin.distanceTo(new Vector3(...centre)) + 3 * radius;
        this.#tell({ kind: 'pointer', from: ray.origin.toArray(), to: ray.at(reach, new Vector3()).toArray() });
    }

    // ---- What is kept

    #meshes(): ReturnType<KeepWishes['meshes']> {
        const { positions, faces } = this.#main.view;
        if (!positions || !this.#model) return undefined;
        const vertices = this.#modelView.verticesNow(this.#main.shape?.vertices ?? this.#model.vertices);
        const ofHorse = 'The object "model" is horse.3ds of glmark2-data, licence GPL-3 or later; it is not part of Echinus.';
        return {
            meshes: [{ name: 'cloth', vertices: positions, faces }, { name: 'model', vertices, faces: this.#model.faces }],
            notices: this.#model.name === 'horse.3ds' ? [ofHorse] : [],
        };
    }

    #link(): string {
        if (this.#model) this.#keepCamera(); // the camera may still be moving
        return `${location.origin}${location.pathname}#${toLink(this.#settings)}`;
    }
}

function startsAgain(particles: number, cloths: number): string {
    const number = numbered(particles, 'particle', 'particles');
    return cloths === 1 ? `The cloth starts again, with ${number}.` : `${cloths} cloths start again, with ${number} in total.`;
}

/** Of a link that may be anything. */
const shortened = (text: string): string => (text.length > 80 ? `${text.slice(0, 80)}\u2026` : text);

function mapNote(kind: MapNews['kind'], closed: boolean, surfaces: boolean): string {
    if (kind === 'distance') return 'The push-out leads along the ray from the centre, as in the paper. The cloth creeps along a leg of the horse.';
    if (surfaces) return 'The push-out leads to the nearest point. No face of the cloth passes through the surface, closed or open.';
    if (closed) return 'The push-out leads to the nearest point. No particle passes through the surface; sharp parts of the model may come through between particles.';
    return 'The push-out leads to the nearest point. The mesh is open: near its holes inside or outside is a guess, and particles may get in there.';
}

export function begin(client: Client): void {
    new App(client);
}
