import { load } from './load.js';
import { answer } from './answer.js';

load().then((echinus) => postMessage(answer(echinus)));
