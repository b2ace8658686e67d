#include "choice.hpp"
#include "command.hpp"
#include "grid_argument.hpp"
#include "input_file.hpp"
#include "map_description.hpp"
#include "mesh_description.hpp"
#include "output.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/error.hpp>
#include <echinus/map_file.hpp>

#include <nlohmann/json.hpp>

#include <chrono>
#include <memory>

using namespace echinus;

namespace {

enum class MapKind { Distance };

struct BuildArguments {
    MeshArgument mesh;
    std::filesystem::path target;
    MapKind kind = MapKind::Distance;
    GridArgument directions{DistanceMapOptions{}.longitude_count, DistanceMapOptions{}.colatitude_count};
    DistanceMapOptions options;
    bool repair = false;
    bool allow_open = false;
    bool json = false;
};

DistanceMapOptions options_of(const BuildArguments& arguments) {
    DistanceMapOptions options = arguments.options;
    options.longitude_count = arguments.directions.first;
    options.colatitude_count = arguments.directions.second;
    return options;
}

/// Behind a hole a map cannot know what is inside, so that wrong answers must be asked for. What has no
/// volume has no inside, and the correction of a mesh that is inside out would take off where it should add.
void require_solid(const TriangleMesh& mesh, const BuildArguments& arguments) {
    const MeshReport report = inspect(mesh);
    const std::string name = arguments.mesh.name();
    if (report.closed && report.signed_volume == 0)
        throw Error(ErrorCode::InvalidMesh,
                    name + ": the mesh encloses no volume; it is flat, or so far from the origin that its "
                           "vertices round to one place: move it to the origin");
    if (report.closed && report.signed_volume < 0)
        throw Error(ErrorCode::InvalidMesh, name + ": the mesh is inside out, its faces turn clockwise seen "
                                                   "from outside; mend it with --repair");
    if (report.closed || arguments.allow_open) return;
    const std::string remedy =
        foresee_repair(mesh).closed_then
            ? "mend it with --repair"
            : "mend it elsewhere, or accept wrong answers behind its holes with --allow-open";
    throw Error(ErrorCode::InvalidMesh,
                name + ": the mesh is not closed: " + describe_openness(report) + "; " + remedy);
}

struct BuiltMap {
    DistanceMap map;
    MapFileNotes notes;
    RepairReport repairs;
};

BuiltMap build_map(TriangleMesh mesh, const BuildArguments& arguments) {
    RepairReport repairs;
    if (arguments.repair) {
        RepairedMesh repaired = repair(mesh, RepairOptions::all());
        mesh = std::move(repaired.mesh);
        repairs = std::move(repaired.report);
    }
    require_solid(mesh, arguments);
    const auto start = std::chrono::steady_clock::now();
    DistanceMap map = DistanceMap::build(mesh, options_of(arguments));
    const std::chrono::duration<double, std::milli> duration = std::chrono::steady_clock::now() - start;
    if (map.view().entry_count() == 0)
        throw Error(
            ErrorCode::InvalidMesh,
            "no ray from the centre meets the mesh; it is too thin for so few directions, or so far from the "
            "origin that its vertices round to a few places");
    return {std::move(map), {.build_milliseconds = duration.count()}, std::move(repairs)};
}

void print_result(const MapDescription& description, const RepairReport& repairs,
                  const BuildArguments& arguments) {
    if (arguments.json) {
        nlohmann::ordered_json object = to_json(description);
        if (arguments.repair) object["repairs"] = to_json(repairs);
        print_json(object);
    } else if (arguments.target != kStandardStream) {
        print(to_text(description, arguments.target.string()));
        if (arguments.repair) print("\nRepair: " + to_text(repairs) + ".\n");
    }
}

void build(const BuildArguments& arguments) {
    require_one_result(arguments.target, arguments.json);
    const BuiltMap built =
        naming_mesh(arguments.mesh.name(), [&] { return build_map(read_mesh(arguments.mesh), arguments); });
    const std::vector<std::byte> bytes = serialise(built.map, built.notes);
    Output output(arguments.target);
    output.write(bytes.data(), bytes.size());
    output.commit();
    print_result({built.map, built.notes, bytes.size()}, built.repairs, arguments);
}

void add_options(CLI::App& command, BuildArguments& arguments) {
    DistanceMapOptions& options = arguments.options;
    command.add_option("MESH", arguments.mesh.path, "Mesh file (OBJ, PLY, STL, OFF, glTF, GLB, 3DS), or -")
        ->required()
        ->type_name("");
    command.add_option("-o,--output", arguments.target, "Map file to write, or -")
        ->required()
        ->type_name("MAP");
    add_choice<MapKind>(command, "--kind", arguments.kind, {{"distance", MapKind::Distance}}, "Kind of map");
    command.add_option("--directions", arguments.directions, "Samples of longitude and colatitude")
        ->type_name("COUNTxCOUNT")
        ->default_str("200x200");
    add_choice<VertexCorrection>(command, "--correction", options.correction,
                                 {{"signed", VertexCorrection::Signed},
                                  {"paper", VertexCorrection::Paper},
                                  {"none", VertexCorrection::None}},
                                 "What to do about vertices between the samples");
    add_choice<EntryFormat>(command, "--entries", options.entry_format,
                            {{"float32", EntryFormat::Float32}, {"unorm16", EntryFormat::Unorm16}},
                            "How to store a distance");
    add_choice<PoleAxis>(command, "--pole", options.pole_axis,
                         {{"x", PoleAxis::X}, {"y", PoleAxis::Y}, {"z", PoleAxis::Z}},
                         "Axis of the mesh through the poles of the grid");
    command.add_option("--threads", options.thread_count, "Threads to build on; 0: all cores")
        ->check(CLI::Range(0U, 1024U))
        ->type_name("COUNT")
        ->capture_default_str();
    command.add_flag("--repair", arguments.repair,
                     "Mend the mesh first: drop duplicate faces and doubled patches, turn inside-out parts");
    command.add_flag("--allow-open", arguments.allow_open,
                     "Build also from a mesh that is not closed; behind its holes answers are wrong");
    arguments.mesh.add_format_option(command);
    command.add_flag("--json", arguments.json, "Print one JSON object");
}

} // namespace

void add_build_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("build", "Build a map from a mesh");
    const auto arguments = std::make_shared<BuildArguments>();
    add_options(*command, *arguments);
    command->footer(
        "Example:\n  echinus build torus.obj --directions 200x200 --correction signed -o torus.ech");
    command->callback([arguments] { build(*arguments); });
}
