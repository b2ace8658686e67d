/** The module's errors: `code` is for programs, `message`, one sentence, for people. */
export class EchinusError extends Error {
    constructor(code, sentence, options) {
        super(sentence, options);
        this.name = 'EchinusError';
        this.code = code;
    }
}

/** Refuses an argument before it reaches the module. */
export function refuse(sentence) {
    throw new EchinusError('InvalidArgument', sentence);
}

/** Options with all their defaults; undefined is none. @param what  an unknown key is not */
export function withDefaults(given, defaults, what) {
    if (given === null || typeof given !== 'object') refuse(`${what} is needed in an object`);
    const known = Object.keys(defaults);
    for (const key of Object.keys(given)) if (!known.includes(key)) refuse(`'${key}' is not ${what}; there are ${known.join(', ')}`);
    return { ...defaults, ...Object.fromEntries(Object.entries(given).filter(([, value]) => value !== undefined)) };
}

/** A whole number that fits into 32 bits. */
export function requireCount(value, what) {
    if (!Number.isInteger(value) || value < 0 || value > 0xffffffff)
        refuse(`${what} is ${String(value)}; it must be a whole number from 0 to 2^32 - 1`);
    return value;
}

/** Three numbers; the call decides whether they must be finite. */
export function requirePoint(value, what) {
    if (value == null || value.length !== 3 || !Array.prototype.every.call(value, (c) => typeof c === 'number'))
        refuse(`${what} must be three numbers`);
    return value;
}

/** Three finite numbers. */
export function requireFinite(value, what) {
    if (!Array.prototype.every.call(requirePoint(value, what), Number.isFinite)) refuse(`${what} must be three finite numbers`);
    return value;
}
