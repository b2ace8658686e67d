#include "commands/commands.hpp"
#include "commands/descriptions.hpp"
#include "console/progress.hpp"
#include "input_file.hpp"
#include "mesh_io/write_mesh.hpp"
#include "output.hpp"
#include "run_program.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh_io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

struct CheckArguments {
    std::vector<fs::path> paths;
    MeshArgument standard_input{.path = kStandardStream, .format = {}};
    fs::path target; ///< empty: no geometry
    std::uint32_t thread_count = 0;
    bool json = false;
};

/// Meshes in one frame, with the names of their files.
struct NamedMeshes {
    std::vector<std::string> names;
    std::vector<TriangleMesh> meshes;
};

void require_arguments(const CheckArguments& arguments) {
    if (std::ranges::count(arguments.paths, fs::path(kStandardStream)) > 1)
        throw WrongUse("MESH", "standard input (-) is named twice");
    require_one_result(arguments.target, arguments.json);
    for (const fs::path& path : arguments.paths) require_another_file(path, arguments.target);
}

NamedMeshes read_meshes(const CheckArguments& arguments) {
    NamedMeshes read;
    for (const fs::path& path : arguments.paths) {
        read.names.push_back(name_of_input(path));
        read.meshes.push_back(read_mesh({.path = path, .format = arguments.standard_input.format}));
        move_to_frame(read.meshes.front().origin, read.meshes.back(), read.names.back());
    }
    return read;
}

// ---- Numbers ----

std::size_t closed_count(const Intersections& found) {
    return static_cast<std::size_t>(std::ranges::count_if(found.curves, &IntersectionCurve::closed));
}

Json json_of(const Penetration& penetration) {
    if (!penetration.known) return nullptr;
    Json object{{"vertices", penetration.vertex_count}, {"depth", penetration.depth}};
    object.add("deepest_vertex",
               penetration.vertex_count == 0 ? Json(nullptr) : Json(penetration.deepest_vertex));
    return object;
}

/// Adds the keys that pairs of meshes and single meshes have in common.
void add_intersections(const Intersections& found, Json& object) {
    object.add("pairs", found.pairs.size());
    Json first_pairs = Json::array();
    for (std::size_t i = 0; i < std::min(found.pairs.size(), Fault::kFirstFaceCount); ++i)
        first_pairs.push_back(std::array{found.pairs[i].a, found.pairs[i].b});
    object.add("first_pairs", first_pairs);
    object.add("curves", found.curves.size());
    object.add("closed_curves", closed_count(found));
    object.add("curve_length", found.length);
}

Json json_of(const NamedMeshes& input, const std::vector<CheckedMeshes>& found) {
    Json meshes = Json::array(), between = Json::array(), own = Json::array();
    for (std::size_t i = 0; i < input.meshes.size(); ++i)
        meshes.push_back({{"file", input.names[i]},
                          {"faces", input.meshes[i].faces.size()},
                          {"vertices", input.meshes[i].vertices.size()}});
    for (const CheckedMeshes& pair : found) {
        const bool is_own = pair.a == pair.b;
        Json object = is_own ? Json{{"mesh", pair.a}} : Json{{"a", pair.a}, {"b", pair.b}};
        add_intersections(pair.found, object);
        if (!is_own) {
            object.add("a_in_b", json_of(pair.a_in_b));
            object.add("b_in_a", json_of(pair.b_in_a));
        }
        (is_own ? own : between).push_back(object);
    }
    return {{"intersecting", std::ranges::any_of(found, &CheckedMeshes::intersect)},
            {"meshes", meshes},
            {"between", between},
            {"own", own}};
}

// ---- Words ----

std::string counted(std::size_t count, const char* one, const char* several) {
    return fmt::format("{} {}", count, count == 1 ? one : several);
}

std::string depth_text(const Penetration& penetration, const std::string& name) {
    if (!penetration.known) return "not known: the mesh is not closed, or no exact map can hold it";
    if (penetration.vertex_count == 0) return "no vertex of " + name;
    return fmt::format("{} of {}, at most {:.6g} deep (vertex {})",
                       counted(penetration.vertex_count, "vertex", "vertices"), name, penetration.depth,
                       penetration.deepest_vertex);
}

std::string table_text(const NamedMeshes& input, const CheckedMeshes& pair) {
    const std::string &a = input.names[pair.a], &b = input.names[pair.b];
    const bool is_own = pair.a == pair.b;
    const Intersections& found = pair.found;
    Table table(is_own ? a + " and itself" : a + " and " + b);
    table.add("pairs of faces", found.pairs.empty() ? "0"
                                                    : fmt::format("{}, first {} and {}", found.pairs.size(),
                                                                  found.pairs[0].a, found.pairs[0].b));
    table.add("curves", fmt::format("{}, {:.6g} long", found.curves.size(), found.length));
    if (!is_own) {
        table.add("inside " + b, depth_text(pair.a_in_b, a));
        table.add("inside " + a, depth_text(pair.b_in_a, b));
    }
    return table.text();
}

