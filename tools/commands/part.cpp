#include "commands/commands.hpp"
#include "commands/descriptions.hpp"
#include "console/progress.hpp"
#include "input_file.hpp"
#include "mesh_io/mesh_source.hpp"
#include "mesh_io/write_mesh.hpp"
#include "output.hpp"
#include "run_program.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/simulation.hpp>
#include <echinus/surface_collision.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

struct PartArguments {
    std::vector<fs::path> meshes; ///< layers from the inside to the outside
    MeshArgument standard_input;  ///< its format
    std::vector<fs::path> models;
    fs::path target; ///< a file, or a folder for several meshes
    std::optional<double> thickness;
    std::uint32_t thread_count = 0;
    bool takes_best = false; ///< even if something still intersects
    bool json = false;

    MeshArgument mesh(std::size_t i) const { return {meshes[i], standard_input.format}; }
    MeshArgument model(std::size_t i) const { return {models[i], standard_input.format}; }
};

/// Meshes joined to a single surface in the frame of the first.
class JoinedMeshes {
  public:
    explicit JoinedMeshes(const PartArguments& arguments) {
        for (std::size_t i = 0; i < arguments.meshes.size(); ++i) {
            parts_.push_back(read_mesh(arguments.mesh(i)));
            names_.push_back(arguments.mesh(i).name());
            move_to_frame(parts_[0].origin, parts_[i], names_[i]);
            naming_mesh(names_[i],
                        [&] { return make_cloth(parts_[i], {}); }); // errors with the file's own numbers
            add(parts_[i]);
        }
    }

    const TriangleMesh& surface() const { return surface_; }
    /// [vertex] its mesh; empty for a single one
    std::vector<std::uint8_t> layers() const {
        std::vector<std::uint8_t> layers;
        if (parts_.size() > 1)
            for (std::size_t i = 0; i < parts_.size(); ++i)
                layers.insert(layers.end(), parts_[i].vertices.size(), static_cast<std::uint8_t>(i));
        return layers;
    }
    /// A mesh with other positions, in the frame of the first.
    TriangleMesh moved(std::size_t i, std::span<const Vec3f> vertices) const {
        std::size_t first = 0;
        for (std::size_t j = 0; j < i; ++j) first += parts_[j].vertices.size();
        const auto own = vertices.subspan(first, parts_[i].vertices.size());
        return {{own.begin(), own.end()}, parts_[i].faces, surface_.origin};
    }
    std::string name() const { return fmt::format("{}", fmt::join(names_, ", ")); }
    /// The name of a face: its number, and with several meshes that of its file.
    std::string face(std::uint32_t number) const {
        std::size_t i = 0;
        for (; number >= parts_[i].faces.size(); ++i)
            number -= static_cast<std::uint32_t>(parts_[i].faces.size());
        return parts_.size() > 1 ? fmt::format("{} of {}", number, names_[i]) : fmt::format("{}", number);
    }

  private:
    void add(const TriangleMesh& part) {
        const auto first = static_cast<std::uint32_t>(surface_.vertices.size());
        surface_.origin = part.origin;
        surface_.vertices.insert(surface_.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (const auto& [a, b, c] : part.faces) surface_.faces.push_back({a + first, b + first, c + first});
    }

    std::vector<TriangleMesh> parts_;
    std::vector<std::string> names_;
    TriangleMesh surface_;
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
            {"largest_displacement", parted.largest_displacement},
            {"stretched_share", parted.stretched_share},
            {"largest_stretch", parted.largest_stretch}};
}

std::string text_of(const PartArguments& arguments, const JoinedMeshes& meshes, const Counts& before,
                    const Parted& parted) {
    Table table(meshes.name());
    const auto change = [](std::size_t from, std::size_t to) { return fmt::format("{}, now {}", from, to); };
    table.add(arguments.meshes.size() > 1 ? "pairs with themselves and each other" : "pairs with itself",
              change(before.own_pairs, parted.own_pairs.size()));
    for (std::size_t i = 0; i < arguments.models.size(); ++i)
        table.add("pairs with " + name_of_input(arguments.models[i]),
                  change(before.model_pairs[i], parted.model_pairs[i].size()));
    table.add("vertices inside a model", fmt::format("now {}", parted.inside.size()));
    table.add("largest displacement", fmt::format("{:.3g}", parted.largest_displacement));
    table.add("edges", fmt::format("{:.2g} % changed by more than 5 %; the longest is stretched by {:.2g} %",
                                   100 * parted.stretched_share, 100 * parted.largest_stretch));
    return table.text();
}

/// What still intersects, as a sentence.
std::string remaining(const PartArguments& arguments, const JoinedMeshes& meshes, const Parted& parted) {
    std::string text;
    const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
    if (!parted.own_pairs.empty())
        add(fmt::format("{} pairs of its own faces (first {} and {})", parted.own_pairs.size(),
                        meshes.face(parted.own_pairs[0].a), meshes.face(parted.own_pairs[0].b)));
    for (std::size_t i = 0; i < arguments.models.size(); ++i)
        if (const std::vector<FacePair>& pairs = parted.model_pairs[i]; !pairs.empty())
            add(fmt::format("{} pairs with {} (first {} and {})", pairs.size(),
                            name_of_input(arguments.models[i]), meshes.face(pairs[0].a), pairs[0].b));
    if (!parted.inside.empty())
        add(fmt::format("{} vertices inside a model (first {})", parted.inside.size(), parted.inside[0]));
    return text;
}

void require_names_that_differ(const std::vector<fs::path>& meshes) {
    std::set<fs::path> names;
    for (const fs::path& mesh : meshes) {
        if (mesh == kStandardStream) throw WrongUse("MESH", "standard input (-) can only be the single mesh");
        if (!names.insert(mesh.filename()).second)
            throw WrongUse("MESH", "two meshes are called " + mesh.filename().string() +
                                       "; the folder for the results needs different names");
    }
}

