import type { Sample } from '../../settings';
import type { Act } from './act';
import { figure } from './figure';
import { flag } from './flag';
import { layers } from './layers';
import { organ } from './organ';
import { ring } from './ring';

/** What happens around a sample; nothing here: a sheet falls on it. */
export const ACTS: { readonly [S in Sample]?: () => Act } = { figure, flag, layers, organ, ring };
