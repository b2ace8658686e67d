/** How long a clip is. */
const SECONDS = 8;
const FRAMES_PER_SECOND = 30;

/** Formats by preference; browsers write one of them. */
const FORMATS = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm', 'video/mp4'];

/** Records the canvas for some seconds, or until stop(). */
export class Recorder {
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
        if (!format) return Promise.reject(new Error('this browser cannot record a clip'));
        const recorder = new MediaRecorder(canvas.captureStream(FRAMES_PER_SECOND), { mimeType: format, videoBitsPerSecond: 8e6 });
        this.#recorder = recorder;
        let seconds = SECONDS;
        left(seconds);
        this.#timer = window.setInterval(() => (--seconds > 0 ? left(seconds) : this.stop()), 1000);
        return new Promise((resolve, reject) => {
            const parts: Blob[] = [];
            recorder.ondataavailable = ({ data }) => parts.push(data);
            recorder.onerror = () => reject(new Error('the browser stopped recording'));
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