void require_arguments(const PartArguments& arguments) {
    constexpr std::size_t kMostLayers = 256;
    const auto is_standard = [](const fs::path& path) { return path == kStandardStream; };
    if (std::ranges::count_if(arguments.models, is_standard) +
            std::ranges::count_if(arguments.meshes, is_standard) >
        1)
        throw WrongUse("--model", "standard input (-) is named twice");
    require_one_result(arguments.target, arguments.json);
    if (arguments.meshes.size() > kMostLayers)
        throw WrongUse("MESH", fmt::format("there are more than {} layers", kMostLayers));
    if (arguments.meshes.size() == 1 && !is_standard(arguments.target))
        require_ending(arguments.target, {".obj", ".ply", ".stl", ".off"});
    if (arguments.meshes.size() > 1) {
        require_names_that_differ(arguments.meshes);
        if (is_standard(arguments.target)) throw WrongUse("--output", "several meshes need a folder");
        for (const fs::path& mesh : arguments.meshes)
            require_another_file(mesh, arguments.target / mesh.filename());
        return;
    }
    require_another_file(arguments.meshes[0], arguments.target);
    for (const fs::path& model : arguments.models) require_another_file(model, arguments.target);
}

TriangleMesh read_model(const MeshArgument& argument, const Vec3d& origin) {
    TriangleMesh model = read_mesh(argument);
    move_to_frame(origin, model, argument.name());
    if (!inspect(model).closed)
        warn(argument.name() + " is open, so it has no inside that the surface could leave; see echinus "
                               "mesh repair");
    return model;
}

bool is_obj(const fs::path& path) {
    return lower_case_ending(path) == ".obj";
}

void write_results(const PartArguments& arguments, const JoinedMeshes& meshes,
                   std::span<const Vec3f> vertices, std::optional<OutputFolder>& folder) {
    for (std::size_t i = 0; i < arguments.meshes.size(); ++i) {
        const TriangleMesh mesh = meshes.moved(i, vertices);
        const fs::path& original = arguments.meshes[i];
        const fs::path target = folder ? folder->path_of(original.filename().string()) : arguments.target;
        if (target == kStandardStream)
            print(encode_obj(mesh));
        else if (original == kStandardStream)
            write_mesh(target, mesh);
        else if (!write_moved_mesh(target, mesh, original) && is_obj(original) && is_obj(target))
            warn(arguments.mesh(i).name() +
                 " has polygons whose division into triangles depends on their shape, so "
                 "that triangles were written, without texture coordinates and groups");
    }
    if (folder) folder->commit();
}

void run(const PartArguments& arguments) {
    require_arguments(arguments);
    std::optional<OutputFolder> folder; // before the work, which takes long
    if (arguments.meshes.size() > 1) folder.emplace(arguments.target);
    const JoinedMeshes meshes(arguments);
    std::vector<TriangleMesh> models;
    for (std::size_t i = 0; i < arguments.models.size(); ++i)
        models.push_back(read_model(arguments.model(i), meshes.surface().origin));
    const Counts before = counts_of(meshes.surface(), models);
    Parted parted;
    {
        ProgressBar bar("parting");
        parted = part(meshes.surface(), models,
                      {.thickness = arguments.thickness,
                       .layers = meshes.layers(),
                       .thread_count = arguments.thread_count,
                       .progress = [&bar](double share) { bar(share); }});
    }
    if (!parted.is_apart()) {
        const std::string sentence =
            meshes.name() + " could not be parted: " + remaining(arguments, meshes, parted);
        if (!arguments.takes_best)
            throw Error(ErrorCode::InvalidMesh, sentence + "; --best writes the result nevertheless");
        warn(sentence + "; echinus check --pairs shows where");
    }
    write_results(arguments, meshes, parted.vertices, folder);
    if (arguments.json)
        print(json_of(arguments, before, parted).indented());
    else if (arguments.target != kStandardStream)
        print(text_of(arguments, meshes, before, parted));
}

} // namespace

void add_part_command(Command program) {
    Command command = program.add_command(
        "part", "Move a surface such as a garment out of models and out of itself, with little stretch");
    const auto arguments = std::make_shared<PartArguments>();
    command
        .add("MESH", &arguments->meshes,
             "Mesh to move: OBJ, PLY, STL, OFF, glTF, GLB, 3DS, or - for standard input; or several, the "
             "layers "
             "from the inside to the outside")
        .required()
        .type_name("...");
    command.add("--model", &arguments->models, "Meshes that stay, such as a body; closed ones have an inside")
        .type_name("FILE ...");
    command
        .add("-o,--output", &arguments->target,
             "File to write: .obj, .ply, .stl or .off; - for OBJ on standard output; a folder for several "
             "meshes")
        .required();
    command
        .add("--thickness", &arguments->thickness,
             "Distance to keep from the models; by default a tenth of the mean edge length")
        .type_name("LENGTH");
    command.add("--threads", &arguments->thread_count, "Threads to use; 0: all cores")
        .range(0, 1024)
        .type_name("COUNT")
        .show_default();
    arguments->standard_input.add_format_option(command);
    command.add_flag("--best", arguments->takes_best,
                     "Write the result with the fewest intersections, instead of failing, if some remain");
    command.add_flag("--json", arguments->json, "Print one JSON object");
    command.footer("Examples:\n  echinus part dress.obj --model body.obj -o dressed.obj\n"
                   "  echinus part shirt.obj jacket.obj --model body.obj -o dressed");
    command.action([arguments] { run(*arguments); });
}
