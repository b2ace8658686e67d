// The grids of a distance map at equal bytes: prints the table of docs/distance_map.md for a torus and for
// the meshes that are given.

#include "comparison/point_sets.hpp"

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
    DistanceMapOptions options;
};

/// Spherical 200 x 200 about each axis, and of the other grids as fine a one as takes no more bytes than
/// about z.
std::vector<System> systems(const TriangleMesh& mesh) {
    std::vector<System> result;
    for (const auto& [name, axis] : {std::pair{"x", PoleAxis::X}, {"y", PoleAxis::Y}, {"z", PoleAxis::Z}})
        result.push_back({std::string("spherical, poles on ") + name,
                          {.correction = VertexCorrection::None, .pole_axis = axis}});
    const std::size_t budget = DistanceMap::build(mesh, result.back().options).view().byte_count();
    for (const auto& [name, grid] :
         {std::pair{"octahedral ", DirectionGrid::Octahedral}, {"cube ", DirectionGrid::Cube}}) {
        DistanceMapOptions options{.grid = grid, .divisions = 130, .correction = VertexCorrection::None};
        while (DistanceMap::build(mesh, options).view().byte_count() > budget) --options.divisions;
        result.push_back({name + std::to_string(options.divisions), options});
    }
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
    for (const System& system : systems(mesh)) {
        const DistanceMap map = DistanceMap::build(mesh, system.options);
        const std::vector<float> errors = surface_errors(map, judge, near);
        double sum = 0;
        for (const float error : errors) sum += static_cast<double>(error);
        std::printf("| %s | %s | %zu | %.3f | %.2f | %.4f | %.3f |\n", name.c_str(), system.name.c_str(),
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
