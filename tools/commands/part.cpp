#include "commands/commands.hpp"
#include "commands/descriptions.hpp"
#include "console/progress.hpp"
#include "input_file.hpp"
#include "mesh_io/write_mesh.hpp"
#include "output.hpp"
#include "run_program.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/surface_collision.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

struct PartArguments {
    MeshArgument surface;
    std::vector<fs::path> models;
    fs::path target;
    std::optional<double> thickness;
    std::uint32_t thread_count = 0;
    bool takes_best = false; ///< even if something still intersects
    bool json = false;
};

/// What intersects, by the names of files.
struct Counts {
    std::size_t own_pairs = 0;
    std::vector<std::size_t> model_pairs; ///< [model]
};

Counts counts_of(const TriangleMesh& surface, const std::vector<TriangleMesh>& models) {
    Counts counts{.own_pairs = self_intersecting_pairs(surface).size(), .model_pairs = {}};
    for (const TriangleMesh& model : models)
        counts.model_pairs.push_back(intersecting_pairs(surface, model).size());
    return counts;
}

Json json_of(const PartArguments& arguments, const Counts& before, const Parted& parted) {
    Json models = Json::array();
    for (std::size_t i = 0; i < arguments.models.size(); ++i)
        models.push_back({{"file", name_of_input(arguments.models[i])},
                          {"pairs_before", before.model_pairs[i]},
                          {"pairs", parted.model_pairs[i].size()}});
    return {{"parted", parted.is_apart()},
            {"own_pairs_before", before.own_pairs},
            {"own_pairs", parted.own_pairs.size()},
            {"models", models},
            {"vertices_inside", parted.inside.size()},
            {"stretched_share", parted.stretched_share},
            {"largest_stretch", parted.largest_stretch}};
}

std::string text_of(const PartArguments& arguments, const Counts& before, const Parted& parted) {
    Table table(arguments.surface.name());
    const auto change = [](std::size_t from, std::size_t to) { return fmt::format("{}, now {}", from, to); };
    table.add("pairs with itself", change(before.own_pairs, parted.own_pairs.size()));
    for (std::size_t i = 0; i < arguments.models.size(); ++i)
        table.add("pairs with " + name_of_input(arguments.models[i]),
                  change(before.model_pairs[i], parted.model_pairs[i].size()));
    table.add("vertices inside a model", fmt::format("now {}", parted.inside.size()));
    table.add("edges", fmt::format("{:.2g} % changed by more than 5 %; the longest is stretched by {:.2g} %",
                                   100 * parted.stretched_share, 100 * parted.largest_stretch));
    return table.text();
}

/// What still intersects, as a sentence.
std::string remaining(const PartArguments& arguments, const Parted& parted) {
    std::string text;
    const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
    if (!parted.own_pairs.empty())
        add(fmt::format("{} pairs with itself (first {} and {})", parted.own_pairs.size(),
                        parted.own_pairs[0].a, parted.own_pairs[0].b));
    for (std::size_t i = 0; i < arguments.models.size(); ++i)
        if (const std::vector<FacePair>& pairs = parted.model_pairs[i]; !pairs.empty())
            add(fmt::format("{} pairs with {} (first {} and {})", pairs.size(),
                            name_of_input(arguments.models[i]), pairs[0].a, pairs[0].b));
    if (!parted.inside.empty())
        add(fmt::format("{} vertices inside a model (first {})", parted.inside.size(), parted.inside[0]));
    return text;
}

void require_arguments(const PartArguments& arguments) {
    const auto is_standard = [](const fs::path& path) { return path == kStandardStream; };
    if (std::ranges::count_if(arguments.models, is_standard) + (is_standard(arguments.surface.path) ? 1 : 0) >
        1)
        throw WrongUse("--model", "standard input (-) is named twice");
    require_one_result(arguments.target, arguments.json);
    require_another_file(arguments.surface.path, arguments.target);
    for (const fs::path& model : arguments.models) require_another_file(model, arguments.target);
}

TriangleMesh read_model(const fs::path& path, const Vec3d& origin, const std::string& format) {
    TriangleMesh model = read_mesh({.path = path, .format = format});
    move_to_frame(origin, model, name_of_input(path));
    if (!inspect(model).closed)
        warn(name_of_input(path) + " is open, so it has no inside that the surface could leave; see echinus "
                                   "mesh repair");
    return model;
}

void run(const PartArguments& arguments) {
    require_arguments(arguments);
    TriangleMesh surface = read_mesh(arguments.surface);
    std::vector<TriangleMesh> models;
    for (const fs::path& path : arguments.models)
        models.push_back(read_model(path, surface.origin, arguments.surface.format));
    const Counts before = counts_of(surface, models);
    Parted parted;
    {
        ProgressBar bar("parting");
        parted = part(surface, models,
                      {.thickness = arguments.thickness,
                       .thread_count = arguments.thread_count,
                       .progress = [&bar](double share) { bar(share); }});
    }
    if (!parted.is_apart()) {
        const std::string sentence =
            arguments.surface.name() + " could not be parted: " + remaining(arguments, parted);
        if (!arguments.takes_best)
            throw Error(ErrorCode::InvalidMesh, sentence + "; --best writes the result nevertheless");
        warn(sentence + "; echinus check --pairs shows where");
    }
    surface.vertices = parted.vertices;
    if (arguments.target == kStandardStream)
        print(encode_obj(surface));
    else
        write_mesh(arguments.target, surface);
    if (arguments.json)
        print(json_of(arguments, before, parted).indented());
    else if (arguments.target != kStandardStream)
        print(text_of(arguments, before, parted));
}

} // namespace

void add_part_command(Command program) {
    Command command = program.add_command(
        "part", "Move a surface such as a garment out of models and out of itself, with little stretch");
    const auto arguments = std::make_shared<PartArguments>();
    command
        .add("MESH", &arguments->surface.path,
             "Mesh to move: OBJ, PLY, STL, OFF, glTF, GLB, 3DS, or - for standard input")
        .required()
        .type_name("");
    command.add("--model", &arguments->models, "Meshes that stay, such as a body; closed ones have an inside")
        .type_name("FILE ...");
    command
        .add("-o,--output", &arguments->target,
             "File to write: .obj, .ply, .stl or .off; - for OBJ on standard output")
        .required();
    command
        .add("--thickness", &arguments->thickness,
             "Distance to keep from the models; by default a tenth of the mean edge length")
        .type_name("LENGTH");
    command.add("--threads", &arguments->thread_count, "Threads to use; 0: all cores")
        .range(0, 1024)
        .type_name("COUNT")
        .show_default();
    arguments->surface.add_format_option(command);
    command.add_flag("--best", arguments->takes_best,
                     "Write the result with the fewest intersections, instead of failing, if some remain");
    command.add_flag("--json", arguments->json, "Print one JSON object");
    command.footer("Example:\n  echinus part dress.obj --model body.obj -o dressed.obj");
    command.action([arguments] { run(*arguments); });
}
