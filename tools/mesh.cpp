#include "command.hpp"
#include "grid_argument.hpp"
#include "mesh_io/encode.hpp"
#include "output.hpp"
#include "size_argument.hpp"

#include <echinus/mesh_io.hpp>

#include <memory>
#include <string>

namespace {

using namespace echinus;

void write_result(const std::string& target, const TriangleMesh& mesh) {
    if (target == kStandardStream)
        print(encode_obj(mesh));
    else
        write_mesh(target, mesh);
}

/// A shape's command with what all shapes have in common.
CLI::App* add_shape(CLI::App& mesh, const std::string& name, const std::string& description,
                    const std::string& example, std::string& target) {
    CLI::App* shape = mesh.add_subcommand(name, description);
    shape
        ->add_option("-o,--output", target,
                     "File to write: .obj, .ply, .stl or .off; - for OBJ on standard output")
        ->required();
    shape->footer("Example: echinus mesh " + name + " " + example);
    return shape;
}

struct Torus {
    double major = 1;
    double minor = 0.4;
    GridArgument segments{60, 24};
    std::string target;
};

void add_torus(CLI::App& mesh) {
    auto options = std::make_shared<Torus>();
    CLI::App* torus = add_shape(mesh, "torus", "A torus about the z axis",
                                "--major 1 --minor 0.4 --segments 60x24 -o torus.obj", options->target);
    torus->add_option("--major", options->major, "Radius of the circle in the middle of the tube")
        ->capture_default_str();
    torus->add_option("--minor", options->minor, "Radius of the tube")->capture_default_str();
    torus->add_option("--segments", options->segments, "Segments around the axis x around the tube (60x24)");
    torus->callback([options] {
        write_result(options->target, make_torus(options->major, options->minor, options->segments.first,
                                                 options->segments.second));
    });
}

struct SphereOptions {
    double radius = 1;
    GridArgument segments{60, 30};
    std::string target;
};

void add_sphere(CLI::App& mesh) {
    auto options = std::make_shared<SphereOptions>();
    CLI::App* sphere = add_shape(mesh, "sphere", "A sphere with its poles on the z axis",
                                 "--radius 1 --segments 60x30 -o sphere.ply", options->target);
    sphere->add_option("--radius", options->radius)->capture_default_str();
    sphere->add_option("--segments", options->segments,
                       "Meridians x rows of faces from pole to pole (60x30)");
    sphere->callback([options] {
        write_result(options->target,
                     make_sphere(options->radius, options->segments.first, options->segments.second));
    });
}

struct Box {
    SizeArgument size{{1, 1, 1}};
    std::uint32_t segments = 1;
    std::string target;
};

void add_box(CLI::App& mesh) {
    auto options = std::make_shared<Box>();
    CLI::App* box = add_shape(mesh, "box", "A box along the axes", "--size 1x1x1 --segments 4 -o box.stl",
                              options->target);
    box->add_option("--size", options->size, "Lengths along x, y and z (1x1x1)");
    box->add_option("--segments", options->segments, "Squares along each edge of a side")
        ->capture_default_str();
    box->callback(
        [options] { write_result(options->target, make_box(options->size.lengths, options->segments)); });
}

} // namespace

void add_mesh_command(CLI::App& app) {
    CLI::App* mesh =
        app.add_subcommand("mesh", "Make a closed mesh: torus, sphere or box, centred at the origin");
    mesh->require_subcommand(0, 1); // none is refused below: here it would hide a misspelt one
    mesh->callback([mesh] {
        if (mesh->get_subcommands().empty()) throw CLI::RequiredError("A subcommand (torus, sphere or box)");
    });
    mesh->footer("Example: echinus mesh torus --major 1 --minor 0.4 --segments 60x24 -o torus.obj");
    add_torus(*mesh);
    add_sphere(*mesh);
    add_box(*mesh);
}
