#pragma once

#include "baselines/dense_grid/dense_grid.hpp"

#include <echinus/mesh.hpp>

#include <optional>

/// The sizes in which the dense grid takes part: by bytes, or where these are 0 by the spacing.
struct GridSize {
    const char* name;
    std::size_t bytes;
    double spacing_in_radii;
};

/// The bytes that the paper gives for its map of the horse, and as many samples across the bounding sphere as
/// the paper's distance field has.
inline constexpr GridSize kGridSizes[] = {
    {"dense grid 0.63 MB", 630'000, 0},
    {"dense grid 2R/200", 0, 2.0 / 200},
};

inline echinus::baselines::DenseGrid grid_of(const echinus::TriangleMesh& mesh, const GridSize& size) {
    using echinus::baselines::DenseGrid;
    if (size.bytes != 0) return DenseGrid::with_bytes(mesh, size.bytes);
    return DenseGrid::with_spacing(mesh,
                                   size.spacing_in_radii * echinus::inspect(mesh).bounding_sphere.radius);
}
