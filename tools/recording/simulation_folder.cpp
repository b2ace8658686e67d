#include "recording/simulation_folder.hpp"

#include "mesh/local_frame.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/simulation.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

using namespace echinus;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// Reads values from report.json, and names a wrong value.
class ReportReader {
  public:
    explicit ReportReader(const fs::path& path) : name_(path.string()) {
        std::ifstream file(path);
        if (!file || fs::is_directory(path))
            throw Error(ErrorCode::Unreadable,
                        name_ + ": cannot be read; is this the folder of a simulation?");
        root_ = json::parse(file, nullptr, false);
        if (!root_.is_object()) fail("is not a JSON object");
    }

    const json& root() const { return root_; }

    [[noreturn]] void fail(const std::string& finding) const {
        throw Error(ErrorCode::Damaged, name_ + ": " + finding + "; simulate again");
    }
    const json& member(const json& object, const char* key) const {
        if (!object.is_object() || !object.contains(key)) fail(std::string("has no \"") + key + "\"");
        return object[key];
    }
    /// An array with at least one element.
    const json& list(const json& object, const char* key) const {
        const json& value = member(object, key);
        if (!value.is_array() || value.empty()) fail(std::string("has no \"") + key + "\"");
        return value;
    }
    double number(const json& value, const char* what) const {
        if (!value.is_number()) fail(std::string("\"") + what + "\" is not a number");
        return value.get<double>(); // JSON has no infinities
    }
    /// A row of numbers under a key.
    template <std::size_t count>
    std::array<double, count> numbers(const json& object, const char* key) const {
        const json& value = member(object, key);
        if (!value.is_array() || value.size() != count)
            fail(std::string("\"") + key + "\" is not an array of " + std::to_string(count) + " numbers");
        std::array<double, count> result;
        for (std::size_t i = 0; i < count; ++i) result[i] = number(value[i], key);
        return result;
    }

  private:
    std::string name_;
    json root_;
};

RigidTransform read_transform(const ReportReader& reader, const json& pose) {
    const auto [x, y, z] = reader.numbers<3>(pose, "translation");
    const auto q = reader.numbers<4>(pose, "rotation");
    const double size = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (!(size > 0.5 && size < 2)) reader.fail("a \"rotation\" is not a unit quaternion");
    return {Rotation{q[0], q[1], q[2], q[3]}.normalised(), {x, y, z}};
}

/// Reads runs of particles, each given by its first and last.
std::vector<std::uint8_t> read_let_through(const ReportReader& reader, const json& collider,
                                           std::size_t particle_count) {
    if (!collider.contains("lets_through")) return {};
    std::vector<std::uint8_t> passes(particle_count);
    for (const json& run : reader.list(collider, "lets_through")) {
        if (!run.is_array() || run.size() != 2 || !run[0].is_number_unsigned() ||
            !run[1].is_number_unsigned() || run[0] > run[1] || run[1] >= particle_count)
            reader.fail("\"lets_through\" does not consist of pairs of a first and a last particle");
        std::fill(passes.begin() + run[0].get<std::ptrdiff_t>(),
                  passes.begin() + run[1].get<std::ptrdiff_t>() + 1, std::uint8_t{1});
    }
    return passes;
}

SavedCollider read_collider(const ReportReader& reader, const json& collider, const fs::path& folder,
                            std::size_t particle_count) {
    SavedCollider saved;
    const json& mesh_name = reader.member(collider, "mesh");
    if (!mesh_name.is_string()) reader.fail("the collider's \"mesh\" is not a file name");
    saved.mesh = read_mesh(folder / mesh_name.get<std::string>());
    move_to_origin({}, saved.mesh);
    if (collider.contains("faces") && collider["faces"] != saved.mesh.faces.size())
        reader.fail("the collider's mesh has " + std::to_string(saved.mesh.faces.size()) +
                    " faces, which differs from \"faces\"");
    for (const json& pose : reader.list(collider, "poses")) {
        const double frame = reader.number(reader.member(pose, "frame"), "frame");
        if (!saved.poses.empty() && !(frame > saved.poses.back().frame))
            reader.fail("the poses' frames do not ascend");
        saved.poses.push_back({frame, read_transform(reader, pose)});
    }
    if (collider.contains("cache")) {
        const json& cache_name = collider["cache"];
        if (!cache_name.is_string()) reader.fail("the collider's \"cache\" is not a file name");
        saved.cache = std::make_shared<PointCacheReader>(folder / cache_name.get<std::string>());
        if (saved.cache->point_count() != saved.mesh.vertices.size())
            reader.fail("the collider's cache does not have the points of its mesh");
    }
    saved.passes = read_let_through(reader, collider, particle_count);
    return saved;
}

/// How different a cloth looks at two moments: the mean distance between its points, with little weight for
/// motion common to all, as in a fall.
double difference(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    constexpr double kWeightOfCommonMotion = 0.25;
    Vec3d common;
    for (std::size_t i = 0; i < a.size(); ++i) common += Vec3d(b[i]) - Vec3d(a[i]);
    common *= 1 / static_cast<double>(a.size());
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += length(Vec3d(b[i]) - Vec3d(a[i]) - common);
    return sum / static_cast<double>(a.size()) + kWeightOfCommonMotion * length(common);
}

