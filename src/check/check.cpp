#include "geometry/box.hpp"
#include "geometry/whole_numbers.hpp"
#include "mesh/require_valid.hpp"

#include <echinus/check.hpp>
#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace echinus {

namespace {

/// The meshes with what is computed once for each.
class Meshes {
  public:
    Meshes(std::span<const TriangleMesh> meshes, unsigned thread_count)
        : meshes_(meshes), thread_count_(thread_count), boxes_(meshes.size()), is_mapped_(meshes.size()),
          maps_(meshes.size()) {
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
        if (a == b) {
            pair.found = self_intersections(meshes_[a]);
        } else if (boxes_[a].overlaps(boxes_[b])) {
            pair.found = intersections(meshes_[a], meshes_[b]);
            pair.a_in_b = penetration(a, b);
            pair.b_in_a = penetration(b, a);
        }
        return pair;
    }

  private:
    void require_valid(std::size_t mesh) const {
        try {
            echinus::require_valid(meshes_[mesh]);
            if (meshes_[mesh].origin != meshes_[0].origin)
                throw Error(ErrorCode::InvalidMesh, "the origin is not that of the first mesh; move the "
                                                    "vertices to its frame first");
        } catch (const Error& error) {
            throw Error(error.code(), "mesh " + std::to_string(mesh) + ": " + error.what());
        }
    }

    /// Of a closed mesh. Null also for shapes that no map holds, such as tiny parts that are far apart: what
    /// intersects is known nevertheless.
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
        const UsedVertices used(meshes_[mesh].faces, points.size());
        std::vector<Contact> contacts(points.size());
        contacts_batch(*map, points, 0, contacts, thread_count_);
        Penetration found{.known = true};
        for (std::uint32_t i = 0; i < contacts.size(); ++i) {
            if (!contacts[i].inside || !used[i]) continue;
            ++found.vertex_count;
            if (found.deepest_vertex != kNoIndex && contacts[i].depth <= found.depth) continue;
            found.deepest_vertex = i;
            found.depth = contacts[i].depth;
        }
        return found;
    }

    std::span<const TriangleMesh> meshes_;
    unsigned thread_count_;
    std::vector<AlignedBox<float>> boxes_;
    std::vector<bool> is_mapped_; ///< or was found to have no map
    std::vector<std::optional<ExactMap>> maps_;
};

} // namespace

std::vector<CheckedMeshes> check(std::span<const TriangleMesh> meshes, const CheckOptions& options) {
    const auto count = kept_as<std::uint32_t>(meshes.size());
    Meshes checked(meshes, options.thread_count);
    std::vector<CheckedMeshes> found;
    const double total = 0.5 * count * (count + 1.0);
    double done = 0;
    for (std::uint32_t a = 0; a < count; ++a)
        for (std::uint32_t b = a; b < count; ++b) {
            CheckedMeshes pair = checked.check(a, b);
            if (pair.intersect() || pair.a_in_b.vertex_count != 0 || pair.b_in_a.vertex_count != 0)
                found.push_back(std::move(pair));
            if (options.progress) options.progress(++done / total);
        }
    return found;
}

} // namespace echinus
