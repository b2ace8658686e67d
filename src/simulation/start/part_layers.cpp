#include "simulation/start/part_layers.hpp"

#include "geometry/union_find.hpp"
#include "simulation/start/best_places.hpp"
#include "simulation/start/progress.hpp"

#include <echinus/intersections.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace echinus {

namespace {

constexpr int kMostLayerRounds = 200;
constexpr int kLayerPatience = 12;

/// An edge that passes through a face.
struct Crossing {
    std::uint32_t edge, face;

    friend auto operator<=>(const Crossing&, const Crossing&) = default;
};

/// A particle that moves to the other side of a face.
struct Step {
    std::size_t piece_size; ///< of the particle; if nothing is cut off, the number of all particles
    std::uint32_t particle, face;
    bool to_front;
};

/// The side of the other layer to which a layer moves if neither is cut off.
enum class Side { Front, Back, Nearer };

class LayerAttempt {
  public:
    LayerAttempt(const Elements& elements, const std::vector<float>& inverse_masses, float gap,
                 bool face_moves, const std::vector<Vec3f>& start, Side side)
        : elements_(elements), inverse_masses_(inverse_masses), positions_(start), gap_(gap),
          face_moves_(face_moves), side_(side) {}

    void go(BestPlaces& best) {
        Progress progress(kLayerPatience);
        for (int round = 0; round < kMostLayerRounds; ++round) {
            const std::vector<FacePair> pairs = self_intersecting_pairs(mesh());
            best.consider(positions_, pairs.size());
            if (pairs.empty() || !progress.goes_on(pairs.size())) return;
            if (!take(steps_for(crossings_of(pairs), pairs))) return;
        }
    }
    bool chose_a_side() const { return chose_a_side_; }

  private:
    TriangleMesh mesh() const {
        TriangleMesh mesh{positions_, {}};
        for (const Element& element : elements_.all) mesh.faces.push_back(element.vertices);
        return mesh;
    }

    std::vector<Crossing> crossings_of(const std::vector<FacePair>& pairs) const {
        std::vector<Crossing> crossings;
        for (const auto& [a, b] : pairs) {
            add_crossings(a, b, crossings);
            add_crossings(b, a, crossings);
        }
        std::sort(crossings.begin(), crossings.end());
        crossings.erase(std::unique(crossings.begin(), crossings.end()), crossings.end());
        return crossings;
    }

    void add_crossings(std::uint32_t of, std::uint32_t face, std::vector<Crossing>& crossings) const {
        const Element& element = elements_.all[of];
        const Element& other = elements_.all[face];
        if (!other.is_face()) return;
        const std::size_t edge_count = element.is_face() ? 3 : element.vertex_count - 1U;
        for (std::size_t k = 0; k < edge_count; ++k) {
            const auto& [p, q] = elements_.edges[element.edges[k]];
            if (other.has(p) || other.has(q)) continue;
            const auto& [a, b, c] = other.vertices;
            if (triangles_intersect({positions_[p], positions_[q], positions_[q]},
                                    {positions_[a], positions_[b], positions_[c]}))
                crossings.push_back({element.edges[k], face});
        }
    }

    /// The steps of the smallest pieces come first.
    std::vector<Step> steps_for(const std::vector<Crossing>& crossings, const std::vector<FacePair>& pairs) {
        std::vector<bool> cut(elements_.edges.size(), false);
        for (const Crossing& crossing : crossings) cut[crossing.edge] = true;
        UnionFind pieces(positions_.size());
        for (std::size_t e = 0; e < elements_.edges.size(); ++e)
            if (!cut[e]) pieces.join(elements_.edges[e][0], elements_.edges[e][1]);
        std::vector<std::size_t> sizes(positions_.size());
        for (std::uint32_t v = 0; v < positions_.size(); ++v) ++sizes[pieces.find(v)];
        UnionFind layers = layers_of(pairs);
        std::vector<Step> steps;
        for (const auto& [edge, face] : crossings) {
            const auto& [p, q] = elements_.edges[edge];
            const std::pair p_piece{sizes[pieces.find(p)], pieces.find(p)};
            const std::pair q_piece{sizes[pieces.find(q)], pieces.find(q)};
            if (p_piece != q_piece) {
                const auto& [from, to] = p_piece < q_piece ? std::pair{p, q} : std::pair{q, p};
                steps.push_back({std::min(p_piece, q_piece).first, from, face, height(to, face) >= 0});
                continue;
            }
            if (layers.find(p) > layers.find(elements_.all[face].vertices[0])) continue;
            chose_a_side_ = true;
            const bool p_in_front = height(p, face) > height(q, face);
            const bool p_is_nearer = std::fabs(height(p, face)) < std::fabs(height(q, face));
            const bool to_front = side_ == Side::Nearer ? p_is_nearer != p_in_front : side_ == Side::Front;
            steps.push_back({positions_.size(), p_in_front == to_front ? q : p, face, to_front});
        }
        std::stable_sort(steps.begin(), steps.end(),
                         [](const Step& a, const Step& b) { return a.piece_size < b.piece_size; });
        return steps;
    }

