// Writes the expected results of the JavaScript module: meshes, particles and, by this machine's scalar
// reference, maps, answers and the states of simulations. tests/wasm/bits.test.mjs reads them.

#include "support/point_sets.hpp"

#include <echinus/error.hpp>
#include <echinus/instruction_set.hpp>
#include <echinus/map_file.hpp>
#include <echinus_scene/scene.hpp>

#include <nlohmann/json.hpp>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <vector>

using namespace echinus;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

template <typename T>
void write(const fs::path& path, const std::vector<T>& values) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(T)));
    file.close();
    if (!file) throw Error(ErrorCode::Unwritable, path.string() + ": cannot be written");
}

struct Subject {
    std::string name;
    TriangleMesh mesh;
};

TriangleMesh without_last_face(TriangleMesh mesh) {
    mesh.faces.pop_back();
    return mesh;
}

TriangleMesh far_away(TriangleMesh mesh) {
    for (Vec3f& v : mesh.vertices) v = Vec3f(Vec3d(v) * 0.001 + Vec3d{1000, -2000, 500});
    return mesh;
}

std::vector<Subject> subjects() {
    const TriangleMesh torus = make_torus(1, 0.4, 30, 12);
    return {{"torus", torus},
            {"sphere", make_sphere(2.5, 24, 12)},
            {"box", make_box({2, 3, 4}, 3)},
            {"large_torus", make_torus(1, 0.3, 150, 60)},
            {"open_torus", without_last_face(torus)},
            {"open_box", without_last_face(make_box({2, 3, 4}))},
            {"torus_far_away", far_away(torus)}};
}

/// Options of maps, as in scenes.
const char* const kMaps[] = {
    R"({})",
    R"({"cells_per_octant": 4})",
    R"({"rule": "parity", "centre": "search"})",
    R"({"kind": "distance", "directions": [64, 48]})",
    R"({"kind": "distance", "directions": [48, 64], "pole_axis": "x", "entries": "unorm16", "correction": "paper"})",
    R"({"kind": "distance", "grid": "octahedral", "divisions": 20})",
    R"({"kind": "distance", "grid": "octahedral", "divisions": 20, "entries": "unorm16"})",
    R"({"kind": "distance", "grid": "cube", "divisions": 16, "correction": "none"})",
};

/// Everywhere, near the surface, on it, far away and not finite.
std::vector<Vec3f> particles_of(const TriangleMesh& mesh) {
    std::vector<Vec3f> points = test::uniform_points(mesh, 600);
    const std::vector<Vec3f> near = test::surface_points(mesh, 600);
    points.insert(points.end(), near.begin(), near.end());
    for (std::size_t i = 0; i < mesh.vertices.size() && i < 100; ++i) points.push_back(mesh.vertices[i]);
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (const Vec3f& strange : {Vec3f{}, Vec3f{kNan, 0, 0}, Vec3f{0, kInfinity, 0}, Vec3f{0, 0, -kInfinity},
                                 Vec3f{1e30F, 1e30F, 1e30F}, Vec3f{-3e38F, 0, 0}, Vec3f{1e-40F, 0, 1e-45F}})
        points.push_back(strange);
    return points;
}

/// Bytes of contacts, with zeros where the compiler leaves gaps.
std::vector<char> bytes_of(const std::vector<Contact>& contacts) {
    constexpr std::size_t kUsed = offsetof(Contact, feature) + sizeof(Feature);
    std::vector<char> bytes(contacts.size() * sizeof(Contact));
    for (std::size_t i = 0; i < contacts.size(); ++i)
        std::memcpy(&bytes[i * sizeof(Contact)], &contacts[i], kUsed);
    return bytes;
}

json write_answers(const fs::path& folder, const std::string& name, const TriangleMesh& mesh,
                   const std::vector<Vec3f>& particles, const char* options) {
    const AnyMap map = build_map(mesh, parse_map_options(options, "options"), 1);
    const float margin = std::visit([](const auto& kind) { return kind.view().radius; }, map) / 20;
    std::vector<std::uint8_t> inside;
    std::vector<Contact> contacts;
    for (const Vec3f& particle : particles) {
        inside.push_back(contains(map, particle) ? 1 : 0);
        contacts.push_back(contact(map, particle, margin));
    }
    write(folder / (name + ".ech"), serialise(map));
    write(folder / (name + ".inside"), inside);
    write(folder / (name + ".contacts"), bytes_of(contacts));
    return {{"name", name}, {"options", options}, {"margin", margin}};
}

