/** The page's address, which holds the settings, and the browser's history, whose entries remember which file was open. */
import { type Settings, fromLink, toLink } from './settings';

interface Entry {
    file?: { key: string; name: string };
    /** The tour's, which is left when the tour ends. */
    tour?: true;
}

/** How long a browser that was asked too often gets before it is asked again. Safari refuses more than 100 changes in 30 s. */
const PATIENCE_MS = 1000;

export class Address {
    /** The files that were opened since the page was loaded, by the keys in the history. */
    readonly #files = new Map<string, File>();
    #again = 0;
    #left: (() => void) | undefined;

    /** @param followed  called when the visitor follows a link in the page, or goes back or forth, with what is there */
    constructor(followed: (settings: Settings, file: File | undefined) => void) {
        addEventListener('popstate', () => {
            clearTimeout(this.#again);
            const left = this.#left;
            this.#left = undefined;
            if (left) left();
            else followed(fromLink(location.hash), this.#file);
        });
    }

    get #entry(): Entry {
        return (history.state as Entry | null) ?? {};
    }
    get #file(): File | undefined {
        return this.#files.get(this.#entry.file?.key ?? '');
    }

    /** The name of a file that was open here before the page was loaded again, and is not any more. */
    get lost(): string | undefined {
        return this.#file ? undefined : this.#entry.file?.name;
    }

    /** Replaces the address by that of the present settings. A file has its own entry: opening one adds an entry, and so does opening a sample after it. */
    show(settings: Settings, file: File | undefined): void {
        clearTimeout(this.#again);
        const entry: Entry = file ? { file: { key: this.#keyOf(file), name: file.name } } : {};
        try {
            if (this.#file !== file && !this.#entry.tour) history.pushState(entry, '', `#${toLink(settings)}`);
            else history.replaceState(entry, '', `#${toLink(settings)}`);
        } catch {
            this.#again = window.setTimeout(() => this.show(settings, file), PATIENCE_MS);
        }
    }

    /** The tour begins, which going back ends. */
    enter(): void {
        history.pushState({ ...this.#entry, tour: true }, '');
    }
    /** The tour has ended in another way: its entry is left, and then the page may write the entry before it. */
    leave(then: () => void): void {
        if (!this.#entry.tour) return;
        this.#left = then;
        history.back();
    }

    #keyOf(file: File): string {
        for (const [key, known] of this.#files) if (known === file) return key;
        const key = `${performance.timeOrigin}/${this.#files.size}`; // unlike those of this page loaded at another time
        this.#files.set(key, file);
        return key;
    }
}
