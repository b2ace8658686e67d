import { byId } from './elements';

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
