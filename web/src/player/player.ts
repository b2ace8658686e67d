import { saveAs } from '../files';
import { enableKeys } from '../input';
import { byId } from '../panel/elements';
import { Stage } from '../view/stage';
import { showAbout, showFrame } from './about';
import type { Recording } from './recording';
import { World } from './world';

/** The current position in a recording, and the passing of time. */
class Playback {
    speed = 1;
    #time = 0;
    #frame = 0;
    #playing = true;
    readonly #times: readonly number[];

    /** @param times  of the recorded frames, seconds, ascending from 0 */
    constructor(times: readonly number[]) {
        this.#times = times;
    }

    get frame(): number {
        return this.#frame;
    }
    /** How far it is to the next frame, 0 to 1. @param available  frames that can be shown by now */
    share(available: number): number {
        const [now, next] = [this.#times[this.#frame], this.#times[this.#frame + 1]];
        return this.#frame + 1 < available ? Math.min(1, Math.max(0, (this.#time - now) / (next - now))) : 0;
    }
    get playing(): boolean {
        return this.#playing;
    }

    /** Resumes; starts over when it was at the end. */
    play(): void {
        if (this.#frame === this.#times.length - 1) this.seek(0);
        this.#playing = true;
    }
    pause(): void {
        this.#playing = false;
    }
    seek(frame: number): void {
        this.#frame = Math.min(Math.max(0, frame), this.#times.length - 1);
        this.#time = this.#times[this.#frame];
    }

    /** Advances by real time. @param available  frames that can be shown by now; time waits for the others */
    advance(seconds: number, available: number): void {
        if (!this.#playing || available === 0) return;
        this.#time = Math.min(this.#time + this.speed * seconds, this.#times[available - 1]);
        while (this.#frame + 1 < available && this.#times[this.#frame + 1] <= this.#time) ++this.#frame;
        if (this.#frame === this.#times.length - 1) this.#playing = false;
    }
}

/** The player: brings the recording, the picture and the controls together. */

/** The recording advances by at most this much between two pictures, so that a slow one, such as the first, skips nothing. */
const LONGEST_PICTURE_S = 0.25;

export class Player {
    readonly #recording: Recording;
    readonly #playback: Playback;
    readonly #stage = new Stage(byId<HTMLCanvasElement>('canvas'));
    readonly #world: World;
    readonly #scrub = byId<HTMLInputElement>('scrub');
    #shown = -1;
    #share = 0;
    #last = performance.now();

    constructor(recording: Recording) {
        this.#recording = recording;
        const { frames, figures } = recording.description;
        this.#playback = new Playback(frames.map(({ number }) => number * figures.time_step));
        this.#world = new World(this.#stage, recording);
        this.#scrub.max = String(frames.length - 1);
        showAbout(recording.description);
        this.#bindControls();
        this.#bindKeys();
        this.#stage.renderer.setAnimationLoop(() => this.#draw());
    }

    #draw(): void {
        const now = performance.now();
        this.#playback.advance(Math.min((now - this.#last) / 1000, LONGEST_PICTURE_S), this.#recording.frameCount);
        this.#last = now;
        const { frame } = this.#playback, share = this.#playback.share(this.#recording.frameCount);
        if ((frame !== this.#shown || share !== this.#share) && frame < this.#recording.frameCount) this.#show(frame, share);
        this.#showPlaying();
        this.#stage.draw();
    }

    #showPlaying(): void {
        const word = this.#playback.playing ? 'Pause' : 'Play';
        if (byId('pause').textContent !== word) byId('pause').textContent = word;
    }

    #show(frame: number, share: number): void {
        const { frames, figures } = this.#recording.description;
        this.#world.show(frame, share);
        this.#share = share;
        document.body.dataset.share = share.toFixed(2); // the tests read this
        if (frame === this.#shown) return;
        showFrame(frames[frame], figures.time_step);
        this.#scrub.value = String(frame);
        this.#scrub.ariaValueText = `${(frames[frame].number * figures.time_step).toFixed(2)} seconds`;
        this.#shown = frame;
        document.body.dataset.frame = String(frame); // the tests wait for this
    }

    // ---- The visitor's actions

    #toggle(): void {
        if (this.#playback.playing) this.#playback.pause();
        else this.#playback.play();
    }
    #seek(frame: number): void {
        this.#playback.pause();
        // Frames still being read cannot be shown.
        this.#playback.seek(Math.min(frame, this.#recording.frameCount - 1));
    }
    #restart(): void {
        this.#playback.seek(0);
        this.#playback.play();
    }
    async #savePicture(): Promise<void> {
        saveAs('echinus.png', await this.#stage.picture());
    }

    #bindControls(): void {
        const actions: Record<string, () => void> = {
            pause: () => this.#toggle(),
            step: () => this.#seek(this.#playback.frame + 1),
            restart: () => this.#restart(),
            'save-picture': () => void this.#savePicture(),
        };
        for (const [id, action] of Object.entries(actions)) byId(id).addEventListener('click', action);
        this.#scrub.addEventListener('input', () => this.#seek(Number(this.#scrub.value)));
        const speed = byId<HTMLSelectElement>('speed');
        speed.addEventListener('input', () => (this.#playback.speed = Number(speed.value)));
    }

    #bindKeys(): void {
        enableKeys({
            ' ': () => this.#toggle(),
            s: () => this.#seek(this.#playback.frame + 1),
            arrowright: () => this.#seek(this.#playback.frame + 1),
            arrowleft: () => this.#seek(this.#playback.frame - 1),
            r: () => this.#restart(),
            p: () => void this.#savePicture(),
        });
    }
}
