import { type NamedMesh, objText, saveAs } from '../files';
import { byId } from './elements';
import { remark, say } from './notice';

/** How long a clip is. */
const SECONDS = 8;
const FRAMES_PER_SECOND = 30;

/** Formats by preference; browsers write one of them. */
const FORMATS = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm', 'video/mp4'];

/** Records the canvas for some seconds, or until stop(). */
class Recorder {
    #recorder: MediaRecorder | undefined;
    #timer = 0;

    get runs(): boolean {
        return this.#recorder !== undefined;
    }

    /**
     * @param left  is told the seconds that are left, and 0 at the end
     * @returns the clip, and the ending of its file's name
     * @throws Error where the browser cannot record
     */
    record(canvas: HTMLCanvasElement, left: (seconds: number) => void): Promise<{ clip: Blob; ending: string }> {
        const format = FORMATS.find((type) => typeof MediaRecorder !== 'undefined' && MediaRecorder.isTypeSupported(type));
        if (!format) return Promise.reject(new Error('This browser cannot record a clip.'));
        const recorder = new MediaRecorder(canvas.captureStream(FRAMES_PER_SECOND), { mimeType: format, videoBitsPerSecond: 8e6 });
        this.#recorder = recorder;
        let seconds = SECONDS;
        left(seconds);
        this.#timer = window.setInterval(() => (--seconds > 0 ? left(seconds) : this.stop()), 1000);
        return new Promise((resolve, reject) => {
            const parts: Blob[] = [];
            recorder.ondataavailable = ({ data }) => parts.push(data);
            recorder.onerror = () => reject(new Error('The browser has stopped recording.'));
            recorder.onstop = () => {
                left(0);
                resolve({ clip: new Blob(parts, { type: format }), ending: format.includes('mp4') ? 'mp4' : 'webm' });
            };
            recorder.start();
        });
    }

    stop(): void {
        clearInterval(this.#timer);
        this.#recorder?.stop();
        for (const track of this.#recorder?.stream.getTracks() ?? []) track.stop();
        this.#recorder = undefined;
    }
}

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
        if (!kept) return say('There is no cloth to save yet.');
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
