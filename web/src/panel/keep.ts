import { Recorder } from '../recorder';
import { type NamedMesh, objText, saveAs } from '../saving';
import { byId } from './elements';
import { remark, say } from './notice';

export interface KeepWishes {
    picture(): Promise<Blob>;
    /** Cloth and model, and what has to be said of them; undefined: there is no cloth yet. */
    meshes(): { meshes: NamedMesh[]; notices: string[] } | undefined;
    link(): string;
    /** Whether a file is open, which no link contains. */
    hasFile(): boolean;
}

/** The part of the panel that keeps what one sees: a picture, a clip, meshes, a link. */
export class Keep {
    readonly #wishes: KeepWishes;
    readonly #recorder = new Recorder();

    constructor(wishes: KeepWishes) {
        this.#wishes = wishes;
        const actions: Record<string, () => void> = {
            'save-picture': () => void this.savePicture(),
            'save-mesh': () => this.#saveMesh(),
            'copy-link': () => void this.#copyLink(),
            record: () => void this.#record(),
        };
        for (const [id, action] of Object.entries(actions)) byId(id).addEventListener('click', action);
    }

    async savePicture(): Promise<void> {
        saveAs('echinus.png', await this.#wishes.picture());
    }

    async #record(): Promise<void> {
        if (this.#recorder.runs) return this.#recorder.stop();
        const button = byId('record');
        try {
            const { clip, ending } = await this.#recorder.record(byId<HTMLCanvasElement>('canvas'), (seconds) => (button.textContent = seconds > 0 ? `Stop (${seconds}\u2009s left)` : 'Record clip'));
            saveAs(`echinus.${ending}`, clip);
        } catch (error) {
            say(error instanceof Error ? error.message : String(error));
        }
    }

    #saveMesh(): void {
        const kept = this.#wishes.meshes();
        if (!kept) return say('there is no cloth to save yet');
        saveAs('echinus.obj', new Blob([objText(kept.meshes, ['Cloth and model, by Echinus', ...kept.notices])], { type: 'model/obj' }));
    }

    async #copyLink(): Promise<void> {
        const link = this.#wishes.link();
        const file = this.#wishes.hasFile() ? ' The opened file is not part of it.' : '';
        const note = byId('link-note');
        try {
            await navigator.clipboard.writeText(link);
            note.hidden = true;
            remark(`The link is copied.${file}`);
        } catch {
            note.hidden = false;
            note.textContent = `${link}${file}`; // for copying by hand where the clipboard is not available
        }
    }
}
