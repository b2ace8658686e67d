#include "commands/commands.hpp"
#include "commands/descriptions.hpp"
#include "commands/repair_arguments.hpp"
#include "input_file.hpp"
#include "mesh_io/write_mesh.hpp"
#include "output.hpp"

#include <echinus/mesh_io.hpp>

#include <memory>
#include <string>

namespace {

using namespace echinus;

void write_result(const std::filesystem::path& target, const TriangleMesh& mesh) {
    require_ending(target, {".obj", ".ply", ".stl", ".off"});
    if (target == kStandardStream)
        print(encode_obj(mesh));
    else
        write_mesh(target, mesh);
}

/// Adds the command of a shape with the options that all shapes have in common.
Command add_shape(Command mesh, const std::string& name, const std::string& description,
                  const std::string& example, std::filesystem::path& target) {
    Command shape = mesh.add_command(name, description);
    shape.add("-o,--output", &target, "File to write: .obj, .ply, .stl or .off; - for OBJ on standard output")
        .required();
    shape.footer("Example: echinus mesh " + name + " " + example);
    return shape;
}

struct Torus {
    double major = 1;
    double minor = 0.4;
    std::uint32_t major_segments = 60, minor_segments = 24;
    std::filesystem::path target;
};

void add_torus(Command mesh) {
    auto options = std::make_shared<Torus>();
    Command torus = add_shape(mesh, "torus", "A torus about the z axis",
                              "--major 1 --minor 0.4 --segments 60x24 -o torus.obj", options->target);
    torus.add("--major", &options->major, "Radius of the circle in the middle of the tube").show_default();
    torus.add("--minor", &options->minor, "Radius of the tube").show_default();
    torus
        .add_numbers("--segments", 'x', {&options->major_segments, &options->minor_segments},
                     "Numbers of segments around the axis and around the tube")
        .type_name("COUNTxCOUNT")
        .default_text("60x24");
    torus.action([options] {
        write_result(options->target, make_torus(options->major, options->minor, options->major_segments,
                                                 options->minor_segments));
    });
}

struct SphereOptions {
    double radius = 1;
    std::uint32_t meridians = 60, parallels = 30;
    std::filesystem::path target;
};

void add_sphere(Command mesh) {
    auto options = std::make_shared<SphereOptions>();
    Command sphere = add_shape(mesh, "sphere", "A sphere with its poles on the z axis",
                               "--radius 1 --segments 60x30 -o sphere.ply", options->target);
    sphere.add("--radius", &options->radius, "Distance of the vertices from the centre").show_default();
    sphere
        .add_numbers("--segments", 'x', {&options->meridians, &options->parallels},
                     "Numbers of meridians and of rows of faces from pole to pole")
        .type_name("COUNTxCOUNT")
        .default_text("60x30");
    sphere.action([options] {
        write_result(options->target, make_sphere(options->radius, options->meridians, options->parallels));
    });
}

struct Box {
    Vec3d size{1, 1, 1};
    std::uint32_t segments = 1;
    std::filesystem::path target;
};

void add_box(Command mesh) {
    auto options = std::make_shared<Box>();
    Command box = add_shape(mesh, "box", "An axis-aligned box", "--size 1x1x1 --segments 4 -o box.stl",
                            options->target);
    box.add_numbers("--size", 'x', {&options->size.x, &options->size.y, &options->size.z},
                    "Lengths along x, y and z")
        .type_name("LENGTHxLENGTHxLENGTH")
        .default_text("1x1x1");
    box.add("--segments", &options->segments, "Number of squares along each edge of a side").show_default();
    box.action([options] { write_result(options->target, make_box(options->size, options->segments)); });
}

struct Mending {
    MeshArgument mesh;
    std::filesystem::path target;
    RepairArguments repair{.repair = true};
    bool keep_faults = false;
    bool json = false;
};

void mend(Mending arguments) {
    require_one_result(arguments.target, arguments.json);
    require_another_file(arguments.mesh.path, arguments.target);
    arguments.repair.repair = !arguments.keep_faults;
    const auto [mesh, report] = naming_mesh(
        arguments.mesh.name(), [&] { return repair(read_mesh(arguments.mesh), arguments.repair.options()); });
    write_result(arguments.target, mesh);
    const bool closed = inspect(mesh).closed;
    if (arguments.json) {
        Json object = to_json(report);
        object.add("faces", mesh.faces.size());
        object.add("closed_then", closed);
        print(object.indented());
    } else if (arguments.target != kStandardStream) {
        print(to_text(report) + "; the mesh is " + (closed ? "closed" : "not closed") + " now\n");
    }
}

void add_repair(Command mesh) {
    auto arguments = std::make_shared<Mending>();
    Command command = mesh.add_command("repair", "Repair a mesh and, on request, make it solid");
    command.add("MESH", &arguments->mesh.path, "Mesh file (OBJ, PLY, STL, OFF, glTF, GLB, 3DS), or -")
        .required()
        .type_name("");
    command
        .add("-o,--output", &arguments->target,
             "File to write: .obj, .ply, .stl or .off; - for OBJ on standard output")
        .required();
    add_solid_options(command, arguments->repair);
    command.add_flag("--keep-faults", arguments->keep_faults,
                     "Skip the repairs that `echinus build --repair` makes");
    arguments->mesh.add_format_option(command);
    command.add_flag("--json", arguments->json, "Print one JSON object");
    command.footer("Example: echinus mesh repair truck.obj --close-holes 32 --drop-inner-faces -o solid.obj");
    command.action([arguments] { mend(*arguments); });
}

} // namespace

void add_mesh_command(Command program) {
    Command mesh = program.add_command(
        "mesh", "Make a closed mesh (torus, sphere or box, centred at the origin), or repair one");
    mesh.require_command("A command (torus, sphere, box or repair)");
    mesh.footer("Example: echinus mesh torus --major 1 --minor 0.4 --segments 60x24 -o torus.obj");
    add_torus(mesh);
    add_sphere(mesh);
    add_box(mesh);
    add_repair(mesh);
}
