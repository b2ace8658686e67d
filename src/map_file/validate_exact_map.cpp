#include "directions/lattice.hpp"
#include "map_file/checker.hpp"
#include "map_file/exact_map_table.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace echinus {

namespace {

constexpr auto kExtent = static_cast<std::int32_t>(kLatticeExtent);

void check_scalars(const Checker& checker, const ExactMapView& map) {
    // The bounds of a build; a searched centre may double the radius.
    constexpr float kSmallest = 1e-15F, kLargest = 4e15F;
    if (!is_finite(map.centre)) checker.fail("centre is not finite");
    if (!(map.radius >= kSmallest && map.radius <= kLargest))
        checker.fail("radius is not within 1e-15 to 4e15");
    checker.check_range("divisions", map.divisions, 1U, ExactMapOptions::kMaxDivisions);
    checker.check_enumerator("inside_rule", map.rule, InsideRule::Parity);
}

/// @param name  name of the two arrays, without their width
/// @param end  every index is smaller
void check_indices(const Checker& checker, const std::string& name, const IndexArray& indices,
                   std::size_t end) {
    if (!indices.narrow.empty() && !indices.wide.empty())
        checker.fail(name + "16 and " + name + "32 both have elements");
    const std::string array = name + (indices.wide.empty() ? "16" : "32");
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= end)
            checker.fail(array, i,
                         "is " + std::to_string(indices[i]) + " and not below " + std::to_string(end));
}

bool is_within(std::int32_t value, std::int32_t extent) {
    return value >= -extent && value <= extent;
}

void check_mesh(const Checker& checker, const ExactMapView& map) {
    for (std::size_t i = 0; i < map.vertices.size(); ++i) {
        const Vec3<std::int32_t>& v = map.vertices[i];
        if (!is_within(v.x, kExtent) || !is_within(v.y, kExtent) || !is_within(v.z, kExtent))
            checker.fail("vertices", i, "lies beyond the lattice");
    }
    if (map.face_count() == 0) checker.fail("it has no faces");
    checker.check_size("corners", map.corners.size(), 3 * map.face_count());
    check_indices(checker, "corners", map.corners, map.vertices.size());
    for (std::size_t i = 0; i < map.border.size(); ++i) {
        const BorderEdge& edge = map.border[i];
        if (edge.a >= map.vertices.size() || edge.b >= map.vertices.size())
            checker.fail("border", i, "names a vertex that does not exist");
        if (edge.a == edge.b || edge.multiplicity == 0) checker.fail("border", i, "is no edge");
    }
}

/// The bands of each cell ascend and do not overlap, and their faces are in the order of the bands.
void check_bands(const Checker& checker, const ExactMapView& map) {
    if (map.bands.empty()) checker.fail("bands has no elements, not even its end");
    const std::size_t band_count = map.bands.size() - 1;
    checker.check_offsets("band_offsets", map.band_offsets, map.cell_count());
    checker.check_size("bands", map.bands.size(), std::size_t{map.band_offsets.back()} + 1);
    checker.check_size("winding_below", map.winding_below.size(), band_count);
    check_indices(checker, "references", map.references, map.face_count());
    checker.check_size("reference_parts", map.reference_parts.size(), map.references.size());
    std::uint32_t first_reference = 0;
    for (std::size_t i = 0; i <= band_count; ++i) {
        if (map.bands[i].first_reference < first_reference || (i == 0 && map.bands[i].first_reference != 0))
            checker.fail("bands", i, "does not begin where the one before it ends");
        first_reference = map.bands[i].first_reference;
    }
    checker.check_size("references", map.references.size(), first_reference);
    for (std::size_t cell = 0; cell < map.cell_count(); ++cell) {
        std::uint16_t least = 0;
        bool may_be_upper_half = false; // a lower half comes before it, and meets it
        for (std::uint32_t i = map.band_offsets[cell]; i < map.band_offsets[cell + 1]; ++i) {
            const bool is_upper_half = map.winding_below[i] == ExactMapView::kSplit;
            if (is_upper_half && !(may_be_upper_half && map.bands[i].lower == least))
                checker.fail("winding_below", i, "makes its band the upper half of none");
            may_be_upper_half = !is_upper_half;
            if (map.bands[i].lower < least || map.bands[i].upper < map.bands[i].lower)
                checker.fail("bands", i, "overlaps the one before it, or itself");
            least = map.bands[i].upper;
        }
    }
    if (!map.border.empty()) return;
    for (std::size_t i = 0; i < band_count; ++i)
        if (map.winding_below[i] == ExactMapView::kUncertain)
            checker.fail("winding_below", i, "is uncertain, though the surface has no border");
}

/// Walks the tree from the root: every node and every leaf is reached exactly once.
class TreeCheck {
  public:
    TreeCheck(const Checker& checker, const ExactMapView& map)
        : checker_(checker), map_(map), leaf_count_((map.face_count() + kWidth - 1) / kWidth),
          depths_(map.nodes.size()), is_leaf_met_(leaf_count_) {}

