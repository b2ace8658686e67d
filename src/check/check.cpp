#include "geometry/box.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/whole_numbers.hpp"
#include "mesh/require_valid.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/intersections.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <queue>
#include <string>
#include <utility>
#include <vector>

namespace echinus {

namespace {

/// Finds the deepest of many vertices inside a map. The depths of two vertices differ by at most the distance
/// between them, so the depth of one vertex bounds those in a box: only a few vertices need the search for
/// the nearest face, which is slow far from the surface.
class DeepestVertex {
  public:
    /// @param vertices  at least one, all inside
    DeepestVertex(const ExactMapView& map, const std::vector<Vec3f>& points,
                  const std::vector<std::uint32_t>& vertices)
        : map_(map), points_(points), vertices_(vertices), tree_(boxes()) {}

    void find(Penetration& deepest) {
        std::priority_queue<BoundedNode> nodes;
        nodes.push({bound_of(0, deepest), 0});
        while (!nodes.empty() && nodes.top().bound >= double{deepest.depth}) {
            const std::uint32_t index = nodes.top().node;
            nodes.pop();
            const BoxTree::Node& node = tree_.node(index);
            if (node.is_leaf()) {
                for (std::uint32_t i = node.begin; i < node.end; ++i) depth_at(i, deepest);
                continue;
            }
            tree_.split(index);
            for (const std::uint32_t child : {node.left, node.right()})
                nodes.push({bound_of(child, deepest), child});
        }
    }

  private:
    struct BoundedNode {
        double bound; ///< no vertex of the node is deeper
        std::uint32_t node;

        bool operator<(const BoundedNode& other) const { return bound < other.bound; }
    };

    std::vector<BoxTree::Box> boxes() const {
        std::vector<BoxTree::Box> boxes(vertices_.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].add(points_[vertices_[i]]);
        return boxes;
    }

    std::uint32_t vertex_at(std::uint32_t leaf) const { return vertices_[tree_.leaf(leaf).item]; }

    double depth_at(std::uint32_t leaf, Penetration& deepest) const {
        const std::uint32_t vertex = vertex_at(leaf);
        const float depth = contact(map_, points_[vertex]).depth;
        if (depth > deepest.depth || (depth == deepest.depth && vertex < deepest.deepest_vertex)) {
            deepest.depth = depth;
            deepest.deepest_vertex = vertex;
        }
        return depth;
    }

    double bound_of(std::uint32_t index, Penetration& deepest) const {
        const BoxTree::Node& node = tree_.node(index);
        // Depths are rounded, and are those of vertices snapped to a lattice with steps of 1.9e-6 of the
        // radius.
        const double error = 1e-5 * double{map_.radius};
        return depth_at(node.begin, deepest) +
               node.box.farthest_distance(Vec3d(points_[vertex_at(node.begin)])) + error;
    }

    const ExactMapView& map_;
    const std::vector<Vec3f>& points_;
    const std::vector<std::uint32_t>& vertices_;
    BoxTree tree_;
};

/// The meshes, and what is computed only once for each.
class Meshes {
  public:
    Meshes(std::span<const TriangleMesh> meshes, const CheckOptions& options)
        : meshes_(meshes), names_(options.names), thread_count_(options.thread_count), boxes_(meshes.size()),
          is_mapped_(meshes.size()), maps_(meshes.size()) {
        if (!names_.empty() && names_.size() != meshes.size())
            throw Error(ErrorCode::InvalidOptions, std::to_string(names_.size()) + " names for " +
                                                       std::to_string(meshes.size()) + " meshes");
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            require_valid(i);
            for (const Triangle& face : meshes[i].faces)
                for (const std::uint32_t vertex : face) boxes_[i].add(meshes[i].vertices[vertex]);
        }
    }

