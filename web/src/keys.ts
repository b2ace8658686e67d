/** Calls the action of a key, by `event.key` in lower case, unless the control that has the focus needs that key itself. */
export function enableKeys(actions: Record<string, () => void>): void {
    addEventListener('keydown', (event) => {
        const action = actions[event.key.toLowerCase()];
        if (!action || (event.repeat && !REPEATED.has(event.key.toLowerCase())) || event.ctrlKey || event.metaKey || event.altKey || isOfControl(event)) return;
        event.preventDefault();
        action();
    });
    releaseLists();
}

/** A list from which the pointer has chosen gives the keys back; one that keys operate goes on having them. */
function releaseLists(): void {
    let byPointer = false;
    addEventListener('pointerdown', () => (byPointer = true), { capture: true });
    addEventListener('keydown', () => (byPointer = false), { capture: true });
    addEventListener('change', ({ target }) => byPointer && target instanceof HTMLSelectElement && target.blur());
}

/** These repeat while held down: they step or turn by a little. */
const REPEATED = new Set(['s', 'arrowleft', 'arrowright', 'arrowup', 'arrowdown', '+', '-']);

/** Lists search their entries by letters; buttons and check boxes take space; sliders and choices take arrow keys. */
function isOfControl({ key, target }: KeyboardEvent): boolean {
    if (!(target instanceof HTMLElement)) return false;
    if (target.matches('select')) return true;
    if (key === ' ') return target.matches('button, summary, input:not([type=range])');
    return key.startsWith('Arrow') && target.matches('input');
}