/// Evenly spaced samples from the first to the last, enough for a choice among them to be as good as one
/// among all.
std::vector<std::size_t> candidates(std::size_t sample_count) {
    constexpr std::size_t kMost = 500;
    const std::size_t count = std::min(sample_count, kMost);
    std::vector<std::size_t> samples(count);
    for (std::size_t i = 0; i < count; ++i)
        samples[i] = count > 1 ? i * (sample_count - 1) / (count - 1) : sample_count - 1;
    return samples;
}

} // namespace

SimulationFolder::SimulationFolder(const fs::path& folder)
    : cache_(folder / "cloth.pc2"), cloth_(read_mesh_and_edges(folder / "cloth.obj")) {
    if (cloth_.mesh.vertices.size() != cache_.point_count())
        throw Error(ErrorCode::Damaged, (folder / "cloth.obj").string() + ": has " +
                                            std::to_string(cloth_.mesh.vertices.size()) +
                                            " vertices, but cloth.pc2 has " +
                                            std::to_string(cache_.point_count()) + " points; simulate again");
    read_report(folder / "report.json");
}

void SimulationFolder::read_report(const fs::path& path) {
    const ReportReader reader(path);
    // Folders from earlier versions, which had no "colliders", contain one collider.
    if (!reader.root().contains("colliders"))
        colliders_.push_back(read_collider(reader, reader.member(reader.root(), "collider"),
                                           path.parent_path(), cache_.point_count()));
    else
        for (const json& collider : reader.list(reader.root(), "colliders"))
            colliders_.push_back(read_collider(reader, collider, path.parent_path(), cache_.point_count()));
    for (const SavedCollider& collider : colliders_)
        if (collider.cache && collider.cache->sample_count() != sample_count())
            reader.fail("a collider's cache does not have as many samples as cloth.pc2");

    const auto [x, y, z] = reader.numbers<3>(reader.root(), "gravity");
    const Vec3d gravity{x, y, z};
    up_ = gravity == Vec3d{} ? Vec3d{0, 0, 1} : -gravity;
    const json& rest = reader.member(reader.root(), "frames_to_rest");
    if (!rest.is_null()) rest_frame_ = reader.number(rest, "frames_to_rest");
}

std::size_t SimulationFolder::sample_at(std::int64_t frame) const {
    const double last = static_cast<double>(sample_count() - 1);
    const double step = sample_count() > 1 ? frame_of(1) - frame_of(0) : 1;
    const double sample = std::round((static_cast<double>(frame) - frame_of(0)) / step);
    if (sample >= 0 && sample <= last) return static_cast<std::size_t>(sample);
    throw Error(ErrorCode::InvalidOptions, "there is no frame " + std::to_string(frame) + "; the first is " +
                                               std::to_string(std::lround(frame_of(0))) + ", the last " +
                                               std::to_string(std::lround(frame_of(sample_count() - 1))));
}

MeshAndEdges SimulationFolder::cloth(std::size_t sample) const {
    return {{cloth_positions(sample), cloth_.mesh.faces}, cloth_.edges};
}

TriangleMesh SimulationFolder::colliders(std::size_t sample) const {
    TriangleMesh all;
    for (const auto& [mesh, poses, cache, passes] : colliders_) {
        const auto after = std::upper_bound(
            poses.begin() + 1, poses.end(), frame_of(sample),
            [](double frame, const SavedCollider::Pose& pose) { return frame < pose.frame; });
        const RigidTransform& transform = std::prev(after)->transform;
        const auto first = static_cast<std::uint32_t>(all.vertices.size());
        const std::vector<Vec3f> vertices = cache ? cache->positions(sample) : mesh.vertices;
        for (const Vec3f& vertex : vertices) all.vertices.emplace_back(transform.to_world(Vec3d(vertex)));
        for (const auto& [a, b, c] : mesh.faces) all.faces.push_back({first + a, first + b, first + c});
    }
    return all;
}

void SimulationFolder::drop_let_through(const std::vector<Triangle>& surface,
                                        std::vector<FacePair>& pairs) const {
    std::size_t first = 0;
    for (const SavedCollider& collider : colliders_) {
        const std::size_t end = first + collider.mesh.faces.size();
        std::erase_if(pairs, [&](const FacePair& pair) {
            return pair.b >= first && pair.b < end && passes_through(surface[pair.a], collider.passes);
        });
        first = end;
    }
}

std::vector<std::size_t> choose_moments(const SimulationFolder& folder, std::size_t count) {
    const std::vector<std::size_t> samples = candidates(folder.sample_count());
    std::vector<double> distance_to_chosen(samples.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> chosen;
    const auto choose = [&](std::size_t candidate) {
        chosen.push_back(samples[candidate]);
        const std::vector<Vec3f> positions = folder.cloth_positions(samples[candidate]);
        for (std::size_t i = 0; i < samples.size(); ++i)
            distance_to_chosen[i] =
                std::min(distance_to_chosen[i], difference(positions, folder.cloth_positions(samples[i])));
        distance_to_chosen[candidate] = -1; // not to be chosen again, even if nothing moves
    };

    choose(samples.size() - 1);
    if (samples.size() > 1 && count > 1) choose(0);
    while (chosen.size() < std::min(count, samples.size())) {
        const auto farthest = std::max_element(distance_to_chosen.begin(), distance_to_chosen.end());
        choose(static_cast<std::size_t>(farthest - distance_to_chosen.begin()));
    }
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}
