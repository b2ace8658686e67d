/** A picture that takes longer than this is drawn more lightly. */
const LONG_MS = 26;
/** Of so many pictures. */
const COUNT = 40;
/** Compiling takes long, and is not repeated. */
const FIRST = 20;

/** Judges whether pictures come quickly enough, by the times between them. */
export class Pace {
    #last = 0;
    #times: number[] = [];
    #seen = 0;

    /** Call for each picture. @returns whether the typical one has taken too long, once, after enough of them */
    isSlow(now: number): boolean {
        const took = now - this.#last;
        this.#last = now;
        // A hidden page draws nothing, and is not slow.
        if (++this.#seen < FIRST || took > 500) return false;
        this.#times.push(took);
        if (this.#times.length < COUNT) return false;
        const median = this.#times.sort((a, b) => a - b)[COUNT >> 1];
        this.#times = [];
        return median > LONG_MS;
    }
}

/** Does the processor draw, in place of a graphics card? */
export function drawsInSoftware(context: WebGL2RenderingContext | WebGLRenderingContext): boolean {
    const info = context.getExtension('WEBGL_debug_renderer_info');
    const name = String(context.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : context.RENDERER));
    return /swiftshader|llvmpipe|software|basic render/i.test(name);
}
