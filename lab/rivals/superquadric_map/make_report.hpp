#pragma once

#include "rivals/superquadric_map/layout.hpp"
#include "rivals/superquadric_map/report.hpp"
#include "rivals/superquadric_map/segments.hpp"

#include <echinus/mesh.hpp>

namespace echinus::rivals {

/// The part of a segment's report that its own faces tell; area_share is still the area itself.
/// @param fitted  before the enlargement
SegmentReport report_on(const Segment& segment, const Superquadric& fitted, double enlargement);

/// Fills in which part of the surface the map covers, and turns areas into shares.
void measure_coverage(const TriangleMesh& mesh, const SegmentArrays& map, double bounding_radius,
                      SuperquadricReport& report);

} // namespace echinus::rivals
