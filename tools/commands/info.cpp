#include "commands/commands.hpp"
#include "commands/descriptions.hpp"
#include "input_file.hpp"
#include "output.hpp"

#include <echinus/map_file.hpp>
#include <echinus/mesh_io.hpp>

#include <memory>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

struct InfoArguments {
    MeshArgument file;
    bool json = false;
};

void show_map(const InputFile& file, bool json) {
    const AnyMap map = file.read([](const fs::path& path) { return load_map(path); });
    const MapFileNotes notes = file.read(load_map_file_notes);
    const std::uint64_t file_bytes = file.read([](const fs::path& path) { return fs::file_size(path); });
    const MapDescription description{map, notes, file_bytes};
    if (json) {
        print(to_json(description).indented());
    } else {
        print(to_text(description, file.name()));
    }
}

std::string advice(const RepairOutlook& outlook, bool closed_now) {
    if (!outlook.report.changed_anything()) {
        return closed_now ? "" : "\nThe mesh is not closed, and --repair finds nothing to repair.\n";
    }
    return "\nWith --repair: " + to_text(outlook.report) + "; then the mesh is " +
           (outlook.closed_then ? "" : "not ") + "closed.\n";
}

void show_mesh(const TriangleMesh& mesh, const std::string& name, bool json) {
    const MeshReport report = inspect(mesh);
    const RepairOutlook outlook = foresee_repair(mesh);
    if (json) {
        Json object = to_json(report, mesh.origin);
        Json repair = to_json(outlook.report);
        repair.add("closed_then", outlook.closed_then);
        object.add("repair", repair);
        print(object.indented());
    } else {
        print(to_text(report, mesh.origin, name) + advice(outlook, report.closed));
    }
}

void show(const InfoArguments& arguments) {
    const InputFile file(arguments.file.path, arguments.file.format);
    if (file.read(is_map_file)) {
        show_map(file, arguments.json);
    } else {
        arguments.file.require_format();
        const TriangleMesh mesh = file.read([](const fs::path& path) { return read_mesh(path); });
        naming_mesh(file.name(), [&] { show_mesh(mesh, file.name(), arguments.json); });
    }
}

} // namespace

void add_info_command(Command program) {
    Command command = program.add_command("info", "Print the properties of a mesh or a map");
    const auto arguments = std::make_shared<InfoArguments>();
    command.add("FILE", &arguments->file.path, "Mesh or map file, or -").required().type_name("");
    arguments->file.add_format_option(command);
    command.add_flag("--json", arguments->json, "Print one JSON object");
    command.footer("Example:\n  echinus info torus.ech");
    command.action([arguments] { show(*arguments); });
}
