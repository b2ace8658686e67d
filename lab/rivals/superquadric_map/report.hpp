#pragma once

#include "rivals/superquadric_map/superquadric.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace echinus::rivals {

/// One segment of a superquadric map. Errors and shares of samples are relative, so that segments compare.
struct SegmentReport {
    Superquadric fitted;    ///< in the mesh's frame and unit
    double enlargement = 1; ///< what the fitted sizes are multiplied by to hold the segment
    double radius = 0;      ///< of the segment: the farthest of its vertices from the superquadric's centre
    double mean_fit_error =
        0; ///< radial distance from the fitted superquadric to the segment's faces, in radii
    double largest_fit_error = 0;  ///< of the same
    std::size_t face_count = 0;    ///< of the mesh's faces
    double area_share = 0;         ///< of the mesh's area
    double empty_sample_share = 0; ///< of the grid: rays that miss the segment
};

struct SuperquadricReport {
    std::vector<SegmentReport> segments;
    std::vector<std::uint32_t> segment_of_face; ///< [face_count] as in the mesh; empty without segments

    /// A point of the surface is covered when the surface of some segment's map passes within the tolerance
    /// of it, to first order: radial distance times the cosine between ray and normal.
    double tolerance = 0; ///< in the mesh's unit: a hundredth of its bounding radius
    double uncovered_area_share = 0;
    std::vector<std::uint32_t> uncovered_faces; ///< ascending: those whose middle is not covered
    /// Surface that lies deeper than the tolerance in some segment's map, so that no particle gets there. May
    /// be covered as well.
    double buried_area_share = 0;
};

/// Radial distances from the fitted superquadrics to what they are fitted to, in radii of the segments.
struct FitError {
    double mean = 0; ///< over the mesh's area
    double largest = 0;
};
FitError fit_error(const SuperquadricReport& report);

/// A table for people: a line for each segment, then the surface that is not covered.
std::string describe(const SuperquadricReport& report);

} // namespace echinus::rivals
