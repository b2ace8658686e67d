#include "contestants.hpp"

#include "rivals/systems/bullet_mesh/bullet_mesh.hpp"
#include "rivals/systems/classified_grid/classified_grid.hpp"
#include "rivals/systems/dense_grid/dense_grid.hpp"
#include "rivals/systems/embree_tree/embree_tree.hpp"
#include "rivals/systems/maps/maps.hpp"
#include "rivals/systems/sparse_field/sparse_field.hpp"
#include "rivals/systems/superquadric_map/superquadric_map.hpp"

#include <fmt/format.h>

using namespace echinus;
using namespace echinus::rivals;

namespace {

/// What the paper gives for the horse (section 2.3).
constexpr std::size_t kPaperBytes = 630'000;

/// Along a ray the surface is farther than it is; a simulation looks four times as far along those of a
/// distance map, so it does for any system that measures along rays.
constexpr float kAlongRays = 4;

class AskedSystem final : public CustomMap {
  public:
    AskedSystem(std::unique_ptr<const System> system, float margin_factor)
        : system_(std::move(system)), margin_factor_(margin_factor) {}

    void contains_batch(std::span<const Vec3f> points,
                        std::span<std::uint8_t> inside) const noexcept override {
        system_->contains_batch(points, inside);
    }
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const noexcept override {
        system_->contacts_batch(points, margin_factor_ * margin, contacts);
    }

  private:
    std::unique_ptr<const System> system_;
    float margin_factor_;
};

Contestant asked(std::string label, std::string setting, std::unique_ptr<const System> system,
                 float margin_factor = 1) {
    const std::size_t bytes = system->byte_count();
    const auto map = std::make_shared<AskedSystem>(std::move(system), margin_factor);
    return {std::move(label), std::move(setting), bytes, map, map, false};
}

template <typename System>
std::unique_ptr<const System> held(System system) {
    return std::make_unique<System>(std::move(system));
}

/// A map with the simulation's own way of collision, instead of contacts alone.
Contestant as_it_is(Contestant contestant, ColliderMap map) {
    contestant.map = std::move(map);
    return contestant;
}

Contestant distance(std::string label, std::string setting, const DistanceMapOptions& options,
                    const TriangleMesh& mesh) {
    return as_it_is(asked(std::move(label), std::move(setting), distance_map(mesh, options), kAlongRays),
                    DistanceMap::build(mesh, options));
}

/// The poles on the axis that is up, with which the paper's map errs least.
DistanceMapOptions spherical(std::uint32_t side) {
    DistanceMapOptions options;
    options.longitude_count = options.colatitude_count = side;
    options.pole_axis = PoleAxis::Y;
    return options;
}

Contestant dense(const TriangleMesh& mesh, SampleFormat format, double thickness) {
    DenseGridOptions options;
    options.format = format;
    options.padding = thickness;
    DenseGrid grid = DenseGrid::with_bytes(mesh, kPaperBytes, options);
    const bool is_float = format == SampleFormat::Float32;
    const std::string setting =
        fmt::format("{} x {} x {} samples", grid.node_count(0), grid.node_count(1), grid.node_count(2));
    return asked(is_float ? "dense grid, float" : "dense grid, 16 bits", setting, held(std::move(grid)));
}

Contestant openvdb(const TriangleMesh& mesh) {
    SparseField field = SparseField::with_bytes(mesh, kPaperBytes);
    const std::string setting = fmt::format("{} samples along the longest side", field.sample_count());
    return asked("OpenVDB", setting, held(std::move(field)));
}

Contestant superquadrics(const TriangleMesh& mesh) {
    SuperquadricMapOptions options;
    options.segment_count = 17;
    SuperquadricMap map = SuperquadricMap::build(mesh, options);
    const std::string setting = fmt::format("{} segments, {} x {} samples each", map.segment_count(),
                                            map.omega_count(), map.eta_count());
    return asked("superquadric map", setting, held(std::move(map)), kAlongRays);
}

} // namespace

std::vector<Contestant> build_contestants(const TriangleMesh& mesh, double thickness) {
    std::vector<Contestant> all;
    all.push_back(
        as_it_is(asked("exact map", "with sweeps and memory", exact_map(mesh)), ExactMap::build(mesh)));
    all.push_back(asked("exact map, contacts only", "asked like the others", exact_map(mesh)));
    all.push_back(distance("distance map", "200 x 200 directions, the paper's", spherical(200), mesh));
    all.push_back(distance("distance map, larger", "260 x 260 directions", spherical(260), mesh));
    DistanceMapOptions ellipsoidal = spherical(260);
    ellipsoidal.grid = DirectionGrid::Ellipsoidal;
    all.push_back(distance("ellipsoidal map", "260 x 260 directions", ellipsoidal, mesh));
    DistanceMapOptions octahedral;
    octahedral.grid = DirectionGrid::Octahedral;
    octahedral.divisions = 135;
    all.push_back(distance("octahedral map", "135 divisions", octahedral, mesh));
    all.push_back(superquadrics(mesh));
    all.push_back(openvdb(mesh));
    all.push_back(dense(mesh, SampleFormat::Float32, thickness));
    all.push_back(dense(mesh, SampleFormat::Snorm16, thickness));
    all.push_back(
        asked("classified grid", "cells as the bytes allow", held(ClassifiedGrid::build(mesh, kPaperBytes))));
    all.back().only_timed = true; // its answers are the exact map's
    all.push_back(asked("Embree", "parity of a ray, point query", held(EmbreeTree::build(mesh))));
    all.push_back(asked("Bullet", "first hit of a ray, contacts of a sphere", held(BulletMesh::build(mesh))));
    return all;
}
