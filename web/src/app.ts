/** The page: brings the panel, the pictures and the worker together. */
import type { Raycaster } from 'three';
import { furthestAlong } from './axes';
import type { Client } from './client';
import { enableFiles } from './files';
import { enableKeys } from './keys';
import { Controls } from './panel/controls';
import { fillDepthLegend } from './panel/depth_legend';
import { byId } from './panel/elements';
import { FigureStrip } from './panel/figures';
import { showLegend, showMapFigures, showRay } from './panel/map_figures';
import { beQuiet, enableClosing, say } from './panel/notice';
import { count } from './panel/numbers';
import { showReport } from './panel/report';
import { Pairs } from './pairs';
import { enablePointer } from './pointer';
import type { Cuts, FromWorker, MapNews, ModelNews, SurfaceNews, Triple } from './protocol';
import { objText, saveAs } from './saving';
import { SAMPLES, type Settings, consistent, fromLink, toLink } from './settings';
import { ClothView } from './view/cloth_view';
import { MapView } from './view/map_view';
import { ModelView } from './view/model_view';
import { Stage } from './view/stage';

/** How many sets of arrays are in circulation: one is shown while the other is filled. */
const FRAMES_UNDER_WAY = 2;

/** How long the hint stays. */
const HINT_MS = 12_000;

