import { byId } from './elements';

/** How long a remark stays. */
const REMARK_MS = 4000;
/** Tasks that take less time show no progress. */
const PATIENCE_MS = 300;

/** One sentence about an error, shown until it is closed or the visitor tries something else. */
export function say(sentence: string): void {
    const notice = byId('notice');
    notice.querySelector('span')!.textContent = sentence;
    notice.hidden = false;
}
export function beQuiet(): void {
    byId('notice').hidden = true;
}
export function enableClosing(): void {
    byId('notice').querySelector('button')!.addEventListener('click', beQuiet);
}

let leaving = 0;
/** A sentence about something that is well, shown for a while. */
export function remark(sentence: string): void {
    clearTimeout(leaving);
    byId('remark').textContent = sentence;
    byId('remark').hidden = false;
    leaving = window.setTimeout(() => (byId('remark').hidden = true), REMARK_MS);
}

let appearing = 0;
/** Shows the present task with a button to cancel it; undefined: it is done. */
export function showProgress(what: string | undefined, cancel: () => void = () => {}): void {
    const progress = byId('progress');
    if (what === undefined) {
        clearTimeout(appearing);
        appearing = 0;
        progress.hidden = true;
        return;
    }
    progress.querySelector('span')!.textContent = what;
    progress.querySelector('button')!.onclick = cancel;
    appearing ||= window.setTimeout(() => (progress.hidden = false), PATIENCE_MS);
}
