/** The current position in a recording, and the passing of time. */
export class Playback {
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
