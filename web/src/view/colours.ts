/** The colours of the project's figures: namespace palette of echinus_render/render.hpp, where their sources are. */
export const CLAY = 0xbdb5aa;
export const CLOTH = 0xb4584e;
export const CLOTH_BACK = 0xd39a7c;
/** A border woven into a sheet. */
export const HEM = 0xe8cba6;
/** From the first piece of a cloth of several to the last. */
export const TINTS = [0x2f6f8f, 0xe0c9a0, 0xb4584e];
export const FLESH = 0xb2574c;
/** The ball, which the visitor moves. */
export const TOOL = 0x5c7f92;
export const INK = 0x3a3936;
/** Lines on the backdrop when that is dark. */
export const CHALK = 0xd6d2ca;
export const LAYER_BACK = 0xe4ded4;
export const LAYERS = [0x44aa99, 0xddcc77, 0xcc6677, 0x88ccee, 0xaa4499, 0x999933, 0x332288, 0x117733, 0x882255];
export const SCALE = [0xfff7bc, 0xfec44f, 0xfb9a29, 0xcc4c02, 0x662506];

/** Where a map searches for surface along a ray. */
export const BAND = 0x2f6f8f;

/** The faults of a cloth, in a colour unlike all others in the picture. */
export const WRONG = 0x16c5f5;

/** The faults of a mesh, by kind: vivid, since they must be seen. */
export const FAULT = { borderEdges: 0xd1242f, nonmanifoldEdges: 0x8250df, misorientedEdges: 0xbf8700, faces: 0xd1242f } as const;

/** Paper and room behind everything, and the ground where the light falls. */
export const BACKDROP = { light: 0xf3f1ec, dark: 0x1b1d21 };
export const GROUND = { light: 0xfdfcf9, dark: 0x2e3238 };
