import { byId } from './elements';

/** One sentence about what went wrong, until it is closed or something else is tried. */
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