    void run() {
        if (map_.nodes.empty()) checker_.fail("nodes has no elements");
        depths_[0] = 1;
        // Children come after their parents, so one pass visits every node after its parent.
        for (std::uint32_t node = 0; node < map_.nodes.size(); ++node) {
            if (depths_[node] == 0) checker_.fail("nodes", node, "is no child of an earlier one");
            for (std::size_t k = 0; k < kWidth; ++k) check_child(node, k);
        }
        for (std::size_t leaf = 0; leaf < leaf_count_; ++leaf)
            if (!is_leaf_met_[leaf]) checker_.fail("the tree misses leaf " + std::to_string(leaf));
    }

  private:
    static constexpr std::size_t kWidth = TreeNode::kWidth;
    static constexpr std::uint8_t kMaxDepth = 12; // src/exact_map/query/face_tree_walk.hpp

    void check_child(std::uint32_t node, std::size_t k) {
        const TreeNode& n = map_.nodes[node];
        const std::uint32_t child = n.children[k];
        if (n.low[0][k] > n.high[0][k]) {
            if (n.low[1][k] <= n.high[1][k] || n.low[2][k] <= n.high[2][k] || child != 0)
                fail(node, k, "is neither a child nor the mark of none");
            return;
        }
        if ((child & TreeNode::kLeaf) != 0)
            check_leaf(node, k, child - TreeNode::kLeaf);
        else
            check_node(node, k, child);
    }

    void check_node(std::uint32_t node, std::size_t k, std::uint32_t child) {
        if (child <= node || child >= map_.nodes.size() || depths_[child] != 0)
            fail(node, k, "is not a later node that has no parent yet");
        depths_[child] = static_cast<std::uint8_t>(depths_[node] + 1);
        if (depths_[child] > kMaxDepth) fail(node, k, "lies deeper than " + std::to_string(kMaxDepth));
        const TreeNode& inner = map_.nodes[child];
        for (std::size_t j = 0; j < kWidth; ++j) {
            if (inner.low[0][j] > inner.high[0][j]) continue;
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (inner.low[axis][j] < map_.nodes[node].low[axis][k] ||
                    inner.high[axis][j] > map_.nodes[node].high[axis][k])
                    fail(node, k, "has a box that does not hold those of its children");
        }
    }

    void check_leaf(std::uint32_t node, std::size_t k, std::uint32_t leaf) {
        if (leaf >= leaf_count_ || is_leaf_met_[leaf]) fail(node, k, "is not a leaf that has no parent yet");
        is_leaf_met_[leaf] = true;
        const std::size_t end = std::min((std::size_t{leaf} + 1) * kWidth, map_.face_count());
        for (std::size_t corner = 3 * kWidth * leaf; corner < 3 * end; ++corner) {
            const Vec3<std::int32_t>& v = map_.vertices[map_.corners[corner]];
            const std::array<std::int32_t, 3> place{v.x, v.y, v.z};
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (place[axis] < map_.nodes[node].low[axis][k] * ExactMapView::kBoxUnit ||
                    place[axis] > map_.nodes[node].high[axis][k] * ExactMapView::kBoxUnit)
                    fail(node, k, "has a box that does not hold its faces");
        }
    }

    [[noreturn]] void fail(std::uint32_t node, std::size_t k, const std::string& finding) const {
        checker_.fail("nodes", node, "child " + std::to_string(k) + " " + finding);
    }

    const Checker& checker_;
    const ExactMapView& map_;
    std::size_t leaf_count_;
    std::vector<std::uint8_t> depths_; ///< [node_count] 1 for the root; 0: not visited yet
    std::vector<bool> is_leaf_met_;
};

void check_statistics(const Checker& checker, const ExactMapView& map, const ExactMapStatistics& statistics) {
    constexpr std::size_t kMostFaces = std::size_t{1} << 31; // answers name a face by an int32
    check_indices(checker, "face_numbers", map.face_numbers,
                  std::min<std::size_t>(statistics.face_count, kMostFaces));
    checker.check_equal("face_count", statistics.face_count, map.face_count());
    std::uint32_t collapsed_count = 0;
    for (std::size_t face = 0; face < map.face_count(); ++face) {
        const auto corner = [&](std::size_t k) {
            return LatticePoint(map.vertices[map.corners[3 * face + k]]);
        };
        collapsed_count += is_collapsed({corner(0), corner(1), corner(2)}) ? 1 : 0;
    }
    checker.check_equal("dropped_faces", statistics.dropped_faces, collapsed_count);
    std::uint32_t longest_list = 0;
    for (std::size_t i = 0; i + 1 < map.bands.size(); ++i)
        longest_list =
            std::max(longest_list, map.bands[i + 1].first_reference - map.bands[i].first_reference);
    checker.check_equal("longest_list", statistics.longest_list, longest_list);
    constexpr float kMost = std::numeric_limits<float>::max();
    checker.check_range("mean_list", statistics.mean_list, 0.0F, kMost);
    checker.check_range("expected_tests", statistics.expected_tests, 0.0F, kMost);
    checker.check_range("certain_share", statistics.certain_share, 0.0F, 1.0F);
    checker.check_range("uncertain_directions", statistics.uncertain_directions, 0.0F, 1.0F);
}

} // namespace

void validate(const ExactMapView& map, const ExactMapStatistics& statistics, const std::string& name) {
    const Checker checker(name);
    check_scalars(checker, map);
    check_mesh(checker, map);
    check_bands(checker, map);
    TreeCheck(checker, map).run();
    check_statistics(checker, map, statistics);
}

} // namespace echinus
