#include "exact_map/layout.hpp"

namespace echinus {

std::size_t ExactMapView::byte_count() const {
    std::size_t count = band_offsets.size_bytes() + outer_limits.size_bytes() + bands.size_bytes() +
                        winding_below.size_bytes() + references.size_bytes() + reference_parts.size_bytes() +
                        vertices.size_bytes() + corners.size_bytes() + face_numbers.size_bytes() +
                        nodes.size_bytes() + border.size_bytes();
    if (winding_tree == nullptr) return count;
    count += winding_tree->moments.size_bytes();
    if (winding_tree->has_caps)
        count += winding_tree->nodes.size_bytes() + winding_tree->corners.size_bytes();
    return count;
}

} // namespace echinus
