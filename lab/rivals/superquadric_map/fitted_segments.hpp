#pragma once

#include "directions/lattice.hpp"
#include "rivals/superquadric_map/decompose.hpp"
#include "rivals/superquadric_map/layout.hpp"
#include "rivals/superquadric_map/report.hpp"
#include "rivals/superquadric_map/segments.hpp"
#include "rivals/superquadric_map/superquadric.hpp"

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace echinus::rivals {

/// A segment and the superquadric around it.
struct FittedSegment {
    Superquadric shape; ///< enlarged so that it holds the segment
    /// The segment around the superquadric's centre, its own faces before the hull's; none where no face has
    /// an area.
    std::optional<LatticeMesh> lattice;
    std::size_t own_face_count = 0;
    SegmentReport report; ///< but for the share of empty samples
};

/// All of a map but its samples.
struct FittedSegments {
    TriangleMesh solid; ///< welded, wound outward
    double radius = 0;  ///< of its bounding sphere
    std::vector<std::uint32_t> segment_of_face;
    std::vector<FittedSegment> segments;
};

/// @param mesh  closed
/// @param thread_count  0: all cores. What is fitted does not depend on it.
FittedSegments fit_segments(const TriangleMesh& mesh, const DecompositionOptions& options,
                            unsigned thread_count, const Progress& progress);

/// The part of a segment's report that its own faces tell; area_share is still the area itself.
/// @param fitted  before the enlargement
SegmentReport report_on(const Segment& segment, const Superquadric& fitted, double enlargement);

/// Fills in which part of the surface the map covers, and turns areas into shares.
void measure_coverage(const TriangleMesh& mesh, const SegmentArrays& map, double bounding_radius,
                      SuperquadricReport& report);

} // namespace echinus::rivals
