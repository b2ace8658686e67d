#pragma once

#include "rivals/systems/superquadric_map/superquadric_map.hpp"

#include <echinus/render.hpp>

/// Six pictures of one model: as it is, its segments, the superquadrics fitted to them, the same as the map
/// has them, enlarged until they hold their segments, the map's surface, and what of the model no segment
/// covers. A segment has one colour throughout.
/// @param options  width and height are those of one picture
/// @throws Error as render()
echinus::Image draw_segments_figure(const echinus::TriangleMesh& model,
                                    const echinus::rivals::SuperquadricMap& map, const echinus::View& view,
                                    const echinus::RenderOptions& options);