std::string result_text(const NamedMeshes& input, const std::vector<CheckedMeshes>& found) {
    if (found.empty()) return "No faces intersect: " + counted(input.meshes.size(), "mesh", "meshes") + ".\n";
    std::string text;
    for (const CheckedMeshes& pair : found) text += (text.empty() ? "" : "\n") + table_text(input, pair);
    return text;
}

// ---- Geometry ----

/// All meshes, with intersecting faces in red and the intersection curves as edges.
class Painting {
  public:
    explicit Painting(const std::vector<TriangleMesh>& meshes) {
        whole_.origin = meshes.front().origin;
        for (const TriangleMesh& mesh : meshes) add(mesh);
    }

    void add(const CheckedMeshes& pair) {
        for (const FacePair& faces : pair.found.pairs) {
            make_red(first_face_[pair.a] + faces.a);
            make_red(first_face_[pair.b] + faces.b);
        }
        for (const IntersectionCurve& curve : pair.found.curves) add(curve);
    }

    std::string ply() const { return encode_painted_ply(whole_, vertex_colours_, face_colours_, edges_); }

  private:
    static constexpr Colour kRed{220, 30, 30}, kDarkRed{90, 0, 0};
    static constexpr std::array<Colour, 4> kGreys{
        {{200, 200, 200}, {160, 170, 185}, {185, 175, 155}, {150, 175, 155}}};

    void add(const TriangleMesh& mesh) {
        const auto first_vertex = next_index();
        const Colour grey = kGreys[first_face_.size() % kGreys.size()];
        first_face_.push_back(whole_.faces.size());
        whole_.vertices.insert(whole_.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
        vertex_colours_.resize(whole_.vertices.size(), grey);
        for (const auto& [a, b, c] : mesh.faces)
            whole_.faces.push_back({first_vertex + a, first_vertex + b, first_vertex + c});
        face_colours_.resize(whole_.faces.size(), grey);
    }

    void make_red(std::size_t face) {
        face_colours_[face] = kRed;
        for (const std::uint32_t vertex : whole_.faces[face]) vertex_colours_[vertex] = kRed;
    }

    void add(const IntersectionCurve& curve) {
        const std::uint32_t first = next_index();
        whole_.vertices.insert(whole_.vertices.end(), curve.points.begin(), curve.points.end());
        vertex_colours_.resize(whole_.vertices.size(), kDarkRed);
        const std::uint32_t end = next_index();
        for (std::uint32_t i = first; i + 1 < end; ++i) edges_.push_back({i, i + 1});
        if (curve.closed) edges_.push_back({end - 1, first});
    }

    /// The vertex indices of edges in a PLY file have type int.
    std::uint32_t next_index() const {
        if (whole_.vertices.size() > std::numeric_limits<std::int32_t>::max())
            throw Error(ErrorCode::InvalidMesh, "the meshes have more vertices than a PLY can number; "
                                                "leave out --pairs, or check fewer meshes");
        return static_cast<std::uint32_t>(whole_.vertices.size());
    }

    TriangleMesh whole_;
    std::vector<std::size_t> first_face_; ///< of each mesh
    std::vector<Colour> vertex_colours_, face_colours_;
    std::vector<std::array<std::uint32_t, 2>> edges_;
};

void write_painting(const fs::path& target, const NamedMeshes& input,
                    const std::vector<CheckedMeshes>& found) {
    Painting painting(input.meshes);
    for (const CheckedMeshes& pair : found) painting.add(pair);
    Output output(target);
    output.write(painting.ply());
    output.commit();
}

void run(const CheckArguments& arguments) {
    require_arguments(arguments);
    const NamedMeshes input = read_meshes(arguments);
    std::vector<CheckedMeshes> found;
    {
        ProgressBar bar("checking");
        found = check(input.meshes, {.names = input.names,
                                     .thread_count = arguments.thread_count,
                                     .progress = [&bar](double share) { bar(share); }});
    }
    if (!arguments.target.empty()) write_painting(arguments.target, input, found);
    if (arguments.json)
        print(json_of(input, found).indented());
    else if (arguments.target != kStandardStream)
        print(result_text(input, found));
}

} // namespace

void add_check_command(Command program) {
    Command command = program.add_command(
        "check",
        "Find the faces of meshes that intersect, their curves, and how deep meshes are in each other");
    const auto arguments = std::make_shared<CheckArguments>();
    command.add("MESH", &arguments->paths, "Mesh files (OBJ, PLY, STL, OFF, glTF, GLB, 3DS), or -")
        .required()
        .type_name("...");
    command
        .add("--pairs", &arguments->target,
             "Write all meshes as one .ply, with intersecting faces in red and the curves as edges; - for "
             "standard output")
        .ends_in(".ply")
        .type_name("PLY");
    command.add("--threads", &arguments->thread_count, "Threads to use; 0: all cores")
        .range(0, 1024)
        .type_name("COUNT")
        .show_default();
    arguments->standard_input.add_format_option(command);
    command.add_flag("--json", arguments->json, "Print one JSON object");
    command.footer("Example:\n  echinus check dress.obj body.obj --pairs crossing.ply");
    command.action([arguments] { run(*arguments); });
}
