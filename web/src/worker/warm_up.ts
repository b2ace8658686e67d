import type { Echinus } from 'echinus';

/** Segments of a torus. The first is small: it gets each function compiled once, and costs no more than that saves. */
const FIRST = { major: 12, minor: 8 };
const LATER = { major: 60, minor: 24 };

/** By then the host has optimised the code. */
const MOST_ROUNDS = 8;

/**
 * Builds maps and discards them, as long as there is nothing else to do. A host compiles a function of the module on
 * its first call and optimises it after many calls: without this the first model's map takes three times as long.
 * @param needed  called after each round; messages and files are handled in between
 */
export async function warmUp(echinus: Echinus, needed: () => boolean): Promise<void> {
    for (let round = 0; round < MOST_ROUNDS && !needed(); ++round) {
        buildOnce(echinus, round === 0 ? FIRST : LATER);
        await nextTask();
    }
}

function buildOnce(echinus: Echinus, { major, minor }: typeof FIRST): void {
    const torus = echinus.makeTorus(1, 0.4, major, minor);
    const { mesh } = torus.repair();
    const map = echinus.buildMap(mesh, { kind: 'exact' });
    for (const made of [map, mesh, torus]) made.delete();
}

/** Resumes after the messages that have arrived since. Not a timer: those wait four milliseconds. */
function nextTask(): Promise<void> {
    return new Promise((resolve) => {
        const { port1, port2 } = new MessageChannel();
        port1.onmessage = () => {
            port1.close();
            resolve();
        };
        port2.postMessage(null);
    });
}