    /// The connected groups of intersecting elements.
    UnionFind layers_of(const std::vector<FacePair>& pairs) const {
        UnionFind layers(positions_.size());
        for (const auto& pair : pairs)
            for (const std::uint32_t e : {pair.a, pair.b})
                for (const std::uint32_t v : elements_.all[e].vertices)
                    layers.join(elements_.all[e].vertices[0], v);
        return layers;
    }

    Vec3f normal_of(std::uint32_t face) const {
        const auto& [a, b, c] = elements_.all[face].vertices;
        const Vec3f normal = cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
        const float size = length(normal);
        return size > 0 ? normal * (1 / size) : Vec3f{};
    }
    float height(std::uint32_t particle, std::uint32_t face) const {
        return dot(positions_[particle] - positions_[elements_.all[face].vertices[0]], normal_of(face));
    }

    /// Of two particles or faces that pass through each other, only the first moves in a round.
    /// @return whether a particle was moved
    bool take(const std::vector<Step>& steps) {
        const auto pinned = [&](std::uint32_t v) { return inverse_masses_[v] == 0; };
        std::vector<Vec3f> ways(positions_.size());
        std::vector<bool> gives_way(positions_.size(), false), is_passed(positions_.size(), false);
        for (const Step& step : steps) {
            const auto& corners = elements_.all[step.face].vertices;
            if (is_passed[step.particle] ||
                std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return gives_way[v]; }))
                continue;
            const Vec3f normal = normal_of(step.face) * (step.to_front ? 1.0F : -1.0F);
            const float below = -height(step.particle, step.face) * (step.to_front ? 1.0F : -1.0F);
            const Vec3f way = normal * (std::max(below, 0.0F) + gap_);
            gives_way[step.particle] = true;
            for (const std::uint32_t v : corners) is_passed[v] = true;
            const bool face_is_pinned = std::all_of(corners.begin(), corners.end(), pinned);
            if (pinned(step.particle) || (face_moves_ && !face_is_pinned)) {
                for (const std::uint32_t v : corners)
                    if (!pinned(v)) keep_longer(-way, ways[v]);
            } else {
                keep_longer(way, ways[step.particle]);
            }
        }
        bool moved = false;
        for (std::size_t v = 0; v < positions_.size(); ++v) {
            moved = moved || ways[v] != Vec3f{};
            positions_[v] += ways[v];
        }
        return moved;
    }

    static void keep_longer(const Vec3f& way, Vec3f& kept) {
        if (dot(way, way) > dot(kept, kept)) kept = way;
    }

    const Elements& elements_;
    const std::vector<float>& inverse_masses_;
    std::vector<Vec3f> positions_;
    float gap_;
    bool face_moves_;
    Side side_;
    bool chose_a_side_ = false;
};

} // namespace

bool part_layers(const Elements& elements, const std::vector<float>& inverse_masses, float gap,
                 bool face_moves, std::vector<Vec3f>& positions) {
    BestPlaces best(elements, positions);
    for (const Side side : {Side::Front, Side::Back, Side::Nearer}) {
        LayerAttempt attempt(elements, inverse_masses, gap, face_moves, positions, side);
        attempt.go(best);
        if (best.pair_count() == 0 && !attempt.chose_a_side()) break;
    }
    if (best.get() == positions) return false;
    positions = best.get();
    return true;
}

} // namespace echinus
