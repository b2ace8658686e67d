#include "directions/lattice.hpp"
#include "exact_map/layout.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace echinus {

namespace {

constexpr auto kExtent = static_cast<std::int32_t>(kLatticeExtent);

void check_scalars(const Checker& checker, const ExactMapView& map) {
    // A build keeps to [1e-15, 1e15]; a searched centre may double the radius.
    constexpr float kSmallest = 1e-15F, kLargest = 4e15F;
    if (!is_finite(map.centre)) checker.fail("centre is not finite");
    if (!(map.radius >= kSmallest && map.radius <= kLargest))
        checker.fail("radius is not within 1e-15 to 4e15");
    checker.check_range("divisions", map.divisions, 1U, ExactMapOptions::kMaxDivisions);
    checker.check_enumerator("inside_rule", map.rule, InsideRule::Parity);
}

/// @param end  must be greater than every index
template <typename Index>
void check_indices(const Checker& checker, const std::string& array, std::span<const Index> indices,
                   std::size_t end) {
    if (indices.empty() || end > std::numeric_limits<Index>::max()) return;
    Index largest = 0; // no branch, so that the compiler vectorises the loop
    for (const Index index : indices) largest = std::max(largest, index);
    if (largest < end) return;
    const auto beyond =
        std::find_if(indices.begin(), indices.end(), [=](Index index) { return index >= end; });
    checker.fail(array, static_cast<std::size_t>(beyond - indices.begin()),
                 "is " + std::to_string(*beyond) + " and not below " + std::to_string(end));
}

/// @param name  name of the two arrays, without the suffix that states their width
void check_indices(const Checker& checker, const std::string& name, const IndexArray& indices,
                   std::size_t end) {
    if (!indices.narrow.empty() && !indices.wide.empty())
        checker.fail(name + "16 and " + name + "32 both have elements");
    check_indices(checker, name + "16", indices.narrow, end);
    check_indices(checker, name + "32", indices.wide, end);
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
        if (edge.a == edge.b || edge.multiplicity == 0) checker.fail("border", i, "is not an edge");
    }
}

