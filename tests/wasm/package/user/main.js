import { load } from './load.js';
import { answer } from './answer.js';

const worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
const fromWorker = new Promise((resolve) => (worker.onmessage = ({ data }) => resolve(data)));

Promise.all([load().then(answer), fromWorker]).then(([here, there]) => {
    document.body.textContent = `page: ${here}; worker: ${there}`;
});
