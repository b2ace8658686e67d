#include "simulation/surfaces/part_layers.hpp"

#include "mesh/union_find.hpp"
#include "simulation/surfaces/best_places.hpp"
#include "simulation/surfaces/progress.hpp"

#include <echinus/intersections.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace echinus {

namespace {

constexpr int kMostRounds = 200;
constexpr int kPatience = 12;

/// An edge that passes through a face.
struct Crossing {
    std::uint32_t edge, face;

    friend auto operator<=>(const Crossing&, const Crossing&) = default;
};

/// A particle that goes to the other side of a face.
struct Step {
    std::size_t piece_size; ///< of the particle; where nothing is cut off, that of everything
    std::uint32_t particle, face;
    bool to_front;
};

class Attempt {
  public:
    Attempt(const Elements& elements, const std::vector<float>& inverse_masses, float gap, bool face_moves,
            const std::vector<Vec3f>& start, bool to_front)
        : positions(start), elements_(elements), inverse_masses_(inverse_masses), gap_(gap),
          face_moves_(face_moves), to_front_(to_front) {}

    void go() {
        Progress progress(kPatience);
        for (int round = 0; round < kMostRounds; ++round) {
            const std::vector<FacePair> pairs = self_intersecting_pairs(mesh());
            left = pairs.size();
            if (left == 0 || !progress.goes_on(left) || !take(steps_for(crossings_of(pairs), pairs))) return;
        }
        left = self_intersecting_pairs(mesh()).size();
    }

    std::vector<Vec3f> positions;
    std::size_t left = 0; ///< pairs that intersect
    bool chose_a_side = false;

  private:
    TriangleMesh mesh() const {
        TriangleMesh mesh{positions, {}};
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
            if (triangles_intersect({positions[p], positions[q], positions[q]},
                                    {positions[a], positions[b], positions[c]}))
                crossings.push_back({element.edges[k], face});
        }
    }

    /// Those of the smallest pieces first.
    std::vector<Step> steps_for(const std::vector<Crossing>& crossings, const std::vector<FacePair>& pairs) {
        std::vector<bool> cut(elements_.edges.size(), false);
        for (const Crossing& crossing : crossings) cut[crossing.edge] = true;
        UnionFind pieces(positions.size());
        for (std::size_t e = 0; e < elements_.edges.size(); ++e)
            if (!cut[e]) pieces.join(elements_.edges[e][0], elements_.edges[e][1]);
        std::vector<std::size_t> sizes(positions.size());
        for (std::uint32_t v = 0; v < positions.size(); ++v) ++sizes[pieces.find(v)];
        UnionFind layers = layers_of(pairs);
        std::vector<Step> steps;
        for (const auto& [edge, face] : crossings) {
            const auto& [p, q] = elements_.edges[edge];
            const std::pair p_piece{sizes[pieces.find(p)], pieces.find(p)};
            const std::pair q_piece{sizes[pieces.find(q)], pieces.find(q)};
            if (p_piece != q_piece) {
                const auto& [from, to] = p_piece < q_piece ? std::pair{p, q} : std::pair{q, p};
                steps.push_back({std::min(p_piece, q_piece).first, from, face, height(to, face) >= 0});
            } else if (layers.find(p) <= layers.find(elements_.all[face].vertices[0])) {
                chose_a_side = true;
                const bool p_in_front = height(p, face) > height(q, face);
                steps.push_back({positions.size(), p_in_front == to_front_ ? q : p, face, to_front_});
            }
        }
        std::stable_sort(steps.begin(), steps.end(),
                         [](const Step& a, const Step& b) { return a.piece_size < b.piece_size; });
        return steps;
    }

    /// What hangs together among the elements that intersect.
    UnionFind layers_of(const std::vector<FacePair>& pairs) const {
        UnionFind layers(positions.size());
        for (const auto& pair : pairs)
            for (const std::uint32_t e : {pair.a, pair.b})
                for (const std::uint32_t v : elements_.all[e].vertices)
                    layers.join(elements_.all[e].vertices[0], v);
        return layers;
    }

    Vec3f normal_of(std::uint32_t face) const {
        const auto& [a, b, c] = elements_.all[face].vertices;
        const Vec3f normal = cross(positions[b] - positions[a], positions[c] - positions[a]);
        const float size = length(normal);
        return size > 0 ? normal * (1 / size) : Vec3f{};
    }
    float height(std::uint32_t particle, std::uint32_t face) const {
        return dot(positions[particle] - positions[elements_.all[face].vertices[0]], normal_of(face));
    }

    /// Of two that pass through each other only the first gives way in a round.
    /// @return whether a particle was moved
    bool take(const std::vector<Step>& steps) {
        const auto pinned = [&](std::uint32_t v) { return inverse_masses_[v] == 0; };
        std::vector<Vec3f> ways(positions.size());
        std::vector<bool> gives_way(positions.size(), false), is_passed(positions.size(), false);
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
        for (std::size_t v = 0; v < positions.size(); ++v) {
            moved = moved || ways[v] != Vec3f{};
            positions[v] += ways[v];
        }
        return moved;
    }

    static void keep_longer(const Vec3f& way, Vec3f& kept) {
        if (dot(way, way) > dot(kept, kept)) kept = way;
    }

    const Elements& elements_;
    const std::vector<float>& inverse_masses_;
    float gap_;
    bool face_moves_, to_front_;
};

} // namespace

bool part_layers(const Elements& elements, const std::vector<float>& inverse_masses, float gap,
                 bool face_moves, std::vector<Vec3f>& positions) {
    BestPlaces best(elements, positions);
    for (const bool to_front : {true, false}) {
        Attempt attempt(elements, inverse_masses, gap, face_moves, positions, to_front);
        attempt.go();
        best.consider(attempt.positions, attempt.left);
        if (!best.moved()) return false;
        if (attempt.left == 0 && !attempt.chose_a_side) break;
    }
    positions = best.get();
    return true;
}

} // namespace echinus
