// What superquadric maps make of meshes: draws the segments of one beside their superquadrics, or measures
// some.
//
//   echinus_superquadrics draw models/horse.3ds --segments 17 -o superquadrics.png
//   echinus_superquadrics measure horse_6k.obj liver.off torus

#include "measure.hpp"
#include "page.hpp"
#include "segments_figure.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>

using namespace echinus;
using namespace echinus::rivals;
namespace fs = std::filesystem;

namespace {

struct Arguments {
    std::vector<fs::path> meshes;
    fs::path target;
    SuperquadricMapOptions map;
    View view;
    RenderOptions picture;
};

/// A file, mended; or the paper's torus by its name.
TriangleMesh mesh_of(const fs::path& path) {
    if (path == "torus") return make_torus(1, 0.4, 60, 24);
    return repair(read_mesh(path), RepairOptions::all()).mesh;
}

void draw(const Arguments& arguments) {
    const TriangleMesh model = mesh_of(arguments.meshes.front());
    const SuperquadricMap map = SuperquadricMap::build(model, arguments.map);
    fmt::print("{}", describe(map.report()));
    write_png(arguments.target, draw_segments_figure(model, map, arguments.view, arguments.picture));
}

void measure_all(const Arguments& arguments) {
    std::vector<std::vector<std::string>> rows{head_of_measurements()};
    for (const fs::path& path : arguments.meshes) {
        const std::string name = path.stem().string();
        fmt::print(stderr, "{}\n", name);
        try {
            rows.push_back(measure(name, mesh_of(path), arguments.map));
        } catch (const Error& error) {
            rows.push_back({fmt::format("{}: {}", name, error.what())});
            rows.back().resize(rows.front().size());
        }
    }
    fmt::print("{}\n", markdown_table(rows));
}

} // namespace

int main(int argument_count, char** argument_values) {
    CLI::App app{"Superquadric maps in figures"};
    app.require_subcommand(1);
    Arguments arguments;
    arguments.view.up = {0, 1, 0};
    arguments.picture.width = 470;
    arguments.picture.height = 440;
    arguments.picture.samples = 64;
    CLI::App& draws = *app.add_subcommand("draw", "Draws a mesh, its segments and their superquadrics");
    CLI::App& measures = *app.add_subcommand("measure", "Prints a table, a row for each mesh");
    for (CLI::App* command : {&draws, &measures}) {
        command->add_option("MESHES", arguments.meshes, "Mesh files, or torus")->required();
        command->add_option("--segments", arguments.map.segment_count, "0: by concavity")
            ->capture_default_str();
        command
            ->add_option("--face-limit", arguments.map.decomposition_face_limit,
                         "Larger meshes are simplified for the decomposition")
            ->capture_default_str();
    }
    draws.add_option("-o,--output", arguments.target, "A PNG file")->required();
    draws.add_option("--azimuth", arguments.view.azimuth_deg)->capture_default_str();
    draws.add_option("--elevation", arguments.view.elevation_deg)->capture_default_str();
    draws.add_option("--samples", arguments.picture.samples, "Rays per pixel")->capture_default_str();
    CLI11_PARSE(app, argument_count, argument_values);
    try {
        if (draws.parsed())
            draw(arguments);
        else
            measure_all(arguments);
    } catch (const Error& error) {
        fmt::print(stderr, "echinus_superquadrics: {}\n", error.what());
        return 1;
    }
    return 0;
}
