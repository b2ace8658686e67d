import type { MeshReport } from 'echinus';

/** Faces look inwards. Of an open mesh the volume says nothing. */
export const isInsideOut = ({ closed, signedVolume }: MeshReport): boolean => closed && signedVolume < 0;
