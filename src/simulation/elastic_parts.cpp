#include "simulation/elastic_parts.hpp"

#include "simulation/deformables/closed_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace echinus {

namespace {

class Weigher {
  public:
    Weigher(const Deformable& deformable, const ClothMaterial& material)
        : deformable_(deformable), material_(material), is_body_(deformable.particle_count()) {
        const std::vector<Vec3f>& rest =
            deformable.rest_positions.empty() ? deformable.positions : deformable.rest_positions;
        for (const Vec3f& place : rest) parts_.rest_places.emplace_back(place);
        parts_.masses.assign(deformable.particle_count(), 0);
        parts_.tetrahedra = deformable.tetrahedra;
        for (const ElasticTetrahedron& tetrahedron : deformable.tetrahedra)
            for (const std::uint32_t particle : tetrahedron.particles) is_body_[particle] = true;
    }

    ElasticParts weigh() {
        for (const Triangle& face : deformable_.faces)
            if (!is_body_face(face)) add_face(face);
        add_hinges();
        add_threads();
        weigh_bodies();
        return std::move(parts_);
    }

  private:
    bool is_body_face(const Triangle& face) const {
        return is_body_[face[0]] && is_body_[face[1]] && is_body_[face[2]];
    }
    Vec3d rest(std::uint32_t particle) const { return parts_.rest_places[particle]; }

    void add_face(const Triangle& face) {
        const Vec3d to_b = rest(face[1]) - rest(face[0]), to_c = rest(face[2]) - rest(face[0]);
        const Vec3d across = cross(to_b, to_c);
        const double twice_area = length(across);
        if (!(twice_area > 0)) return; // a face without area has no mass and no direction
        const Vec3d normal = across * (1 / twice_area);
        // Another axis is used for a face that is nearly perpendicular to the x axis.
        constexpr double kAlong = 0.1;
        Vec3d warp = Vec3d{1, 0, 0} - normal * normal.x;
        if (length(warp) < kAlong) warp = Vec3d{0, 1, 0} - normal * normal.y;
        warp *= 1 / length(warp);
        const Vec3d weft = cross(normal, warp);
        ElasticTriangle triangle{};
        triangle.particles = face;
        set_rest_shape(triangle,
                       {{{0, 0}, {dot(to_b, warp), dot(to_b, weft)}, {dot(to_c, warp), dot(to_c, weft)}}});
        triangle.warp_stiffness = triangle.weft_stiffness = static_cast<float>(material_.stretch_stiffness);
        triangle.shear_stiffness = static_cast<float>(material_.shear_stiffness);
        triangle.damping = static_cast<float>(material_.damping);
        parts_.triangles.push_back(triangle);
        for (const std::uint32_t corner : face) parts_.masses[corner] += material_.density * twice_area / 6;
    }

    /// Adds a hinge at each edge of exactly two faces of cloth.
    void add_hinges() {
        struct Sides {
            std::array<std::uint32_t, 2> opposite{};
            std::uint32_t a = 0, count = 0;
        };
        std::map<std::array<std::uint32_t, 2>, Sides> edges;
        for (const ElasticTriangle& triangle : parts_.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = triangle.particles[k], b = triangle.particles[(k + 1) % 3];
                Sides& sides = edges[{std::min(a, b), std::max(a, b)}];
                if (sides.count == 0) sides.a = a;
                if (sides.count < 2) sides.opposite[sides.count] = triangle.particles[(k + 2) % 3];
                ++sides.count;
            }
        for (const auto& [ends, sides] : edges) {
            edge_lengths_ += length(rest(ends[1]) - rest(ends[0]));
            if (sides.count != 2) continue;
            ElasticHinge hinge{};
            hinge.particles = {sides.a, sides.a == ends[0] ? ends[1] : ends[0], sides.opposite[0],
                               sides.opposite[1]};
            hinge.damping = static_cast<float>(material_.damping);
            std::array<Vec3d, 4> places;
            for (std::size_t k = 0; k < 4; ++k) places[k] = rest(hinge.particles[k]);
            hinge.rest_angle = static_cast<float>(fold_angle(places));
            set_rest_shape(hinge, places, material_.bending_stiffness);
            parts_.hinges.push_back(hinge);
        }
        edge_count_ = edges.size();
        for (const auto& [ends, sides] : edges) edges_.push_back(ends);
    }

    /// Adds threads: structural constraints that are not edges of faces. They weigh as much as strips of
    /// cloth.
    void add_threads() {
        double sum = edge_lengths_;
        std::size_t count = edge_count_;
        std::vector<DistanceConstraint> threads;
        for (const DistanceConstraint& constraint : deformable_.constraints) {
            if (constraint.kind != ConstraintKind::Structural || !(constraint.rest_length > 0)) continue;
            const std::array<std::uint32_t, 2> ends{std::min(constraint.a, constraint.b),
                                                    std::max(constraint.a, constraint.b)};
            if (std::binary_search(edges_.begin(), edges_.end(), ends)) continue;
            threads.push_back(constraint);
            sum += double{constraint.rest_length};
            ++count;
        }
        const double width = count > 0 ? sum / static_cast<double>(count) : 0;
        for (const DistanceConstraint& thread : threads) {
            const double rest_length = double{thread.rest_length};
            parts_.springs.push_back({thread.a, thread.b, thread.rest_length,
                                      static_cast<float>(material_.stretch_stiffness * width / rest_length),
                                      static_cast<float>(material_.damping)});
            for (const std::uint32_t end : {thread.a, thread.b})
                parts_.masses[end] += material_.density * width * rest_length / 2;
        }
    }

    /// The particles of bodies have their masses from the deformable; those that are held or belong to
    /// nothing may have any mass.
    void weigh_bodies() {
        double sum = 0;
        for (std::size_t i = 0; i < parts_.masses.size(); ++i) {
            const float inverse_mass = deformable_.inverse_masses[i];
            if (is_body_[i] && inverse_mass > 0) parts_.masses[i] += 1 / double{inverse_mass};
            sum += parts_.masses[i];
        }
        const double usual = sum > 0 ? sum / static_cast<double>(parts_.masses.size()) : 1;
        for (double& mass : parts_.masses)
            if (!(mass > 0)) mass = usual;
    }

    const Deformable& deformable_;
    const ClothMaterial& material_;
    std::vector<bool> is_body_;
    std::vector<std::array<std::uint32_t, 2>> edges_; ///< of cloth, ascending
    double edge_lengths_ = 0;
    std::size_t edge_count_ = 0;
    ElasticParts parts_;
};

} // namespace

ElasticParts elastic_parts(const Deformable& deformable, const SimulationOptions& options) {
    ElasticParts parts = Weigher(deformable, options.newton().material).weigh();
    if (options.newton().pressure > 0)
        for (const Triangle& face : closed_pieces(deformable))
            parts.pressed.push_back({face, options.newton().pressure});
    return parts;
}

} // namespace echinus
