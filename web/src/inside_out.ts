import type { MeshReport } from 'echinus';

/** Do the faces look inwards? Undecided for an open mesh, whose volume is meaningless. */
export const isInsideOut = ({ closed, signedVolume }: MeshReport): boolean => closed && signedVolume < 0;
