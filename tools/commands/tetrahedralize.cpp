#include "commands/commands.hpp"
#include "commands/descriptions.hpp"
#include "console/progress.hpp"
#include "input_file.hpp"
#include "mesh_io/write_mesh.hpp"
#include "output.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/tetrahedra.hpp>

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

using namespace echinus;

namespace {

struct TetrahedralizeArguments {
    MeshArgument mesh;
    std::filesystem::path target;
    TetrahedralizeOptions options;
    std::optional<double> size;
    std::uint32_t count = 0, most = 10'000'000;
    bool repair = false;
    bool allow_open = false;
    bool json = false;
};

/// A body, its properties, and how it was made.
struct Outcome {
    Tetrahedralization body;
    TetrahedralReport report;
    BoundaryDistance distance;
    RepairReport repairs;
    double milliseconds = 0;
};

Outcome make_body(TriangleMesh mesh, const TetrahedralizeArguments& arguments) {
    Outcome outcome;
    if (arguments.repair) {
        RepairedMesh repaired = repair(mesh, RepairOptions::all());
        mesh = std::move(repaired.mesh);
        outcome.repairs = std::move(repaired.report);
    }
    const MeshReport report = inspect(mesh);
    if (!report.closed && !arguments.allow_open)
        throw Error(
            ErrorCode::InvalidMesh,
            arguments.mesh.name() + ": " +
                refusal_of_open_mesh(mesh, report, "--repair",
                                     ", or let the winding number decide what is inside with --allow-open"));
    const ExactMap map = ExactMap::build(mesh, {.thread_count = arguments.options.thread_count});
    TetrahedralizeOptions options = arguments.options;
    ProgressBar bar("filling with tetrahedra");
    options.progress = [&bar](double share) { bar(share); };
    const auto start = std::chrono::steady_clock::now();
    outcome.body = tetrahedralize(map, options);
    const std::chrono::duration<double, std::milli> duration = std::chrono::steady_clock::now() - start;
    outcome.milliseconds = duration.count();
    outcome.report = inspect_tetrahedra(outcome.body.mesh);
    outcome.distance = measure_distance(outcome.body.mesh, map, options.thread_count);
    return outcome;
}

Json json_of(const Outcome& outcome) {
    const auto& [body, report, distance, repairs, milliseconds] = outcome;
    return {{"tetrahedra", report.tetrahedron_count},
            {"vertices", report.vertex_count},
            {"size", body.size},
            {"volume", report.volume},
            {"least_volume", report.least_volume},
            {"least_angle_deg", report.least_angle_deg},
            {"greatest_angle_deg", report.greatest_angle_deg},
            {"shortest_edge", report.shortest_edge},
            {"longest_edge", report.longest_edge},
            {"boundary_faces", report.boundary.face_count},
            {"components", report.boundary.component_count},
            {"mean_to_model", distance.mean_to_model},
            {"greatest_to_model", distance.greatest_to_model},
            {"mean_to_boundary", distance.mean_to_boundary},
            {"greatest_to_boundary", distance.greatest_to_boundary},
            {"removed_tetrahedra", body.removed_tetrahedra},
            {"milliseconds", milliseconds}};
}

/// @param asked  the requested count, or 0
std::string count_text(std::size_t count, std::size_t asked) {
    constexpr double kTolerance = 0.05; // the tolerance of tetrahedralize()
    const bool misses =
        asked > 0 && std::abs(static_cast<double>(count) / static_cast<double>(asked) - 1) > kTolerance;
    return std::to_string(count) +
           (misses ? fmt::format(", in place of {}: the model does not allow that number", asked) : "");
}

/// @param asked  the requested count, or 0
std::string text_of(const Outcome& outcome, const std::string& title, std::size_t asked) {
    const auto& [body, report, distance, repairs, milliseconds] = outcome;
    Table table(title);
    table.add("tetrahedra", count_text(report.tetrahedron_count, asked));
    table.add("vertices", std::to_string(report.vertex_count));
    table.add("size", fmt::format("{:.6g}", body.size));
    table.add("edges", fmt::format("{:.4g} to {:.4g}", report.shortest_edge, report.longest_edge));
    table.add("dihedral angles",
              fmt::format("{:.1f} to {:.1f} degrees", report.least_angle_deg, report.greatest_angle_deg));
    table.add("volume",
              fmt::format("{:.6g}; that of the smallest {:.3g}", report.volume, report.least_volume));
    table.add("boundary", fmt::format("{} faces, {}", report.boundary.face_count,
                                      report.boundary.component_count == 1
                                          ? "in one piece"
                                          : fmt::format("in {} pieces", report.boundary.component_count)));
    table.add("boundary to model", fmt::format("{:.3g} on average, at most {:.3g}", distance.mean_to_model,
                                               distance.greatest_to_model));
    table.add("model to boundary", fmt::format("{:.3g} on average, at most {:.3g}", distance.mean_to_boundary,
                                               distance.greatest_to_boundary));
    if (body.removed_tetrahedra > 0)
        table.add("left out", fmt::format("{} tetrahedra, where parts would have met in an edge or a vertex",
                                          body.removed_tetrahedra));
    table.add("time", fmt::format("{:.0f} ms", milliseconds));
    return table.text();
}

void write_body(const std::filesystem::path& target, const TetrahedralMesh& mesh) {
    if (target == kStandardStream)
        print(encode_msh(mesh));
    else
        write_tetrahedra(target, mesh);
}

void run(TetrahedralizeArguments& arguments) {
    require_ending(arguments.target, {".msh", ".vtk"});
    require_one_result(arguments.target, arguments.json);
    require_another_file(arguments.mesh.path, arguments.target);
    arguments.options.count = arguments.count;
    arguments.options.most_tetrahedra = arguments.most;
    const Outcome outcome =
        naming_mesh(arguments.mesh.name(), [&] { return make_body(read_mesh(arguments.mesh), arguments); });
    write_body(arguments.target, outcome.body.mesh);
    if (arguments.json) {
        Json object = json_of(outcome);
        if (arguments.repair) object.add("repairs", to_json(outcome.repairs));
        print(object.indented());
    } else if (arguments.target != kStandardStream) {
        print(text_of(outcome, arguments.target.string(), arguments.count));
        if (arguments.repair) print("\nRepair: " + to_text(outcome.repairs) + ".\n");
    }
}

} // namespace

