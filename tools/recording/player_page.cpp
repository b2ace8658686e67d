#include "recording/player_page.hpp"

#include "console/machine.hpp"
#include "encoding.hpp"
#include "files/read_file.hpp"
#include "recording/recording_code.hpp"
#include "recording/threads.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <bit>
#include <vector>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

// ---- The player ----

constexpr std::string_view kPlace = "<!-- recording -->";

/// Beside the program, so that an installed tree may be moved.
fs::path installed_player() {
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    return (program.parent_path() / ECHINUS_DATA_FOLDER / "player.html").lexically_normal();
}

std::string read_text(const fs::path& path) {
    const std::vector<std::byte> bytes = read_file(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string read_player(const fs::path& path) {
    try {
        return read_text(path);
    } catch (const Error& error) {
        throw Error(ErrorCode::Unreadable,
                    std::string(error.what()) +
                        "; --html needs the player: build it with scripts/web --build-only (and install "
                        "again, for an installed program), or name one with --player");
    }
}

// ---- Its contents ----

/// Of a recording with one collider, and with several.
constexpr int kFormat = 1, kFormatOfSeveral = 2;
static_assert(std::endian::native == std::endian::little, "shapes are written as they lie in memory");

Json to_json(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

Json to_json(const RigidTransform& pose) {
    const Rotation& q = pose.rotation;
    return {{"position", to_json(pose.translation)}, {"rotation", {q.w, q.x, q.y, q.z}}};
}

/// The part of report.json that a page shows.
Json figures_of(const SimulationResult& result) {
    return ::to_json(result).part({"particles", "sticks", "solver", "substeps", "iterations", "time_step",
                                   "frames", "frames_to_rest", "ms_per_frame", "queries_per_frame",
                                   "ns_per_query", "map_kind", "thickness", "gravity"});
}

Json to_json(const std::vector<RigidTransform>& poses) {
    Json list = Json::array();
    for (const RigidTransform& pose : poses) list.push_back(to_json(pose));
    return list;
}

Json frames_of(const Recording& recording, const Lattice& lattice, bool moves) {
    Json frames = Json::array();
    for (const RecordedFrame& frame : recording.frames()) {
        Json entry{
            {"number", frame.number}, {"inside", frame.inside_count}, {"origin", origin_of(frame, lattice)}};
        if (frame.pairs) {
            entry.add("intersecting_pairs", frame.pairs->with_models);
            entry.add("self_intersecting_pairs", frame.pairs->own);
        }
        if (moves || &frame == &recording.frames().front()) {
            if (frame.poses.size() == 1)
                entry.add("pose", to_json(frame.poses.front()));
            else
                entry.add("poses", to_json(frame.poses));
        }
        frames.push_back(std::move(entry));
    }
    return frames;
}

/// All colliders, each where it starts.
Sphere sphere_of(const PlayedSimulation& played) {
    if (played.colliders.size() == 1) return inspect(played.colliders.front()).bounding_sphere;
    TriangleMesh all;
    for (std::size_t c = 0; c < played.colliders.size(); ++c)
        for (const Vec3f& vertex : played.colliders[c].vertices)
            all.vertices.emplace_back(played.recording.frames().front().poses[c].to_world(Vec3d(vertex)));
    all.faces.push_back({0, 1, 2});
    return inspect(all).bounding_sphere;
}

/// How many vertices and faces each collider has.
Json parts_of(std::span<const TriangleMesh> colliders) {
    Json parts = Json::array();
    for (const TriangleMesh& mesh : colliders)
        parts.push_back({{"vertices", mesh.vertices.size()}, {"faces", mesh.faces.size()}});
    return parts;
}

Json description_of(const PlayedSimulation& played, const Lattice& lattice) {
    const Simulation& simulation = played.result.simulation;
    const Sphere sphere = sphere_of(played);
    std::size_t vertex_count = 0, face_count = 0;
    for (const TriangleMesh& mesh : played.colliders) {
        vertex_count += mesh.vertices.size();
        face_count += mesh.faces.size();
    }
    const bool moves = std::any_of(played.result.colliders.begin(), played.result.colliders.end(),
                                   [](const ColliderResult& collider) { return collider.poses.size() > 1; });
    Json model{{"name", played.model_name}, {"notice", played.notice},          {"vertices", vertex_count},
               {"faces", face_count},       {"centre", to_json(sphere.centre)}, {"radius", sphere.radius}};
    if (played.colliders.size() > 1) model.add("parts", parts_of(played.colliders));
    return {
        {"format", played.colliders.size() == 1 ? kFormat : kFormatOfSeveral},
        {"version", ECHINUS_VERSION},
        {"machine", describe_machine()},
        {"scene", played.scene_name},
        {"model", std::move(model)},
        {"cloth_faces", surface_of(simulation.deformable()).size()},
        {"lattice_step", lattice.step},
        {"figures", figures_of(played.result)},
        {"frames", frames_of(played.recording, lattice, moves)},
    };
}

/// JSON that may stand in an HTML script element: no name in it can end the element or begin a comment.
std::string in_script(const Json& object) {
    std::string text;
    // File names and notices need not be UTF-8; JSON must be.
    for (const char c : object.one_line()) c == '<' ? text += "\\u003c" : text += c;
    return text;
}

template <typename T>
std::span<const std::uint8_t> bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

std::vector<std::uint8_t> compressed(const PlayedSimulation& played, const Lattice& lattice) {
    static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Triangle) == 3 * sizeof(std::uint32_t));
    Deflater deflater;
    for (const TriangleMesh& mesh : played.colliders) deflater.add(bytes_of(mesh.vertices));
    for (const TriangleMesh& mesh : played.colliders) deflater.add(bytes_of(mesh.faces));
    deflater.add(bytes_of(surface_of(played.result.simulation.deformable())));
    add_motion(deflater, played.recording.frames(), lattice);
    return deflater.finish();
}

} // namespace

Player::Player(fs::path path) {
    if (path.empty()) path = installed_player();
    page_ = read_player(path);
    place_ = page_.find(kPlace);
    if (place_ != std::string::npos && page_.find(kPlace, place_ + 1) == std::string::npos) return;
    throw Error(ErrorCode::WrongFormat, path.string() + ": is no player: it must have the line " +
                                            std::string(kPlace) +
                                            " once; scripts/web --build-only builds one");
}

std::string_view Player::tail() const {
    return std::string_view(page_).substr(place_ + kPlace.size());
}

void write_player_page(Output& output, const Player& player, const PlayedSimulation& played) {
    const Lattice lattice = lattice_of(played.recording.frames());
    output.write(player.head());
    output.write("<script type=\"application/json\" id=\"description\">");
    output.write(in_script(description_of(played, lattice)));
    output.write("</script>\n<script type=\"text/plain\" id=\"data\">");
    output.write(base64(compressed(played, lattice)));
    output.write("</script>");
    output.write(player.tail());
    output.commit();
}
