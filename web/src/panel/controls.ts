import { CELLS, DEFAULTS, RANGES, SAMPLES, SAMPLE_NAMES, type Settings } from '../settings';
import { byId, count } from './elements';

type Control = HTMLInputElement | HTMLSelectElement;

/** The panel's inputs, each named for the setting that it changes. */
export class Controls {
    readonly #inputs: Control[];
    #settings: Settings;
    #file: HTMLOptionElement | undefined;

    /** @param changed  called with the settings after a visitor's change, and the changed key */
    constructor(settings: Settings, changed: (settings: Settings, key: keyof Settings) => void) {
        const model = byId('panel').querySelector<HTMLSelectElement>('select[name=model]')!;
        model.append(...SAMPLES.map((name) => new Option(SAMPLE_NAMES[name], name)));
        byId('panel').querySelector<HTMLSelectElement>('select[name=cells]')!.append(...CELLS.map((cells) => new Option(cells === 'auto' ? 'by the mesh' : count(Number(cells)), cells)));
        this.#inputs = [...document.querySelectorAll<Control>('#panel [name], #bar [name]')];
        this.#settings = settings;
        for (const input of this.#inputs)
            input.addEventListener('input', () => this.#follow(input));
        for (const input of this.#inputs)
            input.addEventListener(input.dataset.event ?? 'input', () => changed(this.#settings, input.name as keyof Settings));
        this.show(settings);
    }

    #follow(input: Control): void {
        const key = input.name as keyof Settings;
        if (key === 'model') this.showFile(undefined);
        this.show({ ...this.#settings, [key]: valueOf(input, key) });
    }

    show(settings: Settings): void {
        this.#settings = settings;
        for (const input of this.#inputs) {
            const key = input.name as keyof Settings;
            const value = settings[key];
            if (key === 'model' && this.#file) continue; // the file is chosen
            if (input.type === 'radio') (input as HTMLInputElement).checked = input.value === value;
            else if (input.type === 'checkbox') (input as HTMLInputElement).checked = value as boolean;
            else if (isLogarithmic(input)) input.value = String(toShare(value as number, rangeOf(input)));
            else input.value = String(value);
            const output = input.closest('label')?.querySelector('output');
            if (output) output.textContent = describe(input, value as number);
        }
    }

    /** A file in place of a sample: an entry that exists while the file is open. Without a name, the sample. */
    showFile(name: string | undefined): void {
        this.#file?.remove();
        this.#file = undefined;
        if (name === undefined) return;
        this.#file = new Option(name, 'file', false, true);
        this.#file.hidden = true;
        this.#inputs.find((input) => input.name === 'model')!.prepend(this.#file);
        this.#file.selected = true;
    }
}

function valueOf(input: Control, key: keyof Settings): Settings[keyof Settings] {
    if (input.type === 'checkbox') return (input as HTMLInputElement).checked;
    if (isLogarithmic(input)) return fromShare(Number(input.value), rangeOf(input));
    return typeof DEFAULTS[key] === 'number' ? Number(input.value) : (input.value as Settings[keyof Settings]);
}

function describe(input: Control, value: number): string {
    if (isLogarithmic(input)) return count(Math.round(Math.sqrt(value)) ** 2);
    if (input.name === 'slice' && value >= 1) return 'none';
    return `${value.toFixed(digitsOf(value))}${input.dataset.unit ?? ''}`;
}

/** At most two decimals, without trailing zeros. */
function digitsOf(value: number): number {
    const hundredths = Math.round(100 * value);
    return hundredths % 100 === 0 ? 0 : hundredths % 10 === 0 ? 1 : 2;
}

// Particles and directions use a logarithmic scale: the step from 1 000 to 2 000 matters as much as that from 10 000 to
// 20 000. Both are squares of whole numbers.
type Range = readonly [number, number];
const isLogarithmic = (input: Control): boolean => input.dataset.scale === 'log';
const rangeOf = (input: Control): Range => RANGES[input.name as keyof typeof RANGES];
const toShare = (value: number, [least, most]: Range): number => Math.log(value / least) / Math.log(most / least);
const fromShare = (share: number, [least, most]: Range): number => Math.round(Math.sqrt(least * (most / least) ** share)) ** 2;
