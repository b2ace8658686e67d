export { load } from 'echinus';
