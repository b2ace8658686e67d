#pragma once

#include <echinus/exact_map.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace echinus::test {

/// A copy of an exact map's arrays, to be changed before making a map of them again.
struct ExactMapParts {
    ExactMapView view; ///< its spans are unused
    ExactMapStatistics statistics;
    std::uint64_t source_hash = 0;
    std::vector<std::uint32_t> band_offsets;
    std::vector<std::uint16_t> outer_limits;
    std::vector<Band> bands;
    std::vector<std::int16_t> winding_below;
    std::vector<std::uint16_t> reference_parts;
    std::vector<Vec3<std::int32_t>> vertices;
    std::vector<TreeNode> nodes;
    std::vector<BorderEdge> border;
    struct Indices {
        std::vector<std::uint16_t> narrow;
        std::vector<std::uint32_t> wide;

        explicit Indices(const IndexArray& array)
            : narrow(array.narrow.begin(), array.narrow.end()), wide(array.wide.begin(), array.wide.end()) {}
        IndexArray view() const { return {narrow, wide}; }
        /// Stores the same numbers in 32 bits.
        void widen() {
            wide.insert(wide.begin(), narrow.begin(), narrow.end());
            narrow.clear();
        }
    } references, corners, face_numbers;

    explicit ExactMapParts(const ExactMap& map)
        : view(map.view()), statistics(map.statistics()), source_hash(map.source_hash()),
          band_offsets(view.band_offsets.begin(), view.band_offsets.end()),
          outer_limits(view.outer_limits.begin(), view.outer_limits.end()),
          bands(view.bands.begin(), view.bands.end()),
          winding_below(view.winding_below.begin(), view.winding_below.end()),
          reference_parts(view.reference_parts.begin(), view.reference_parts.end()),
          vertices(view.vertices.begin(), view.vertices.end()), nodes(view.nodes.begin(), view.nodes.end()),
          border(view.border.begin(), view.border.end()), references(view.references), corners(view.corners),
          face_numbers(view.face_numbers) {}

    void widen() {
        references.widen();
        corners.widen();
        face_numbers.widen();
    }

    /// A map over copies of the arrays, whether or not they make sense.
    ExactMap map() const {
        const auto storage = std::make_shared<const ExactMapParts>(*this);
        ExactMapView all = view;
        all.band_offsets = storage->band_offsets;
        all.outer_limits = storage->outer_limits;
        all.bands = storage->bands;
        all.winding_below = storage->winding_below;
        all.references = storage->references.view();
        all.reference_parts = storage->reference_parts;
        all.vertices = storage->vertices;
        all.corners = storage->corners.view();
        all.face_numbers = storage->face_numbers.view();
        all.nodes = storage->nodes;
        all.border = storage->border;
        all.winding_tree = {}; // made anew
        all.winding_tree_has_caps = false;
        return {all, statistics, source_hash, storage};
    }
};

} // namespace echinus::test
