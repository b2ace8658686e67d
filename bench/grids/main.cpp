// The grids of a distance map at equal bytes, and around which centre: prints the table of
// docs/distance_map.md for a torus and for the meshes that are given.

#include "rivals/compare/point_sets.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/mesh_io.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

using namespace echinus;

namespace {

constexpr std::size_t kPointCount = 500'000;

struct System {
    std::string name;
    DistanceMap map;
};

/// The finest map of a kind that takes no more than so many bytes.
System finest_within(std::size_t budget, const TriangleMesh& mesh, const std::string& kind,
                     DistanceMapOptions options) {
    const auto build = [&](std::uint32_t resolution) {
        options.longitude_count = options.colatitude_count = options.divisions = resolution;
        return DistanceMap::build(mesh, options);
    };
    std::uint32_t fits = 32, too_fine = 512;
    while (too_fine - fits > 1) {
        const std::uint32_t middle = (fits + too_fine) / 2;
        const DistanceMap map = build(middle);
        (map.view().byte_count() <= budget ? fits : too_fine) = middle;
    }
    return {kind + ", " + std::to_string(fits), build(fits)};
}

/// Spherical 200 x 200 about each axis, and of all else the finest that takes no more bytes than about z.
std::vector<System> systems(const TriangleMesh& mesh) {
    constexpr std::pair<const char*, PoleAxis> kAxes[] = {
        {"x", PoleAxis::X}, {"y", PoleAxis::Y}, {"z", PoleAxis::Z}};
    const DistanceMapOptions plain{.correction = VertexCorrection::None};
    std::vector<System> result;
    for (const auto& [name, axis] : kAxes) {
        DistanceMapOptions options = plain;
        options.pole_axis = axis;
        result.push_back({std::string("spherical, poles on ") + name, DistanceMap::build(mesh, options)});
    }
    const std::size_t budget = result.back().map.view().byte_count();
    const auto add = [&](const std::string& kind, DirectionGrid grid, PoleAxis axis, CentreChoice centre) {
        DistanceMapOptions options = plain;
        options.grid = grid;
        options.pole_axis = axis;
        options.centre = centre;
        result.push_back(finest_within(budget, mesh, kind, options));
    };
    constexpr CentreChoice kSphere = CentreChoice::BoundingSphere, kSearch = CentreChoice::Search;
    add("octahedral", DirectionGrid::Octahedral, PoleAxis::Z, kSphere);
    add("cube", DirectionGrid::Cube, PoleAxis::Z, kSphere);
    for (const auto& [name, axis] : kAxes)
        add(std::string("ellipsoidal, poles on ") + name, DirectionGrid::Ellipsoidal, axis, kSphere);
    add("spherical, poles on z, searched centre", DirectionGrid::Spherical, PoleAxis::Z, kSearch);
    add("octahedral, searched centre", DirectionGrid::Octahedral, PoleAxis::Z, kSearch);
    add("cube, searched centre", DirectionGrid::Cube, PoleAxis::Z, kSearch);
    add("ellipsoidal, poles on z, searched centre", DirectionGrid::Ellipsoidal, PoleAxis::Z, kSearch);
    return result;
}

/// Points and what is true of them, by the exact map.
struct Truth {
    std::vector<Vec3f> points;
    std::vector<Contact> contacts;

    Truth(const ExactMap& judge, std::vector<Vec3f> points_)
        : points(std::move(points_)), contacts(points.size()) {
        contacts_batch(judge, points, 0, contacts);
    }
};

double wrong_percent(const DistanceMap& map, const Truth& truth) {
    std::vector<std::uint8_t> inside(truth.points.size());
    contains_batch(map, truth.points, inside);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < inside.size(); ++i)
        wrong += (inside[i] != 0) != truth.contacts[i].inside ? 1 : 0;
    return 100.0 * static_cast<double>(wrong) / static_cast<double>(inside.size());
}

/// How far the way out ends from the surface, over R, in percent, of the particles that are inside and that
/// the map knows to be: ascending.
std::vector<float> surface_errors(const DistanceMap& map, const ExactMap& judge, const Truth& truth) {
    std::vector<Contact> contacts(truth.points.size());
    contacts_batch(map, truth.points, 0, contacts);
    std::vector<Vec3f> ends;
    for (std::size_t i = 0; i < contacts.size(); ++i)
        if (contacts[i].inside && truth.contacts[i].inside) ends.push_back(contacts[i].point);
    std::vector<Contact> nearest(ends.size());
    contacts_batch(judge, ends, map.view().radius, nearest);
    std::vector<float> errors;
    for (const Contact& contact : nearest)
        errors.push_back(100 * std::fabs(contact.depth) / map.view().radius);
    std::sort(errors.begin(), errors.end());
    return errors;
}

void measure(const std::string& name, const TriangleMesh& mesh) {
    const ExactMap judge = ExactMap::build(mesh);
    const Truth everywhere(judge, comparison::uniform_points(mesh, kPointCount));
    const Truth near(judge, comparison::surface_points(mesh, kPointCount));
    for (const auto& [kind, map] : systems(mesh)) {
        const std::vector<float> errors = surface_errors(map, judge, near);
        double sum = 0;
        for (const float error : errors) sum += static_cast<double>(error);
        std::printf("| %s | %s | %zu | %.3f | %.2f | %.4f | %.3f |\n", name.c_str(), kind.c_str(),
                    map.view().byte_count(), wrong_percent(map, everywhere), wrong_percent(map, near),
                    sum / static_cast<double>(errors.size()),
                    static_cast<double>(errors[errors.size() * 99 / 100]));
    }
}

} // namespace

int main(int argument_count, char** arguments) {
    try {
        std::printf("| mesh | grid | bytes | U wrong %% | S wrong %% | mean error %% R | 99 %% |\n"
                    "|---|---|---|---|---|---|---|\n");
        measure("torus", make_torus(1, 0.4, 60, 24));
        for (int i = 1; i < argument_count; ++i)
            measure(std::filesystem::path(arguments[i]).stem().string(), read_mesh(arguments[i]));
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
