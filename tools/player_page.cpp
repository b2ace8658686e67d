#include "player_page.hpp"

#include "base64.hpp"
#include "recording_code.hpp"
#include "rivals/compare/machine.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <bit>

using namespace echinus;
using nlohmann::ordered_json;

namespace {

constexpr int kFormat = 1;
static_assert(std::endian::native == std::endian::little, "shapes are written as they lie in memory");

ordered_json to_json(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

ordered_json to_json(const RigidTransform& pose) {
    const Rotation& q = pose.rotation;
    return {{"position", to_json(pose.translation)}, {"rotation", {q.w, q.x, q.y, q.z}}};
}

/// The part of report.json that a page shows.
ordered_json figures_of(const SimulationResult& result) {
    const ordered_json report = ::to_json(result);
    ordered_json figures;
    for (const char* key :
         {"particles", "sticks", "solver", "substeps", "iterations", "time_step", "frames", "frames_to_rest",
          "ms_per_frame", "queries_per_frame", "ns_per_query", "map_kind", "thickness", "gravity"})
        figures[key] = report.at(key);
    return figures;
}

ordered_json frames_of(const Recording& recording, const Lattice& lattice, bool moves) {
    ordered_json frames = ordered_json::array();
    for (const RecordedFrame& frame : recording.frames()) {
        ordered_json entry{
            {"number", frame.number}, {"inside", frame.inside_count}, {"origin", origin_of(frame, lattice)}};
        if (moves || frames.empty()) entry["pose"] = to_json(frame.pose);
        frames.push_back(std::move(entry));
    }
    return frames;
}

ordered_json description_of(const PlayedSimulation& played, const Lattice& lattice) {
    const Simulation& simulation = played.result.simulation;
    const Sphere sphere = inspect(played.collider).bounding_sphere;
    return {
        {"format", kFormat},
        {"version", ECHINUS_VERSION},
        {"machine", comparison::describe_machine()},
        {"scene", played.scene_name},
        {"model",
         {{"name", played.model_name},
          {"notice", played.notice},
          {"vertices", played.collider.vertices.size()},
          {"faces", played.collider.faces.size()},
          {"centre", to_json(sphere.centre)},
          {"radius", sphere.radius}}},
        {"cloth_faces", simulation.deformable().faces.size()},
        {"cloth_columns", played.cloth_columns},
        {"lattice_step", lattice.step},
        {"figures", figures_of(played.result)},
        {"frames", frames_of(played.recording, lattice, simulation.colliders().front().moves())},
    };
}

/// JSON that may stand in an HTML script element: no name in it can end the element or begin a comment.
std::string in_script(const ordered_json& object) {
    std::string text;
    // File names and notices need not be UTF-8; JSON must be.
    for (const char c : object.dump(-1, ' ', false, ordered_json::error_handler_t::replace))
        c == '<' ? text += "\\u003c" : text += c;
    return text;
}

template <typename T>
std::span<const std::uint8_t> bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

std::vector<std::uint8_t> compressed(const PlayedSimulation& played, const Lattice& lattice) {
    static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Triangle) == 3 * sizeof(std::uint32_t));
    Deflater deflater;
    deflater.add(bytes_of(played.collider.vertices));
    deflater.add(bytes_of(played.collider.faces));
    deflater.add(bytes_of(played.result.simulation.deformable().faces));
    add_motion(deflater, played.recording.frames(), lattice);
    return deflater.finish();
}

} // namespace

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
