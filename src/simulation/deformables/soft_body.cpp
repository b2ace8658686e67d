#include "mesh/local_frame.hpp"
#include "simulation/start/validation.hpp"

#include <echinus/soft_body.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

namespace echinus {

namespace {

void require_possible(const TetrahedralMesh& mesh, const SoftBodyOptions& options) {
    require_no_origin(mesh.origin, "the soft body");
    require_ranges(options);
    require_valid(options.pose, "the soft body");
    const std::size_t count = mesh.vertices.size();
    const auto require_vertex = [&](std::uint32_t vertex, const char* what) {
        require_option(vertex < count, std::string(what) + " of the soft body refers to vertex " +
                                           std::to_string(vertex) + ", but it has only " +
                                           std::to_string(count) + ", numbered from 0");
    };
    for (const std::uint32_t pin : options.pins) require_vertex(pin, "a pin");
    const std::set<std::uint32_t> pinned(options.pins.begin(), options.pins.end());
    for (const Attachment& attachment : options.attachments) {
        require_vertex(attachment.particle, "an attachment");
        require_option(!pinned.contains(attachment.particle),
                       "vertex " + std::to_string(attachment.particle) +
                           " of the soft body is both pinned, which keeps it in place, and attached, which "
                           "moves it");
    }
}

/// @pre the mesh is valid
class Moulder {
  public:
    Moulder(const TetrahedralMesh& mesh, const SoftBodyOptions& options)
        : mesh_(mesh), options_(options), masses_(mesh.vertices.size(), 0) {}

    Deformable mould() {
        body_.faces = boundary(mesh_).faces;
        place_particles();
        for (std::size_t i = 0; i < mesh_.tetrahedra.size(); ++i) add_tetrahedron(i);
        weigh_particles();
        return std::move(body_);
    }

  private:
    Vec3d rest(std::uint32_t vertex) const { return Vec3d(mesh_.vertices[vertex]) * options_.scale; }

    void place_particles() {
        for (std::uint32_t i = 0; i < mesh_.vertices.size(); ++i) {
            body_.positions.emplace_back(options_.pose.to_world(rest(i)));
            if (!is_finite(body_.positions.back()))
                refuse_mesh("vertex " + std::to_string(i) +
                            " of the soft body has a position that is not finite");
        }
    }

    void add_tetrahedron(std::size_t number) {
        const auto& [a, b, c, d] = mesh_.tetrahedra[number];
        const Vec3d to_b = rest(b) - rest(a), to_c = rest(c) - rest(a), to_d = rest(d) - rest(a);
        const Vec3d at_b = cross(to_c, to_d), at_c = cross(to_d, to_b), at_d = cross(to_b, to_c);
        const double six_volumes = dot(to_b, at_b);
        const auto volume = static_cast<float>(six_volumes / 6);
        if (!(volume > 0))
            refuse_mesh("tetrahedron " + std::to_string(number) +
                        " of the soft body has next to no volume; remove it, or scale the body up");
        const double share = 1 / six_volumes;
        const double young = options_.young_modulus, poisson = options_.poisson_ratio;
        body_.tetrahedra.push_back(
            {.particles = {a, b, c, d},
             .gradients = {Vec3f(at_b * share), Vec3f(at_c * share), Vec3f(at_d * share)},
             .volume = volume,
             .mu = static_cast<float>(young / (2 * (1 + poisson))),
             .lambda = static_cast<float>(young * poisson / ((1 + poisson) * (1 - 2 * poisson))),
             .damping = static_cast<float>(options_.damping)});
        for (const std::uint32_t corner : {a, b, c, d})
            masses_[corner] += options_.density * six_volumes / 24;
    }

    void weigh_particles() {
        for (std::size_t i = 0; i < masses_.size(); ++i) {
            const auto inverse_mass = static_cast<float>(1 / masses_[i]);
            if (!std::isfinite(inverse_mass))
                refuse_mesh("vertex " + std::to_string(i) +
                            " of the soft body belongs to no tetrahedron, or "
                            "only to tetrahedra of next to no volume; remove "
                            "it");
            body_.inverse_masses.push_back(inverse_mass);
        }
        for (const std::uint32_t pin : options_.pins) body_.inverse_masses[pin] = 0;
        for (const Attachment& attachment : options_.attachments)
            body_.inverse_masses[attachment.particle] = 0;
        body_.attachments = options_.attachments;
    }

    const TetrahedralMesh& mesh_;
    const SoftBodyOptions& options_;
    std::vector<double> masses_;
    Deformable body_;
};

} // namespace

Deformable make_soft_body(const TetrahedralMesh& mesh, const SoftBodyOptions& options) {
    require_possible(mesh, options);
    require_valid_tetrahedra(mesh);
    return Moulder(mesh, options).mould();
}

} // namespace echinus