void add_tetrahedralize_command(Command program) {
    Command command = program.add_command("tetrahedralize", "Fill a mesh with tetrahedra");
    const auto arguments = std::make_shared<TetrahedralizeArguments>();
    command.add("MESH", &arguments->mesh.path, "Mesh file (OBJ, PLY, STL, OFF, glTF, GLB, 3DS), or -")
        .required()
        .type_name("");
    command
        .add("-o,--output", &arguments->target, "File to write: .msh or .vtk; - for MSH on standard output")
        .required()
        .type_name("BODY");
    command
        .add("--size", &arguments->size,
             "Length of the longest interior edges, in the unit of the mesh; finer features are "
             "lost")
        .type_name("LENGTH");
    command
        .add("--count", &arguments->count,
             "Target number of tetrahedra, in place of --size; 10000 if neither is given")
        .range(1U, 100'000'000U)
        .excludes("--size")
        .type_name("NUMBER");
    command.add("--most", &arguments->most, "Largest number of tetrahedra; more are rejected")
        .range(1U, 100'000'000U)
        .type_name("NUMBER")
        .show_default();
    command.add("--threads", &arguments->options.thread_count, "Threads to use; 0: all cores")
        .range(0, 1024)
        .type_name("COUNT")
        .show_default();
    command.add_flag(
        "--repair", arguments->repair,
        "Repair the mesh first: drop duplicate faces and doubled patches, flip inside-out parts");
    command.add_flag(
        "--allow-open", arguments->allow_open,
        "Accept a mesh that is not closed; the generalised winding number decides what is inside");
    arguments->mesh.add_format_option(command);
    command.add_flag("--json", arguments->json, "Print one JSON object");
    command.footer("Example:\n  echinus tetrahedralize liver.off -o liver.msh --count 10000");
    command.action([arguments] {
        arguments->mesh.require_format();
        if (!arguments->size && arguments->count == 0) arguments->count = 10'000;
        arguments->options.size = arguments->size.value_or(0);
        run(*arguments);
    });
}
