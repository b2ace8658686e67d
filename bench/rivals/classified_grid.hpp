#pragma once

#include "baselines/classified_grid/classified_grid.hpp"

#include <echinus/exact_map.hpp>

/// The strongest exact rival gets as many bytes as the exact map has by default.
inline std::size_t bytes_of_exact_map(const echinus::TriangleMesh& mesh) {
    return echinus::ExactMap::build(mesh).view().byte_count();
}