    CheckedMeshes check(std::uint32_t a, std::uint32_t b) {
        CheckedMeshes pair;
        pair.a = a;
        pair.b = b;
        try {
            if (a == b)
                pair.found = self_intersections(meshes_[a]);
            else if (boxes_[a].overlaps(boxes_[b]))
                check_two(pair);
        } catch (const Error& error) {
            throw Error(error.code(), (a == b ? name(a) : name(a) + " and " + name(b)) + ": " + error.what());
        }
        return pair;
    }

  private:
    std::string name(std::size_t mesh) const {
        return names_.empty() ? "mesh " + std::to_string(mesh) : names_[mesh];
    }

    void require_valid(std::size_t mesh) const {
        try {
            echinus::require_valid(meshes_[mesh]);
            if (meshes_[mesh].origin != meshes_[0].origin)
                throw Error(ErrorCode::InvalidMesh, "the origin is not that of the first mesh; move the "
                                                    "vertices to its frame first");
        } catch (const Error& error) {
            throw Error(error.code(), name(mesh) + ": " + error.what());
        }
    }

    void check_two(CheckedMeshes& pair) {
        pair.found = intersections(meshes_[pair.a], meshes_[pair.b]);
        pair.a_in_b = penetration(pair.a, pair.b);
        pair.b_in_a = penetration(pair.b, pair.a);
    }

    /// The map of a closed mesh. Null if the mesh is open or has a shape that no map can represent, such as
    /// tiny parts that are far apart: its intersections are found nevertheless.
    const ExactMap* map_of(std::uint32_t mesh) {
        if (!is_mapped_[mesh]) {
            is_mapped_[mesh] = true;
            if (inspect(meshes_[mesh]).closed) build_map(mesh);
        }
        return maps_[mesh] ? &*maps_[mesh] : nullptr;
    }

    void build_map(std::uint32_t mesh) {
        try {
            maps_[mesh] = ExactMap::build(meshes_[mesh], {.thread_count = thread_count_});
        } catch (const Error& error) {
            if (error.code() != ErrorCode::InvalidMesh) throw;
        }
    }

    Penetration penetration(std::uint32_t mesh, std::uint32_t of) {
        const ExactMap* map = map_of(of);
        if (map == nullptr) return {};
        const std::vector<Vec3f>& points = meshes_[mesh].vertices;
        std::vector<std::uint8_t> inside(points.size());
        contains_batch(*map, points, inside, thread_count_);
        const UsedVertices used(meshes_[mesh].faces, points.size());
        std::vector<std::uint32_t> vertices;
        for (std::uint32_t i = 0; i < points.size(); ++i)
            if (inside[i] != 0 && used[i]) vertices.push_back(i);
        Penetration found{.known = true, .vertex_count = kept_as<std::uint32_t>(vertices.size())};
        if (!vertices.empty()) DeepestVertex(*map, points, vertices).find(found);
        return found;
    }

    std::span<const TriangleMesh> meshes_;
    const std::vector<std::string>& names_;
    unsigned thread_count_;
    std::vector<AlignedBox<float>> boxes_;
    std::vector<bool> is_mapped_; ///< whether a map was built, or found to be impossible
    std::vector<std::optional<ExactMap>> maps_;
};

} // namespace

std::vector<CheckedMeshes> check(std::span<const TriangleMesh> meshes, const CheckOptions& options) {
    const auto count = kept_as<std::uint32_t>(meshes.size());
    Meshes checked(meshes, options);
    std::vector<CheckedMeshes> found;
    const double total = 0.5 * count * (count + 1.0);
    double done = 0;
    const auto report = [&] {
        if (options.progress) options.progress(done / total);
    };
    if (total > 0) report();
    for (std::uint32_t a = 0; a < count; ++a)
        for (std::uint32_t b = a; b < count; ++b) {
            CheckedMeshes pair = checked.check(a, b);
            if (pair.intersect() || pair.a_in_b.vertex_count != 0 || pair.b_in_a.vertex_count != 0)
                found.push_back(std::move(pair));
            ++done;
            report();
        }
    return found;
}

} // namespace echinus