json write_subject(const fs::path& folder, const Subject& subject) {
    const std::vector<Vec3f> particles = particles_of(subject.mesh);
    write(folder / (subject.name + ".vertices"), subject.mesh.vertices);
    write(folder / (subject.name + ".faces"), subject.mesh.faces);
    write(folder / (subject.name + ".particles"), particles);
    json maps = json::array();
    for (const char* options : kMaps) {
        const std::string name = subject.name + "_" + std::to_string(maps.size());
        maps.push_back(write_answers(folder, name, subject.mesh, particles, options));
    }
    return {{"name", subject.name}, {"maps", maps}};
}

/// Parts of scenes; the rest is that of kScene.
const char* const kSimulations[] = {
    R"({})",
    R"({"map": {"kind": "distance"}, "solver": "jakobsen"})",
    R"({"map": {"kind": "distance", "grid": "octahedral"}, "solver": "jakobsen", "iterations": 5})",
    R"({"solver": "jakobsen", "collider": {"angular_velocity": [0, 90, 30], "scale": [1, 1.2, 0.9]}})",
    R"({"collider": {"position": [0.1, 0, -0.6], "rotation": {"axis": [1, 1, 0], "degrees": 30}, "linear_velocity": [0, 0, 1]},
        "material": {"friction": 0.1, "air_drag": 2}})",
    R"({"collider": {"angular_velocity": [0, 0, 90]}, "cloth": {"size": null, "particles": null, "pins": null,
        "mesh": {"sphere": {"radius": 0.9, "segments": [40, 20]}}, "position": [0, 0, 1.2], "attachments": [3]}})",
    R"({"cloth": {"size": null, "particles": null, "pins": null,
        "mesh": {"torus": {"major": 1, "minor": 0.3, "segments": [30, 12]}}, "position": [0.2, 0, 0.8]}})",
    R"({"collision": "surfaces", "collider": {"angular_velocity": [0, 0, 90]}})",
};
const char* const kScene = R"({
    "model": {"torus": {"segments": [40, 16]}},
    "cloth": {"particles": [21, 20], "size": [3, 3], "position": [0, 0, 0.45], "thickness": 0.014, "pins": [[0, 0]]}
})";
constexpr std::uint32_t kFrameCount = 20;

std::string hexadecimal(std::uint64_t number) {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(number));
    return digits;
}

/// @param growth  the model's vertices lie 1 + growth * frame times as far from the origin
json run_simulation(const char* part, float growth) {
    json description = json::parse(kScene);
    description.merge_patch(json::parse(part));
    const Scene scene = parse_scene(description.dump(), "scene");
    const TriangleMesh model = make_mesh(std::get<TorusModel>(scene.colliders.front().model));
    Simulation simulation = make_simulation(scene, build_map(model, scene.map, 1));
    for (std::uint32_t frame = 1; frame <= kFrameCount; ++frame) {
        if (growth != 0) {
            std::vector<Vec3f> grown = model.vertices;
            for (Vec3f& vertex : grown) vertex = vertex * (1 + growth * static_cast<float>(frame));
            simulation.set_collider_vertices(0, grown);
        }
        simulation.step();
    }
    return {{"scene", description},
            {"growth", growth},
            {"frames", kFrameCount},
            {"hash", hexadecimal(simulation.state_hash())},
            {"queryCount", simulation.profile().query_count},
            {"contactCount", simulation.profile().contact_count},
            {"lostCount", simulation.profile().lost_count}};
}

void write_reference(const fs::path& folder) {
    use_instruction_set("scalar");
    fs::create_directories(folder);
    json reference{{"subjects", json::array()}, {"simulations", json::array()}};
    for (const Subject& subject : subjects()) reference["subjects"].push_back(write_subject(folder, subject));
    for (const char* part : kSimulations) reference["simulations"].push_back(run_simulation(part, 0));
    reference["simulations"].push_back(run_simulation("{}", 1.0F / 256));
    const std::string text = reference.dump(1);
    write(folder / "reference.json", std::vector<char>(text.begin(), text.end()));
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: echinus-wasm-reference FOLDER\n";
        return 2;
    }
    try {
        write_reference(argv[1]);
    } catch (const std::exception& error) {
        std::cerr << "echinus-wasm-reference: " << error.what() << '\n';
        return 1;
    }
}
