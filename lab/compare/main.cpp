// The program echinus-compare.

#include "commands/descriptions.hpp"
#include "compare/compare.hpp"
#include "compare/comparison_report.hpp"
#include "console/progress.hpp"
#include "input_file.hpp"
#include "output.hpp"
#include "run_program.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <string>
#include <vector>

using namespace echinus;
using comparison::Comparison;
using test::Axis;

namespace {

constexpr std::size_t kCurveLength = 8; // from a sixteenth of the budget to eight times as much

struct CompareArguments {
    MeshArgument mesh;
    comparison::CompareOptions options;
    bool repair = false;
    bool curves = false;
    bool json = false;
};

TriangleMesh read_closed_mesh(const CompareArguments& arguments) {
    TriangleMesh mesh = read_mesh(arguments.mesh);
    return naming_mesh(arguments.mesh.name(), [&] {
        if (arguments.repair) mesh = repair(mesh, RepairOptions::all()).mesh;
        const MeshReport report = inspect(mesh);
        if (report.closed) return mesh;
        throw Error(ErrorCode::InvalidMesh, refusal_of_open_mesh(mesh, report, "--repair"));
    });
}

void compare(CompareArguments& arguments) {
    arguments.mesh.require_format();
    const TriangleMesh mesh = read_closed_mesh(arguments);
    if (arguments.curves) arguments.options.curve_length = kCurveLength;
    StageBars bars;
    arguments.options.report_progress = std::ref(bars);
    const Comparison result =
        naming_mesh(arguments.mesh.name(), [&] { return comparison::compare(mesh, arguments.options); });
    bars.finish();
    if (arguments.json)
        print(to_json(result, arguments.options, arguments.mesh.name()).indented());
    else
        print(to_text(result, arguments.options, arguments.mesh.name()));
}

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(' ');
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// "exact, dense" as two names. One argument, so that a mesh may follow it.
std::vector<std::string> split_names(const std::string& text) {
    std::vector<std::string> names;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string name = trimmed(text.substr(begin, end - begin));
        if (name.empty()) throw WrongUse("--systems", "there is an empty name in '" + text + "'");
        names.push_back(name);
        begin = end + 1;
    }
    return names;
}

std::string names_of_systems() {
    std::string names;
    for (const comparison::SystemType& system : comparison::all_systems())
        if (system.available()) (names += names.empty() ? "" : ", ") += system.name;
    return names;
}

void add_options(Command command, CompareArguments& arguments) {
    comparison::CompareOptions& options = arguments.options;
    command.add("MESH", &arguments.mesh.path, "A closed mesh, or -").required().type_name("");
    command
        .add(
            "--systems",
            [&options](const std::string& text) {
                options.systems = split_names(text);
                return true;
            },
            "Which, with commas between; all without it: " + names_of_systems())
        .type_name("NAMES");
    command.add_byte_count("--bytes", options.byte_budget,
                           "The most that each may take (630KB, the size of the paper's map of a horse)");
    command.add("--points", &options.point_count, "Particles in each of the three sets")
        .range(std::size_t{100}, std::size_t{100'000'000})
        .type_name("COUNT")
        .show_default();
    command
        .add("--segments", &options.system.segment_count,
             "Segments of the superquadric map; 0: as many as the shape asks for")
        .range(0, 4096)
        .type_name("COUNT")
        .show_default();
    add_choice<Axis>(command, "--up", options.up, {{"x", Axis::X}, {"y", Axis::Y}, {"z", Axis::Z}},
                     "Which axis of the mesh points up, for the cloth");
    command.add_flag("--repair", arguments.repair, "Mend the mesh first, as `echinus build --repair` does");
    arguments.mesh.add_format_option(command);
    command.add_flag("--curves", arguments.curves,
                     "Measure each system in eight sizes, too; takes some minutes");
    command.add_flag("--json", arguments.json, "Print one JSON object");
}

} // namespace

int main(int argc, char** argv) {
    CompareArguments arguments;
    const auto set_up = [&](Program& program) {
        const Command command = program.command();
        add_options(command, arguments);
        command.footer(
            "Examples:\n  echinus-compare torus.obj\n"
            "  echinus-compare horse.obj --systems exact,dense,openvdb --bytes 1MB --curves --json");
        command.action([&] { compare(arguments); });
    };
    return run_program("echinus-compare",
                       "Compares the maps with other systems on a mesh: bytes, time, error", set_up, argc,
                       argv);
}
