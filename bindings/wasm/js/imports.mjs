/**
 * The imports of the WebAssembly file: a clock, and a few calls of the WebAssembly System Interface that the C++
 * library refers to, although this module has neither files nor an environment.
 */

const NOT_SUPPORTED = 58; // __WASI_ERRNO_NOTSUP
const BAD_FILE = 8; // __WASI_ERRNO_BADF

/** @param memory  returns the module's memory, which does not exist before the module */
export function makeImports(memory) {
    const writeWords = (address, ...words) => new Uint32Array(memory().buffer, address, words.length).set(words);
    return {
        env: { emscripten_notify_memory_growth() {} }, // views are checked when they are used
        wasi_snapshot_preview1: {
            clock_time_get(clock, precision, result) {
                const milliseconds = clock === 0 ? Date.now() : performance.now();
                new BigUint64Array(memory().buffer, result, 1)[0] = BigInt(Math.round(milliseconds * 1e6));
                return 0;
            },
            environ_sizes_get(count, size) {
                writeWords(count, 0);
                writeWords(size, 0);
                return 0;
            },
            environ_get: () => 0,
            fd_close: () => BAD_FILE,
            fd_read: () => BAD_FILE,
            fd_seek: () => BAD_FILE,
            fd_write: () => BAD_FILE,
            fd_fdstat_get: () => BAD_FILE,
            fd_prestat_get: () => BAD_FILE,
            fd_prestat_dir_name: () => BAD_FILE,
            path_open: () => NOT_SUPPORTED,
            proc_exit(status) {
                throw new WebAssembly.RuntimeError(`the module ended itself with status ${status}`);
            },
        },
    };
}

/** The same, limited to the imports that the compiled module names, so that the build detects a new one. */
export function importsFor(compiled, memory) {
    const all = makeImports(memory);
    const result = {};
    for (const { module, name } of WebAssembly.Module.imports(compiled)) {
        const found = all[module]?.[name];
        if (found === undefined) throw new Error(`echinus.wasm imports ${module}.${name}, which this version does not supply`);
        (result[module] ??= {})[name] = found;
    }
    return result;
}
