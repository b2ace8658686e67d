import type { Raycaster } from 'three';
import { UNIT, furthestAlong } from './frames';
import { forgetRay, showLegend, showRay } from './panel/map_figures';
import type { CellNews, FromWorker, MapNews, ModelNews, SurfaceNews, ToWorker, Triple } from './protocol';
import type { Settings } from './settings';
import { MapView } from './view/map_view';

interface InspectorWishes {
    settings(): Settings;
    /** The tour chooses the ray and the cut. */
    isGuided(): boolean;
    tell(message: ToWorker): void;
}

/** The view of the map: asks the worker for what it shows, and shows the answers. */
export class MapInspector {
    readonly view = new MapView();
    readonly #wishes: InspectorWishes;
    #model: ModelNews | undefined;
    #kind: MapNews['kind'] = 'exact';
    #surface: SurfaceNews | undefined;
    #cells: CellNews | undefined;
    #rayAsked = false;
    /** None is shown during parts of the tour. */
    #rayWanted = true;

    constructor(wishes: InspectorWishes) {
        this.#wishes = wishes;
    }

    get #isSeen(): boolean {
        return this.#wishes.settings().view === 'map' && this.#model !== undefined;
    }

    set model(model: ModelNews) {
        this.#model = model;
        this.view.begin(model);
    }
    set map({ kind }: MapNews) {
        this.#kind = kind;
        this.#cells = undefined;
        this.view.forget();
        forgetRay();
        this.ask();
    }

    /** For all that the view shows, once it is seen. */
    ask(): void {
        if (!this.#isSeen) return;
        this.#wishes.tell({ kind: 'surface' });
        this.askForCells();
        if (this.#wishes.isGuided()) return;
        this.#wishes.tell({ kind: 'slice', height: this.#wishes.settings().slice });
        // Shows a ray before the pointer enters: towards the highest vertex, an instructive one for most models.
        const { vertices, centre, up } = this.#model!;
        this.showRay(furthestAlong(UNIT[up], vertices).map((part, k) => part - centre[k]) as Triple);
    }

    /** Only where they are shown: there may be half a million. */
    askForCells(): void {
        if (this.#isSeen && this.#wishes.settings().shown === 'cells' && this.#kind === 'exact' && !this.#cells) this.#wishes.tell({ kind: 'cells' });
    }

    /** @param direction  from the map's centre; undefined: no ray is to be seen */
    showRay(direction: Triple | undefined): void {
        this.#rayWanted = direction !== undefined;
        if (direction) return this.#wishes.tell({ kind: 'ray', direction });
        this.view.hideRay();
        forgetRay();
    }

    /** The ray of the map through the point under the pointer. One query at a time, so that slow ones do not queue up. */
    lookUnder(ray: Raycaster): void {
        if (!this.#isSeen || this.#rayAsked || this.#wishes.isGuided()) return;
        const way = this.view.wayOf(ray);
        if (!way) return;
        const { centre } = this.#model!;
        this.#rayAsked = this.#rayWanted = true;
        if (this.view.showsCells) this.#wishes.tell({ kind: 'ray', direction: [0, 1, 2].map((k) => way.from[k] - centre[k]) as Triple });
        else this.#wishes.tell({ kind: 'point', ...way });
    }

    /** The answer to a question may never come. */
    forgive(): void {
        this.#rayAsked = false;
    }

    /** @returns whether the message was an answer to this view */
    hear(message: FromWorker): boolean {
        switch (message.kind) {
            case 'surface':
                this.#surface = message;
                this.view.showSurface(message);
                this.showColours();
                return true;
            case 'cells':
                this.#cells = message;
                this.view.showCells(message);
                this.showColours();
                return true;
            case 'cut':
                this.view.showCut(message);
                return true;
            case 'ray':
                this.#rayAsked = false;
                if (!this.#isSeen || !this.#rayWanted) return true; // it has become unwanted meanwhile
                this.view.showRay(message);
                showRay(message, this.#model!.radius);
                return true;
            case 'missed': // there is no surface under the pointer
                this.#rayAsked = false;
                return true;
        }
        return false;
    }

    showColours(): void {
        if (!this.#surface) return;
        const { shown } = this.#wishes.settings();
        this.view.shown = shown;
        showLegend(this.#surface, this.#cells, shown);
    }
}
