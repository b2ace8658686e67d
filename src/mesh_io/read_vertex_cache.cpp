#include "files/read_file.hpp"
#include "mesh/local_frame.hpp"
#include "mesh/seams.hpp"
#include "mesh_io/mesh_source.hpp"
#include "mesh_io/point_cache.hpp"
#include "mesh_io/readers.hpp"
#include "mesh_io/scenes/scene_file.hpp"

#include <echinus/collider.hpp>
#include <echinus/error.hpp>
#include <echinus/mesh.hpp>
#include <echinus/mesh_io.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace echinus {

namespace {

constexpr std::size_t kMostCachePositions = std::size_t{1} << 28; // 3.2 GB

constexpr std::array<std::string_view, 3> kEndings{".gltf", ".glb", ".3ds"};

/// The mesh of the file as read_mesh() returns it, with the source of each vertex.
WeldedMesh mesh_of(const SceneFile& file, const MeshSource& source) {
    return weld_with_sources(triangulate(join(file, source), source));
}

void require_same(const TriangleMesh& found, const TriangleMesh& mesh, const MeshSource& source) {
    if (found.faces != mesh.faces || found.vertices.size() != mesh.vertices.size())
        source.fail(ErrorCode::InvalidMesh,
                    "has other faces than the model: " + std::to_string(found.faces.size()) + " of " +
                        std::to_string(found.vertices.size()) + " vertices, the model has " +
                        std::to_string(mesh.faces.size()) + " of " + std::to_string(mesh.vertices.size()) +
                        "; give this file as the model, too");
}

/// One sample for each frame, up to the last key or just after it.
std::size_t count_samples(double seconds, double frames_per_second, std::size_t vertex_count,
                          const MeshSource& source) {
    constexpr double kRounding = 1e-6; // of a frame, by which key times may be off
    const double count = 1 + std::ceil(std::max(0.0, seconds * frames_per_second - kRounding));
    if (!(count * static_cast<double>(vertex_count) <= static_cast<double>(kMostCachePositions)))
        source.fail(ErrorCode::InvalidMesh,
                    "the animation lasts " + std::to_string(seconds) + " s, and at " +
                        std::to_string(frames_per_second) +
                        " frames per second it has too many samples for " + std::to_string(vertex_count) +
                        " vertices: at most " + std::to_string(kMostCachePositions) +
                        " positions are kept; use fewer frames per second or a shorter animation");
    return static_cast<std::size_t>(count);
}

void require_motion(const std::vector<Vec3f>& samples, std::size_t vertex_count, const MeshSource& source) {
    for (std::size_t i = vertex_count; i < samples.size(); ++i)
        if (samples[i] != samples[i % vertex_count]) return;
    source.fail(ErrorCode::InvalidMesh,
                "the animation moves no vertex: the mesh has no bones that it moves, and belongs to no node "
                "that it moves; bind the mesh to the skeleton");
}

/// Do files with this extension contain animations that read_animation() reads?
bool has_animations(const std::filesystem::path& path) {
    return std::find(kEndings.begin(), kEndings.end(), lower_case_ending(path)) != kEndings.end();
}

/// read_vertex_cache() for a file with a mesh and an animation.
/// @throws Error as read_vertex_cache() does
VertexCache read_animation(const std::filesystem::path& path, const TriangleMesh& mesh,
                           double frames_per_second, std::string_view animation) {
    const auto source_of = [&](std::span<const std::byte> bytes) {
        return MeshSource{path.string(), {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
    };
    const std::vector<std::byte> bytes =
        read_file(path, [&](auto beginning) { require_beginning(source_of(beginning)); });
    const MeshSource source = source_of(bytes);
    const SceneFile file = read_scene_file(source, Wanted::Animation);
    const WeldedMesh welded = mesh_of(read_scene_file(source, Wanted::Mesh), source);
    require_same(welded.mesh, mesh, source);
    const NodeAnimation nodes(file, choose_animation(file, animation, source), source);

    const std::size_t vertex_count = welded.sources.size();
    const std::size_t sample_count = count_samples(nodes.seconds(), frames_per_second, vertex_count, source);
    auto samples = std::make_shared<std::vector<Vec3f>>();
    samples->reserve(sample_count * vertex_count);
    for (std::size_t i = 0; i < sample_count; ++i) {
        const Pose pose = nodes.pose_at(static_cast<double>(i) / frames_per_second);
        const std::vector<Vec3d> vertices = vertices_in(file, pose, source);
        for (const std::uint32_t vertex : welded.sources) samples->emplace_back(vertices[vertex]);
    }
    require_motion(*samples, vertex_count, source);
    return {.start_time = 0,
            .sample_seconds = 1 / frames_per_second,
            .vertex_count = vertex_count,
            .samples = std::move(samples)};
}

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& finding) {
    throw Error(ErrorCode::InvalidMesh,
                path.string() + ": " + finding + "; a vertex cache has to be made of the model's own mesh");
}

VertexCache from_point_cache(const fs::path& path, const TriangleMesh& mesh, double frames_per_second) {
    const PointCacheReader reader(path);
    if (reader.point_count() != mesh.vertices.size())
        refuse(path, "has " + std::to_string(reader.point_count()) + " points, but the model has " +
                         std::to_string(mesh.vertices.size()) +
                         " vertices (equal positions count once, vertices without faces not at all)");
    auto samples = std::make_shared<std::vector<Vec3f>>();
    samples->reserve(reader.sample_count() * mesh.vertices.size());
    for (std::size_t i = 0; i < reader.sample_count(); ++i) {
        const std::vector<Vec3f> positions = reader.positions(i);
        samples->insert(samples->end(), positions.begin(), positions.end());
    }
    const double step = reader.sample_count() > 1 ? reader.frame_of(1) - reader.frame_of(0) : 1;
    return {.start_time = reader.frame_of(0) / frames_per_second,
            .sample_seconds = step / frames_per_second,
            .vertex_count = mesh.vertices.size(),
            .samples = std::move(samples)};
}

/// The meshes of a folder, by name.
std::vector<fs::path> meshes_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().extension() == ".obj") files.push_back(entry.path());
    if (files.empty()) refuse(folder, "has no OBJ files");
    std::sort(files.begin(), files.end());
    return files;
}

