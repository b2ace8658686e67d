#include "mesh/local_frame.hpp"
#include "mesh_io/mesh_source.hpp"
#include "mesh_io/point_cache.hpp"
#include "mesh_io/read_animation.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace echinus {

namespace {

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
