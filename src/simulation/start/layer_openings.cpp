#include "simulation/start/layer_openings.hpp"

#include "simulation/start/intersection_curves.hpp"
#include "simulation/start/thresholds.hpp"

#include <echinus/intersections.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace echinus {

namespace {

/// An edge that passes through a face.
class CrossingGeometry {
  public:
    CrossingGeometry(const Elements& elements, std::span<const Vec3f> positions, const Crossing& crossing)
        : elements_(elements), positions_(positions), edge_(elements.edges[crossing.edge]),
          face_(elements.all[crossing.face]), normal_(normal_of(face_)) {
        const double of_p = height(edge_[0]), of_q = height(edge_[1]);
        if (of_p != of_q) share_ = std::clamp(of_p / (of_p - of_q), 0.0, 1.0);
        point_ = at(edge_[0]) * (1 - share_) + at(edge_[1]) * share_;
        find_face_weights();
    }

    /// The face's normal, towards one end of the edge.
    Vec3d towards(std::uint32_t end) const {
        const std::uint32_t other = edge_[0] == end ? edge_[1] : edge_[0];
        return height(end) < height(other) ? -normal_ : normal_;
    }
    /// The distance of a vertex from the plane of the face.
    double distance(std::uint32_t vertex) const { return std::abs(height(vertex)); }

    /// The displacement of the edge, for a face that stays, for which the curve of intersection becomes
    /// shorter, per unit of displacement.
    Vec3d shortening() const {
        const auto& [p, q] = edge_;
        const Vec3d along = unit_or_zero(at(q) - at(p));
        const double cosine = dot(along, normal_);
        const double bounded = std::copysign(std::max(std::abs(cosine), threshold::kLeastCosine), cosine);
        Vec3d gradient;
        for (const std::uint32_t number : elements_.at(p)) {
            const Element& side = elements_.all[number];
            if (!side.is_face() || !side.has(q)) continue;
            const Vec3d curve = into(side, along);
            gradient += curve - normal_ * (dot(along, curve) / bounded);
        }
        return gradient;
    }

    /// The opening that moves the edge relative to the face, both at the point where they cross.
    Opening opening(const Vec3d& direction, double distance) const {
        Opening opening{{edge_[0], edge_[1]}, {1 - share_, share_}, direction, 0, 0};
        double now = dot(direction, point_);
        for (std::size_t k = 0; k < 3; ++k) {
            opening.particles[2 + k] = face_.vertices[k];
            opening.weights[2 + k] = -face_weights_[k];
            now -= face_weights_[k] * dot(direction, at(face_.vertices[k]));
        }
        opening.least = now + distance;
        return opening;
    }

  private:
    Vec3d at(std::uint32_t vertex) const { return Vec3d(positions_[vertex]); }
    double height(std::uint32_t vertex) const { return dot(normal_, at(vertex) - at(face_.vertices[0])); }
    Vec3d normal_of(const Element& face) const {
        const auto& [a, b, c] = face.vertices;
        return unit_or_zero(cross(at(b) - at(a), at(c) - at(a)));
    }

    /// The direction of the curve in a face at the edge, away from the edge.
    Vec3d into(const Element& side, const Vec3d& along) const {
        const Vec3d curve = unit_or_zero(cross(normal_of(side), normal_));
        for (const std::uint32_t corner : side.vertices) {
            if (corner == edge_[0] || corner == edge_[1]) continue;
            const Vec3d to_corner = at(corner) - at(edge_[0]);
            if (dot(curve, to_corner - along * dot(along, to_corner)) < 0) return -curve;
        }
        return curve;
    }

    void find_face_weights() {
        const auto& [a, b, c] = face_.vertices;
        const Vec3d across = cross(at(b) - at(a), at(c) - at(a));
        const double size_sq = dot(across, across);
        if (!(size_sq > 0)) return;
        const double of_b = std::clamp(dot(cross(point_ - at(a), at(c) - at(a)), across) / size_sq, 0.0, 1.0);
        const double of_c =
            std::clamp(dot(cross(at(b) - at(a), point_ - at(a)), across) / size_sq, 0.0, 1 - of_b);
        face_weights_ = {1 - of_b - of_c, of_b, of_c};
    }

    const Elements& elements_;
    std::span<const Vec3f> positions_;
    Edge edge_;
    const Element& face_;
    Vec3d normal_, point_;
    double share_ = 0.5; ///< of the edge, at which it crosses the face
    std::array<double, 3> face_weights_{1.0 / 3, 1.0 / 3, 1.0 / 3};
};

} // namespace

std::size_t add_layer_openings(const Elements& elements, std::span<const Vec3f> positions, float gap,
                               float edge_length, std::vector<Opening>& openings) {
    const std::vector<FacePair> pairs = self_intersecting_pairs(surface_of(elements, positions));
    const double stride = double{threshold::kStride} * double{edge_length};
    CutPieces pieces(elements);
    for (const std::vector<Crossing>& curve : intersection_curves(elements, positions, pairs)) {
        pieces.cut(curve);
        for (const Crossing& crossing : curve) {
            const CrossingGeometry geometry(elements, positions, crossing);
            const auto& [p, q] = elements.edges[crossing.edge];
            const std::size_t of_p = pieces.size_at(p), of_q = pieces.size_at(q);
            if (of_p == of_q) {
                const Vec3d shortening = geometry.shortening();
                const double size = length(shortening);
                if (size < threshold::kLeastGradient) continue;
                openings.push_back(geometry.opening(shortening * (1 / size), stride * std::min(size, 1.0)));
            } else {
                const auto& [from, to] = of_p < of_q ? Edge{p, q} : Edge{q, p};
                openings.push_back(geometry.opening(geometry.towards(to),
                                                    std::min(geometry.distance(from) + double{gap}, stride)));
            }
        }
    }
    return pairs.size();
}

} // namespace echinus
