/** Starts the player, or shows why it cannot. */
import '../style.css';
import { enableClosing, say } from '../panel/notice';
import { Player } from './player';
import { Recording } from './recording';

/** With one collider, and with several. */
const FORMATS = [1, 2];

/** The text of an element written by `echinus simulate --html`. Removes the element, since it is large. */
function takeText(id: string): string | undefined {
    const element = document.getElementById(id);
    element?.remove();
    return element?.textContent ?? undefined;
}

async function begin(): Promise<void> {
    const description = takeText('description'), data = takeText('data');
    if (description === undefined || data === undefined)
        return say('This page holds no recording. The command "echinus simulate SCENE --html PAGE" writes one that does.');
    if (typeof DecompressionStream === 'undefined' || !document.createElement('canvas').getContext('webgl2'))
        return say('This page needs WebGL 2 and DecompressionStream. Chrome and Edge from 94, Firefox from 113 and Safari from 16.4 have both.');
    const parsed = JSON.parse(description);
    if (!FORMATS.includes(parsed.format)) return say(`This player reads recordings of format ${FORMATS.join(' and ')}; this one has format ${parsed.format}.`);
    const recording = await Recording.open(parsed, data);
    new Player(recording);
    await recording.readFrames();
    document.body.dataset.read = 'true'; // the tests wait for this
}

enableClosing();
begin().catch((error) => say(`The recording in this page cannot be read: ${error instanceof Error ? error.message : error}.`));
