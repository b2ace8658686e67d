/** Numbers as the page writes them. */
const grouped = new Intl.NumberFormat('en', { maximumFractionDigits: 0 });

/** 10 000: thin spaces, which no country reads as a decimal point. */
export const count = (value: number): string => grouped.format(value).replaceAll(',', '\u2009');

/** 1 face, 2 faces. */
export const numbered = (value: number, one: string, many: string): string => `${count(value)} ${value === 1 ? one : many}`;

export function milliseconds(value: number): string {
    return `${value.toFixed(value < 10 ? 2 : value < 100 ? 1 : 0)}\u2009ms`;
}

export function bytes(value: number): string {
    return value < 1e6 ? `${(value / 1e3).toFixed(value < 1e5 ? 1 : 0)}\u2009kB` : `${(value / 1e6).toFixed(1)}\u2009MB`;
}

/** In two digits, since rates of small cloths are rough. */
export function perSecond(value: number): string {
    const [unit, name] = value >= 1e6 ? [1e6, 'M'] : [1e3, 'k'];
    return `${Number((value / unit).toPrecision(2))}\u2009${name}`;
}