VertexCache from_folder(const fs::path& folder, const TriangleMesh& mesh, double frames_per_second) {
    auto samples = std::make_shared<std::vector<Vec3f>>();
    for (const fs::path& file : meshes_in(folder)) {
        const TriangleMesh sample = read_mesh(file);
        if (sample.faces != mesh.faces || sample.vertices.size() != mesh.vertices.size())
            refuse(file, "has other faces than the model: " + std::to_string(sample.faces.size()) + " of " +
                             std::to_string(sample.vertices.size()) + " vertices, the model has " +
                             std::to_string(mesh.faces.size()) + " of " +
                             std::to_string(mesh.vertices.size()));
        require_no_origin(sample.origin, file.string() + ": the model");
        samples->insert(samples->end(), sample.vertices.begin(), sample.vertices.end());
    }
    return {.start_time = 0,
            .sample_seconds = 1 / frames_per_second,
            .vertex_count = mesh.vertices.size(),
            .samples = std::move(samples)};
}

} // namespace

VertexCache read_vertex_cache(const fs::path& path, const TriangleMesh& mesh, double frames_per_second,
                              std::string_view animation) {
    require_no_origin(mesh.origin, path.string() + ": the model");
    const bool is_folder = fs::is_directory(path), is_animated = !is_folder && has_animations(path);
    if (!is_animated && !animation.empty())
        refuse(path,
               "has no animation " + in_quotes(animation) + ", since only glTF, GLB and 3DS files have any");
    VertexCache cache = is_animated ? read_animation(path, mesh, frames_per_second, animation)
                        : is_folder ? from_folder(path, mesh, frames_per_second)
                                    : from_point_cache(path, mesh, frames_per_second);
    cache.name = path.string();
    return cache;
}

} // namespace echinus