/** By how many degrees a key turns the view, and its zoom factor. */
const TURN = 5;
const ZOOM = 1.1;

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
    /** What is shown, and what has been requested. */
    #openings: Opening[] = [];
    #model: ModelNews | undefined;
    #paused = false;
    /** The number of the cloth shown; frames of earlier ones are dropped. */
    #cloth = 0;
    #framesAsked = 0;
    #arrived: (FromWorker & { kind: 'frame' })[] = [];
    #rayAsked = false;

    readonly #stage = new Stage(byId<HTMLCanvasElement>('canvas'));
    readonly #modelView = new ModelView();
    readonly #clothView = new ClothView();
    readonly #mapView = new MapView();
    readonly #figures = new FigureStrip();
    readonly #pairs = new Pairs((cuts) => this.#showCuts(cuts));
    readonly #controls: Controls;
    readonly #client: Client;

    constructor(client: Client) {
        this.#client = client;
        this.#stage.scene.add(this.#modelView.group, this.#clothView.mesh, this.#mapView.group);
        this.#controls = new Controls(this.#settings, (settings, key) => this.#change(settings, key));
        this.#bindButtons();
        this.#bindKeys();
        enableFiles((file) => this.#open(file));
        this.#bindPointer();
        enableClosing();
        fillDepthLegend();
        setTimeout(() => byId('hint').classList.add('seen'), HINT_MS);
        // The visitor follows a link while the page is open.
        addEventListener('hashchange', () => {
            const settings = fromLink(location.hash);
            if (toLink(settings) === toLink(this.#settings) && !this.#asked.file) return;
            this.#settings = settings;
            this.#inView = '';
            this.#controls.show(settings);
            this.#showView();
            this.#showColours();
            this.#open(undefined); // a link cannot contain a file
        });
        this.#stage.onArrival = () => this.#keepCamera();
        this.#stage.onLoss = () => say('The browser has lost the graphics context. If the picture does not come back, reload the page.');
        client.listen((message) => this.#hear(message));
        this.#showView();
        this.#showColours();
        this.#open(undefined);
        this.#stage.renderer.setAnimationLoop(() => this.#draw());
    }

    // ---- The worker

    #open(file: File | undefined): void {
        beQuiet();
        byId('subtitle').textContent = file ? `Opening ${file.name}` : 'Loading';
        this.#controls.showFile(file?.name);
        this.#controls.show(this.#settings);
        this.#asked = { turn: ++this.#turn, file };
        this.#openings.push(this.#asked);
        this.#client.tell({ kind: 'open', turn: this.#turn, settings: this.#settings, page: document.baseURI, ...(file && { file }) });
    }

    #hear(message: FromWorker): void {
        switch (message.kind) {
            case 'model':
                return this.#showModel(message);
            case 'cloth':
                ++this.#cloth;
                this.#arrived = [];
                if (this.#paused) this.#pause(false); // a new cloth falls
                this.#clothView.begin(message.faces);
                this.#figures.forgetCuts();
                this.#clothView.byDepth = this.#settings.colour === 'depth';
                return;
            case 'frame':
                this.#framesAsked = Math.max(0, this.#framesAsked - 1);
                if (message.cloth === this.#cloth) this.#arrived.push(message);
                return;
            case 'surface':
                this.#surface = message;
                this.#mapView.showSurface(message);
                return this.#showSurface();
            case 'map':
                return this.#useMap(message.map);
            case 'rebuilt':
                return this.#showMap(message.map);
            case 'cut':
                return this.#mapView.showCut(message);
            case 'ray':
                this.#rayAsked = false;
                this.#mapView.showRay(message);
                return showRay(message, this.#model!.radius);
            case 'missed':
                this.#rayAsked = false;
                return;
            case 'failed':
                return this.#fail(message);
            case 'settled':
                return this.#settle(message);
        }
    }

    #fail({ sentence, code, turn }: FromWorker & { kind: 'failed' }): void {
        if (turn === undefined) {
            this.#rayAsked = false;
            this.#framesAsked = 0; // the frame may have been waiting for one of these
        } else if (turn < this.#asked.turn) return; // another model has been opened since
        if (code === 'Diverged') this.#pause(true);
        if (code === 'Crashed') this.#beginAgain();
        say(sentence);
    }

    /** After a crash the page returns to a sample, unless no model was open: then the sample may be the cause. */
    #beginAgain(): void {
        const wasWell = this.#model !== undefined;
        this.#model = undefined;
        this.#openings = [];
        this.#asked = { turn: 0, file: undefined };
        this.#cloth = 0;
        this.#arrived = [];
        this.#controls.showFile(undefined);
        this.#controls.show(this.#settings);
        byId('subtitle').textContent = '';
        if (wasWell) this.#open(undefined);
    }

    /** The panel must show exactly the settings in force, after a refusal too. */
    #settle({ turn, inForce }: FromWorker & { kind: 'settled' }): void {
        this.#openings = this.#openings.filter((opening) => opening.turn === inForce?.turn || opening.turn > turn);
        if (turn !== this.#turn) return; // there are newer requests
        const shown = this.#openings[0];
        const { view, shown: inColours, slice, camera } = this.#settings; // the page's own
        const settings = inForce ? { ...inForce.settings, view, shown: inColours, slice, camera } : this.#settings;
        if (shown === this.#asked && toLink(settings) === toLink(this.#settings)) return;
        this.#asked = shown ?? { turn: 0, file: undefined };
        this.#setLink(settings);
        this.#controls.showFile(this.#asked.file?.name);
        this.#controls.show(settings);
        this.#showColours();
        if (this.#model) this.#showNote(settings.map);
        if (this.#model) this.#showTitle(this.#model);
        else byId('subtitle').textContent = '';
    }

    #showModel(model: ModelNews): void {
        this.#model = model;
        this.#pairs.model = model;
        this.#modelView.show(model);
        this.#mapView.begin(model);
        this.#pointCamera(model);
        this.#showTitle(model);
        showReport(model);
        this.#useMap(model.map);
        byId('horse-notice').hidden = !SAMPLES.includes('horse');
    }

    /** The same model again, for instance mended: the camera stays. */
    #pointCamera({ name, centre, radius, up }: ModelNews): void {
        const inView = JSON.stringify([name, centre, radius, up]);
        if (inView === this.#inView) return;
        this.#inView = inView;
        this.#stage.lookAt(centre, radius, up);
        if (this.#asked.file) this.#setLink({ ...this.#settings, camera: '' }); // that camera was for another model
        else if (this.#settings.camera) this.#stage.standpoint = this.#settings.camera;
    }
    #inView = '';

    #useMap(map: MapNews): void {
        this.#showMap(map);
        this.#showNote(map.kind);
        document.body.classList.toggle('map-exact', map.kind === 'exact');
        document.body.classList.toggle('map-distance', map.kind === 'distance');
        if (this.#settings.view === 'map') this.#askForMap();
    }

    #showNote(map: MapNews['kind']): void {
        byId('map-note').textContent = mapNote(map, this.#model!.report.closed, this.#settings.surfaces);
    }

    #showMap(map: MapNews): void {
        showMapFigures(map);
        this.#figures.showMap(map);
    }

    #showTitle(model: ModelNews): void {
        byId('subtitle').textContent = `${model.name}, ${count(model.report.faceCount)} faces`;
    }

    #askForMap(): void {
        this.#client.tell({ kind: 'surface' });
        this.#client.tell({ kind: 'slice', height: this.#settings.slice });
        // Shows a ray before the pointer enters.
        this.#client.tell({ kind: 'ray', direction: towardsTop(this.#model!) });
    }

    // ---- Frames

    #draw(): void {
        const next = this.#arrived.shift();
        let spare;
        if (next) {
            spare = this.#clothView.show(next.arrays);
            this.#modelView.follow(next.collider);
            this.#figures.add(next.figures);
            this.#pairs.consider(this.#cloth, next.figures.frame, next.arrays.positions, this.#clothView.faces, next.collider);
            // The tests wait for this.
            document.body.dataset.paused = String(next.figures.paused);
            document.body.dataset.rest = String(next.figures.atRest);
            document.body.dataset.frame = String(next.figures.frame);
        }
        if (this.#settings.view === 'cloth' && this.#model)
            while (this.#framesAsked < FRAMES_UNDER_WAY && this.#arrived.length === 0) {
                ++this.#framesAsked;
                this.#client.tell({ kind: 'frame', ...(spare && { arrays: spare }) }, spare ? [spare.positions.buffer, spare.normals.buffer, spare.depths.buffer] : []);
                spare = undefined;
            }
        this.#stage.draw();
        this.#figures.countDrawing();
    }

    #showCuts(cuts: Cuts): void {
        if (cuts.number !== this.#cloth) return;
        this.#clothView.markCut(cuts.cutFaces);
        this.#figures.showCuts(cuts);
    }

    // ---- The visitor's actions

    #change(settings: Settings, key: keyof Settings): void {
        if (key === 'model' || key === 'up') settings = { ...settings, camera: '' };
        settings = consistent(settings, key);
        this.#controls.show(settings);
        this.#setLink(settings);
        switch (key) {
            case 'view':
                return this.#showView();
            case 'slice':
                return this.#client.tell({ kind: 'slice', height: settings.slice });
            case 'shown':
                return this.#showSurface();
            case 'model':
                return this.#open(undefined);
            case 'mend':
            case 'up':
                return this.#open(this.#asked.file);
        }
        this.#showColours();
        if (this.#model && (key === 'surfaces' || key === 'self')) this.#showNote(settings.map);
        this.#client.tell({ kind: 'change', turn: ++this.#turn, settings });
    }

    #keepCamera(): void {
        const camera = this.#stage.standpoint;
        if (camera !== this.#settings.camera) this.#setLink({ ...this.#settings, camera });
    }

    #setLink(settings: Settings): void {
        this.#settings = settings;
        history.replaceState(null, '', `#${toLink(settings)}`);
    }

    #showColours(): void {
        const byDepth = this.#settings.colour === 'depth';
        this.#clothView.byDepth = byDepth;
        byId('depth-legend').hidden = !byDepth;
    }

    #showSurface(): void {
        if (!this.#surface) return;
        this.#mapView.shown = this.#settings.shown;
        showLegend(this.#surface, this.#settings.shown);
    }
    #surface: SurfaceNews | undefined;

    #showView(): void {
        const map = this.#settings.view === 'map';
        document.body.classList.toggle('view-map', map);
        document.body.classList.toggle('view-cloth', !map);
        this.#modelView.group.visible = !map;
        this.#clothView.mesh.visible = !map;
        this.#mapView.group.visible = map;
        if (map && this.#model) this.#askForMap();
    }

    #pause(paused: boolean): void {
        this.#paused = paused;
        byId('pause').textContent = paused ? 'Go on' : 'Pause';
        this.#client.tell({ kind: 'pause', paused });
    }
    #step(): void {
        this.#pause(true);
        ++this.#framesAsked; // the answer is a frame
        this.#client.tell({ kind: 'step' });
    }
    #restart(): void {
        beQuiet();
        this.#client.tell({ kind: 'restart' });
        this.#pause(false);
    }
    #switchView(): void {
        this.#choose('view', this.#settings.view === 'map' ? 'cloth' : 'map');
    }
    #switchMap(): void {
        this.#choose('map', this.#settings.map === 'exact' ? 'distance' : 'exact');
    }
    #choose<K extends keyof Settings>(key: K, value: Settings[K]): void {
        const settings = { ...this.#settings, [key]: value };
        this.#controls.show(settings);
        this.#change(settings, key);
    }

    #bindButtons(): void {
        const actions: Record<string, () => void> = {
            pause: () => this.#pause(!this.#paused),
            step: () => this.#step(),
            restart: () => this.#restart(),
            rebuild: () => this.#client.tell({ kind: 'rebuild' }),
            'save-picture': () => void this.#savePicture(),
            'save-mesh': () => this.#saveMesh(),
            'copy-link': () => void this.#copyLink(),
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
            m: () => this.#switchView(),
            x: () => this.#switchMap(),
            p: () => void this.#savePicture(),
            arrowleft: () => this.#stage.turn(-TURN, 0),
            arrowright: () => this.#stage.turn(TURN, 0),
            arrowup: () => this.#stage.turn(0, TURN),
            arrowdown: () => this.#stage.turn(0, -TURN),
            '+': () => this.#stage.turn(0, 0, ZOOM),
            '-': () => this.#stage.turn(0, 0, 1 / ZOOM),
        });
    }

    #bindPointer(): void {
        enablePointer(byId<HTMLCanvasElement>('canvas'), this.#stage, this.#clothView, {
            grab: (particle, target) => {
                byId('hint').classList.add('seen');
                this.#client.tell({ kind: 'grab', particle, target });
            },
            drag: (target) => this.#client.tell({ kind: 'drag', target }),
            release: () => this.#client.tell({ kind: 'release' }),
            hover: (ray) => this.#lookUnder(ray),
            obstacle: this.#modelView.clay,
            mayGrab: () => this.#settings.view === 'cloth',
        });
    }

    /** The ray of the map through the point under the pointer. One query at a time, so that slow ones do not queue up. */
    #lookUnder(ray: Raycaster): void {
        if (this.#settings.view !== 'map' || this.#rayAsked || !this.#model) return;
        const way = this.#mapView.wayOf(ray);
        if (!way) return;
        const { centre } = this.#model;
        this.#rayAsked = true;
        if (this.#mapView.showsCells) this.#client.tell({ kind: 'ray', direction: [0, 1, 2].map((k) => way.from[k] - centre[k]) as Triple });
        else this.#client.tell({ kind: 'point', ...way });
    }

    // ---- Saving

    async #savePicture(): Promise<void> {
        saveAs('echinus.png', await this.#stage.picture());
    }

    #saveMesh(): void {
        const { positions, faces } = this.#clothView;
        if (!positions || !this.#model) return say('there is no cloth to save yet');
        const model = { name: 'model', vertices: this.#modelView.verticesNow(this.#model.vertices), faces: this.#model.faces };
        const notices = ['Cloth and model, by Echinus'];
        if (this.#model.name === 'horse.3ds')
            notices.push('The object "model" is horse.3ds of glmark2-data, licence GPL-3 or later; it is not part of Echinus.');
        const text = objText([{ name: 'cloth', vertices: positions, faces }, model], notices);
        saveAs('echinus.obj', new Blob([text], { type: 'model/obj' }));
    }

    async #copyLink(): Promise<void> {
        if (this.#model) this.#keepCamera(); // the camera may still be moving
        const link = `${location.origin}${location.pathname}#${toLink(this.#settings)}`;
        const note = byId('link-note');
        note.hidden = false;
        try {
            await navigator.clipboard.writeText(link);
            note.textContent = 'Copied.';
        } catch {
            note.textContent = link; // for copying by hand where the clipboard is not available
        }
        if (this.#asked.file) note.textContent += ' The opened file is not part of it.';
    }
}

function mapNote(kind: MapNews['kind'], closed: boolean, surfaces: boolean): string {
    if (kind === 'distance') return 'Out along the ray from the centre, as in the paper: watch the cloth creep along a leg.';
    if (surfaces) return 'Out by the shortest way. No face of the cloth gets through the surface, closed or open.';
    if (closed) return 'Out by the shortest way. No particle gets through; sharp parts may show between particles.';
    return 'Out by the shortest way. The mesh is open: near its gaps sides are estimated, and particles may get in there.';
}

/** From the centre to the highest vertex: an instructive ray for most models. */
function towardsTop({ vertices, centre, up }: ModelNews): Triple {
    return furthestAlong(up, vertices).map((part, k) => part - centre[k]) as Triple;
}

export function begin(client: Client): void {
    new App(client);
}
