// Debian's Firefox, on a screen that nobody sees, by Marionette: JSON with its length before it, over TCP (Mozilla's protocol 3).
import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { connect } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as pause } from 'node:timers/promises';

const FIREFOX = process.env.FIREFOX ?? '/usr/bin/firefox-esr', SCREEN = '/usr/bin/Xvfb';
// Without a screen it has no WebGL (Firefox 153).
export const hasFirefox = existsSync(FIREFOX) && existsSync(SCREEN);

// Without a graphics card: by software. And nothing of what a first start shows or fetches.
const PREFERENCES = {
    'marionette.port': 0,
    'webgl.disabled': false, 'webgl.force-enabled': true, 'gfx.webrender.software': true,
    'app.normandy.enabled': false, 'app.update.disabledForTesting': true, 'browser.aboutwelcome.enabled': false, 'browser.shell.checkDefaultBrowser': false,
    'browser.startup.page': 0, 'datareporting.policy.dataSubmissionEnabled': false, 'network.captive-portal-service.enabled': false,
    'network.connectivity-service.enabled': false, 'services.settings.server': 'data:,', 'toolkit.telemetry.reportingpolicy.firstRun': false,
};

const STARTS_MS = 90_000;

class Marionette {
    #socket;
    #waiting = new Map();
    #received = Buffer.alloc(0);
    #last = 0;

    constructor(port) {
        this.#socket = connect(port, '127.0.0.1');
        this.#socket.on('data', (bytes) => this.#take(bytes));
        const fail = (error) => this.#waiting.forEach(({ reject }) => reject(error ?? new Error('Firefox has gone')));
        this.#socket.on('error', fail);
        this.#socket.on('close', () => fail());
    }

    #take(bytes) {
        this.#received = Buffer.concat([this.#received, bytes]);
        for (;;) {
            const colon = this.#received.indexOf(0x3a);
            const end = colon + 1 + Number(this.#received.toString('latin1', 0, Math.max(0, colon)));
            if (colon < 0 || this.#received.length < end) return;
            const message = JSON.parse(this.#received.toString('utf8', colon + 1, end));
            this.#received = this.#received.subarray(end);
            if (!Array.isArray(message)) continue; // its greeting
            const [, id, error, result] = message;
            const { resolve, reject } = this.#waiting.get(id);
            this.#waiting.delete(id);
            error ? reject(new Error(`${error.error}: ${error.message}`)) : resolve(result);
        }
    }

    send(command, parameters = {}) {
        const id = ++this.#last;
        const text = JSON.stringify([0, id, `WebDriver:${command}`, parameters]);
        return new Promise((resolve, reject) => {
            this.#waiting.set(id, { resolve, reject });
            this.#socket.write(`${Buffer.byteLength(text)}:${text}`);
        });
    }

    close() {
        this.#waiting.clear();
        this.#socket.destroy();
    }
}

/** A screen in memory. It says its number through its third pipe when it is there. */
async function startScreen({ width, height }) {
    const screen = spawn(SCREEN, ['-displayfd', '3', '-screen', '0', `${width}x${height}x24`, '-nolisten', 'tcp'], { stdio: ['ignore', 'ignore', 'ignore', 'pipe'] });
    const number = await new Promise((resolve, reject) => {
        screen.stdio[3].once('data', (text) => resolve(String(text).trim()));
        screen.once('exit', () => reject(new Error('Xvfb does not start')));
    });
    return { display: `:${number}`, stop: () => screen.kill() };
}

/** The port is in a file of the profile once Firefox listens. */
async function portOf(profile, firefox) {
    const until = performance.now() + STARTS_MS;
    while (performance.now() < until && firefox.exitCode === null) {
        const text = await readFile(join(profile, 'MarionetteActivePort'), 'utf8').catch(() => '');
        if (text) return Number(text);
        await pause(100);
    }
    throw new Error('Firefox does not start');
}

/** A Firefox with a new profile and one page. */
export async function startFirefox({ width, height }) {
    const screen = await startScreen({ width, height });
    const profile = await mkdtemp(join(tmpdir(), 'echinus-firefox-'));
    await writeFile(join(profile, 'user.js'), Object.entries(PREFERENCES).map(([name, value]) => `user_pref(${JSON.stringify(name)}, ${JSON.stringify(value)});\n`).join(''));
    const firefox = spawn(FIREFOX, ['--marionette', '--no-remote', '--profile', profile, `--width=${width}`, `--height=${height}`], {
        stdio: 'ignore', env: { ...process.env, HOME: profile, DISPLAY: screen.display, LIBGL_ALWAYS_SOFTWARE: '1' },
    });
    const stop = async () => {
        const ended = new Promise((resolve) => (firefox.exitCode === null ? firefox.once('exit', resolve) : resolve()));
        firefox.kill();
        await Promise.race([ended, pause(5000, undefined, { ref: false }).then(() => firefox.kill('SIGKILL'))]);
        screen.stop();
        await rm(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
    };
    try {
        const marionette = new Marionette(await portOf(profile, firefox));
        await marionette.send('NewSession', { capabilities: {} });
        await marionette.send('SetTimeouts', { script: 60_000, pageLoad: 60_000 });
        return page(marionette, async () => {
            marionette.close();
            await stop();
        });
    } catch (error) {
        await stop();
        throw error;
    }
}

function page(marionette, stop) {
    const run = async (script, ...args) => (await marionette.send('ExecuteScript', { script: `return (${script})(...arguments)`, args, sandbox: null })).value;
    return {
        stop,
        /** Runs a function in the page. */
        run,
        open: (url) => marionette.send('Navigate', { url }),
        /** Until a function says so in the page. */
        async until(script, ...args) {
            const end = performance.now() + 60_000;
            while (!(await run(script, ...args))) {
                if (performance.now() > end) throw new Error(`not within a minute: ${script}`);
                await pause(50);
            }
        },
        /** The mouse goes along places in the window with its button down. */
        drag: ([first, ...rest]) =>
            marionette.send('PerformActions', {
                actions: [{
                    type: 'pointer', id: 'mouse', parameters: { pointerType: 'mouse' },
                    actions: [move(first, 0), { type: 'pointerDown', button: 0 }, ...rest.map((place) => move(place, 60)), { type: 'pointerUp', button: 0 }],
                }],
            }),
        async picture() {
            return Buffer.from((await marionette.send('TakeScreenshot', { full: false })).value, 'base64');
        },
    };
}

const move = ([x, y], duration) => ({ type: 'pointerMove', x: Math.round(x), y: Math.round(y), duration });
