import { byId } from './panel/elements';

/** Opens files: by the panel's button, or dropped anywhere on the page. */
export function enableFiles(given: (file: File) => void): void {
    const input = byId<HTMLInputElement>('file');
    input.addEventListener('change', () => {
        const [file] = input.files ?? [];
        if (file) given(file);
        input.value = ''; // so that the same file can be chosen again
    });
    const sign = byId('drop');
    addEventListener('dragover', (event) => {
        if (!event.dataTransfer?.types.includes('Files')) return;
        event.preventDefault();
        sign.hidden = false;
    });
    addEventListener('dragleave', (event) => {
        if (event.relatedTarget === null) sign.hidden = true; // left the window
    });
    addEventListener('drop', (event) => {
        event.preventDefault();
        sign.hidden = true;
        const [file] = event.dataTransfer?.files ?? [];
        if (file) given(file);
    });
}