void check_first_references(const Checker& checker, std::span<const Band> bands) {
    bool ascend = bands[0].first_reference == 0; // no branch, as it fails for hardly any map
    for (std::size_t i = 1; i < bands.size(); ++i)
        ascend &= bands[i].first_reference >= bands[i - 1].first_reference;
    if (ascend) return;
    std::uint32_t least = 0;
    for (std::size_t i = 0; i < bands.size(); ++i) {
        if (bands[i].first_reference < least || (i == 0 && bands[i].first_reference != 0))
            checker.fail("bands", i, "does not begin where the one before it ends");
        least = bands[i].first_reference;
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
    check_first_references(checker, map.bands);
    checker.check_size("references", map.references.size(), map.bands.back().first_reference);
    for (std::size_t cell = 0; cell < map.cell_count(); ++cell) {
        std::uint16_t least = 0;
        bool may_be_upper_half = false; // a lower half comes before the upper one and touches it
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
    const auto uncertain =
        std::find(map.winding_below.begin(), map.winding_below.end(), ExactMapView::kUncertain);
    if (uncertain != map.winding_below.end())
        checker.fail("winding_below", static_cast<std::size_t>(uncertain - map.winding_below.begin()),
                     "is uncertain, though the surface has no border");
}

/// Walks the tree from the root: every node and every leaf is reached exactly once.
/// @tparam Vertex  the type of the corners' vertex numbers
template <typename Vertex>
class TreeCheck {
  public:
    TreeCheck(const Checker& checker, const ExactMapView& map, std::span<const Vertex> corners)
        : checker_(checker), map_(map), corners_(corners),
          leaf_count_((map.face_count() + kWidth - 1) / kWidth), depths_(map.nodes.size()),
          is_leaf_met_(leaf_count_) {}

    /// @returns  how many faces have two corners on one lattice point
    std::uint32_t run() {
        if (map_.nodes.empty()) checker_.fail("nodes has no elements");
        depths_[0] = 1;
        // Children come after their parents, so one pass visits every node after its parent.
        for (std::uint32_t node = 0; node < map_.nodes.size(); ++node) {
            if (depths_[node] == 0) checker_.fail("nodes", node, "is not a child of an earlier one");
            for (std::size_t k = 0; k < kWidth; ++k) check_child(node, k);
        }
        for (std::size_t leaf = 0; leaf < leaf_count_; ++leaf)
            if (!is_leaf_met_[leaf]) checker_.fail("the tree misses leaf " + std::to_string(leaf));
        return collapsed_count_;
    }

  private:
    static constexpr std::size_t kWidth = TreeNode::kWidth;
    static constexpr std::uint8_t kMaxDepth = 12; // src/exact_map/query/nearest.hpp

    void check_child(std::uint32_t node, std::size_t k) {
        const TreeNode& n = map_.nodes[node];
        const std::uint32_t child = n.children[k];
        if (n.low[0][k] > n.high[0][k]) {
            if (n.low[1][k] <= n.high[1][k] || n.low[2][k] <= n.high[2][k] || child != 0)
                fail(node, k, "is neither a child nor the marker for no child");
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
        const TreeNode& n = map_.nodes[node];
        const std::size_t first = kWidth * std::size_t{leaf};
        const std::size_t count = std::min(kWidth, map_.face_count() - first);
        load(first, count);
        const Range x = range(n, 0, k), y = range(n, 1, k), z = range(n, 2, k);
        const auto& [a, b, c] = places_;
        std::int32_t outside = 0; // negative if a corner lies below or above the box
        std::int32_t equal = 0;   // not 0 if two corners agree along x
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
            outside |= x.signs(a[0][lane]) | x.signs(b[0][lane]) | x.signs(c[0][lane]);
            outside |= y.signs(a[1][lane]) | y.signs(b[1][lane]) | y.signs(c[1][lane]);
            outside |= z.signs(a[2][lane]) | z.signs(b[2][lane]) | z.signs(c[2][lane]);
            equal |= std::int32_t{a[0][lane] == b[0][lane]} | std::int32_t{b[0][lane] == c[0][lane]} |
                     std::int32_t{c[0][lane] == a[0][lane]};
        }
        if (outside < 0) fail(node, k, "has a box that does not hold its faces");
        if (equal != 0)
            for (std::size_t lane = 0; lane < count; ++lane)
                collapsed_count_ += meet(a, b, lane) || meet(b, c, lane) || meet(c, a, lane) ? 1 : 0;
    }

    struct Range {
        std::int32_t low, high;

        /// Negative if the value is out of range.
        std::int32_t signs(std::int32_t value) const { return (value - low) | (high - value); }
    };
    static Range range(const TreeNode& node, std::size_t axis, std::size_t k) {
        return {node.low[axis][k] * ExactMapView::kBoxUnit, node.high[axis][k] * ExactMapView::kBoxUnit};
    }

    /// A number for each face of a leaf, in a loop over which the compiler vectorises.
    using Lanes = std::array<std::int32_t, kWidth>;
    using Corners = std::array<Lanes, 3>; ///< one corner of each face, by axis

    static bool meet(const Corners& a, const Corners& b, std::size_t lane) {
        return a[0][lane] == b[0][lane] && a[1][lane] == b[1][lane] && a[2][lane] == b[2][lane];
    }

    /// Loads the corners of a leaf's faces. If the leaf is not full, its last face takes the remaining lanes.
    void load(std::size_t first, std::size_t count) {
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
            const Vertex* corners = &corners_[3 * (first + std::min(lane, count - 1))];
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const Vec3<std::int32_t>& v = map_.vertices[corners[corner]];
                places_[corner][0][lane] = v.x;
                places_[corner][1][lane] = v.y;
                places_[corner][2][lane] = v.z;
            }
        }
    }

    [[noreturn]] void fail(std::uint32_t node, std::size_t k, const std::string& finding) const {
        checker_.fail("nodes", node, "child " + std::to_string(k) + " " + finding);
    }

    const Checker& checker_;
    const ExactMapView& map_;
    std::span<const Vertex> corners_; ///< the corners of all faces
    std::size_t leaf_count_;
    std::uint32_t collapsed_count_ = 0;
    std::array<Corners, 3> places_;    ///< the corners of the current leaf's faces
    std::vector<std::uint8_t> depths_; ///< [node_count] 1 for the root; 0: not visited yet
    std::vector<bool> is_leaf_met_;
};

/// @returns  how many faces have two corners on one lattice point
std::uint32_t check_tree(const Checker& checker, const ExactMapView& map) {
    return map.corners.wide.empty() ? TreeCheck(checker, map, map.corners.narrow).run()
                                    : TreeCheck(checker, map, map.corners.wide).run();
}

void check_statistics(const Checker& checker, const ExactMapView& map, const ExactMapStatistics& statistics,
                      std::uint32_t collapsed_count) {
    constexpr std::size_t kMostFaces = std::size_t{1} << 31; // results name a face by an int32
    check_indices(checker, "face_numbers", map.face_numbers,
                  std::min<std::size_t>(statistics.face_count, kMostFaces));
    checker.check_equal("face_count", statistics.face_count, map.face_count());
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

void validate(const Checker& checker, const ExactMapView& map, const ExactMapStatistics& statistics) {
    check_scalars(checker, map);
    check_mesh(checker, map);
    check_bands(checker, map);
    check_statistics(checker, map, statistics, check_tree(checker, map));
}

ExactMap proven(const ExactMapView& map, const ExactMapStatistics& statistics, std::uint64_t source_hash,
                std::shared_ptr<const void> storage) {
    validate(Checker::of_build(), map, statistics);
    return {map, statistics, source_hash, std::move(storage)};
}

} // namespace echinus
