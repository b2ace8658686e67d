import { load as loadFrom } from 'echinus';
import wasm from 'echinus/echinus.wasm';

export const load = () => loadFrom(wasm);
