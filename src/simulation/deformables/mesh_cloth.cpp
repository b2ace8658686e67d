#include "mesh/local_frame.hpp"
#include "simulation/deformables/cloth_surface.hpp"
#include "simulation/start/validation.hpp"

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace echinus {

namespace {

std::string missing_vertex(const std::string& what, std::uint32_t vertex, std::size_t vertex_count) {
    return what + " vertex " + std::to_string(vertex) + ", but the cloth has only " +
           std::to_string(vertex_count) + " vertices, numbered from 0";
}

void require_possible(const TriangleMesh& mesh, const MeshClothOptions& options) {
    require_no_origin(mesh.origin, "the cloth");
    const std::size_t count = mesh.vertices.size();
    if (mesh.faces.empty() && options.threads.empty()) refuse_mesh("the cloth has neither faces nor threads");
    if (!mesh.faces.empty()) require_valid(mesh);
    require_option(options.rest_vertices.empty() || options.rest_vertices.size() == count,
                   "the cloth has " + std::to_string(count) + " vertices, but its rest shape has " +
                       std::to_string(options.rest_vertices.size()) + "; the numbers must be equal");
    require_ranges(options);
    require_valid(options.pose, "the cloth");
    for (const auto& ends : options.threads)
        for (const std::uint32_t end : ends)
            require_option(end < count, missing_vertex("a thread ends at", end, count));
    for (const std::uint32_t pin : options.pins)
        require_option(pin < count, missing_vertex("a pin refers to", pin, count));
    for (const Attachment& attachment : options.attachments)
        require_option(attachment.particle < count,
                       missing_vertex("an attachment refers to", attachment.particle, count));
    const std::set<std::uint32_t> pinned(options.pins.begin(), options.pins.end());
    for (const Attachment& attachment : options.attachments)
        require_option(!pinned.contains(attachment.particle),
                       "vertex " + std::to_string(attachment.particle) +
                           " is both pinned, which keeps it in place, and attached, which moves it");
}

Vec3f placed(const Vec3f& vertex, const MeshClothOptions& options) {
    return Vec3f(options.pose.to_world(Vec3d(vertex) * options.scale));
}

/// Makes a cloth from a mesh. Lengths, areas and angles are those of the rest shape.
class Tailor {
  public:
    Tailor(const TriangleMesh& mesh, const MeshClothOptions& options)
        : mesh_(mesh), options_(options), surface_(surface_of(mesh)),
          rest_(options.rest_vertices.empty() ? mesh.vertices : options.rest_vertices) {
        for (Vec3f& vertex : rest_) vertex = Vec3f(Vec3d(vertex) * options.scale);
    }

    Deformable sew() {
        require_rest_shape();
        place_particles();
        weigh_particles();
        add_constraints();
        cloth_.faces = std::move(surface_.faces);
        return std::move(cloth_);
    }

  private:
    Vec3d between(std::uint32_t a, std::uint32_t b) const { return Vec3d(rest_[b]) - Vec3d(rest_[a]); }
    double distance(std::uint32_t a, std::uint32_t b) const { return length(between(a, b)); }
    double area(const Triangle& face) const {
        return length(cross(between(face[0], face[1]), between(face[0], face[2]))) / 2;
    }

    void require_rest_shape() const {
        for (std::size_t i = 0; i < rest_.size(); ++i)
            if (!is_finite(rest_[i]) || !is_finite(placed(mesh_.vertices[i], options_)))
                refuse_mesh("vertex " + std::to_string(i) +
                            " of the cloth has a position that is not finite");
        for (std::size_t face = 0; face < surface_.faces.size(); ++face)
            if (!(area(surface_.faces[face]) > 0))
                refuse_mesh("face " + std::to_string(face) + " of the cloth has no area; remove it");
        for (const auto& [a, b] : options_.threads)
            if (!(distance(a, b) > 0))
                refuse_mesh("the thread from vertex " + std::to_string(a) + " to " + std::to_string(b) +
                            " has no length; remove it");
    }

    void place_particles() {
        for (const Vec3f& vertex : mesh_.vertices) cloth_.positions.push_back(placed(vertex, options_));
        if (!options_.rest_vertices.empty()) cloth_.rest_positions = rest_;
    }

    double mean_edge_length() const {
        double sum = 0;
        for (const auto& [a, b] : surface_.edges) sum += distance(a, b);
        for (const auto& [a, b] : options_.threads) sum += distance(a, b);
        return sum / static_cast<double>(surface_.edges.size() + options_.threads.size());
    }

    /// Sets the masses by the areas around the particles; pinned particles count as if they were free.
    void weigh_particles() {
        std::vector<double> areas(rest_.size(), 0);
        for (const Triangle& face : surface_.faces)
            for (const std::uint32_t corner : face) areas[corner] += area(face) / 3;
        const double thread_width = mean_edge_length();
        for (const auto& ends : options_.threads)
            for (const std::uint32_t end : ends) areas[end] += distance(ends[0], ends[1]) * thread_width / 2;
        double sum = 0;
        for (const double part : areas) sum += part;
        const double mean = sum / static_cast<double>(areas.size());
        for (std::size_t i = 0; i < areas.size(); ++i) {
            const auto inverse_mass = static_cast<float>(mean / areas[i]);
            if (!std::isfinite(inverse_mass))
                refuse_mesh("vertex " + std::to_string(i) +
                            " of the cloth belongs to no face and no thread, or only to faces of next to no "
                            "area; remove it (weld() drops unused vertices)");
            cloth_.inverse_masses.push_back(inverse_mass);
        }
        for (const std::uint32_t pin : options_.pins) cloth_.inverse_masses[pin] = 0;
        for (const Attachment& attachment : options_.attachments)
            cloth_.inverse_masses[attachment.particle] = 0;
        cloth_.attachments = options_.attachments;
    }

    /// Do the two faces form a quadrilateral with approximately right angles, of which the edge is a
    /// diagonal?
    bool is_diagonal(const Hinge& hinge) const {
        const double diagonal = distance(hinge.a, hinge.b);
        for (const std::uint32_t end : {hinge.a, hinge.b})
            for (const std::uint32_t side : {hinge.c, hinge.d})
                if (distance(end, side) >= diagonal) return false;
        return is_right_angle(hinge.a, hinge.c, hinge.d) && is_right_angle(hinge.b, hinge.c, hinge.d) &&
               is_right_angle(hinge.c, hinge.a, hinge.b) && is_right_angle(hinge.d, hinge.a, hinge.b);
    }
    bool is_right_angle(std::uint32_t at, std::uint32_t one, std::uint32_t other) const {
        constexpr double kCosine = 0.342; // of 70 degrees
        const Vec3d to_one = between(at, one), to_other = between(at, other);
        return std::abs(dot(to_one, to_other)) <= kCosine * length(to_one) * length(to_other);
    }

    void add_constraint(std::uint32_t a, std::uint32_t b, ConstraintKind kind) {
        cloth_.constraints.push_back({a, b, static_cast<float>(distance(a, b)), kind});
    }

    void add_constraints() {
        std::vector<Hinge> diagonals, others;
        for (const Hinge& hinge : surface_.hinges) (is_diagonal(hinge) ? diagonals : others).push_back(hinge);
        std::set<std::array<std::uint32_t, 2>> shear;
        for (const auto& [a, b, c, d] : diagonals) shear.insert({std::min(a, b), std::max(a, b)});
        for (const auto& edge : surface_.edges)
            if (!shear.contains(edge)) add_constraint(edge[0], edge[1], ConstraintKind::Structural);
        for (const auto& [a, b] : options_.threads) add_constraint(a, b, ConstraintKind::Structural);
        for (const auto& [a, b, c, d] : diagonals) {
            add_constraint(a, b, ConstraintKind::Shear);
            add_constraint(c, d, ConstraintKind::Shear);
        }
        for (const auto& [a, b, c, d] : others) add_constraint(c, d, ConstraintKind::Bending);
        stiffen_threads();
    }

    void stiffen_threads() {
        std::vector<std::vector<std::uint32_t>> ends_around(rest_.size());
        for (const auto& [a, b] : options_.threads) {
            ends_around[a].push_back(b);
            ends_around[b].push_back(a);
        }
        for (const auto& ends : ends_around)
            if (ends.size() == 2 && ends[0] != ends[1])
                add_constraint(ends[0], ends[1], ConstraintKind::Bending);
    }

    const TriangleMesh& mesh_;
    const MeshClothOptions& options_;
    ClothSurface surface_;
    std::vector<Vec3f> rest_;
    Deformable cloth_;
};

} // namespace

Deformable make_cloth(const TriangleMesh& mesh, const MeshClothOptions& options) {
    require_possible(mesh, options);
    return Tailor(mesh, options).sew();
}

} // namespace echinus
