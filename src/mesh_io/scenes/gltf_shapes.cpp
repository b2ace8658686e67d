#include "mesh_io/scenes/gltf_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace echinus {

namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

// OpenGL's names for the order of corners in primitives.
enum Mode : std::size_t { Points, Lines, LineLoop, LineStrip, Triangles, TriangleStrip, TriangleFan };

Mode mode_of(const GltfValue& primitive) {
    const GltfValue mode = primitive.member("mode");
    const std::size_t number = mode.optional_number().value_or(Triangles);
    if (number > TriangleFan) mode.fail("is " + std::to_string(number) + ", which is not a mode of glTF");
    return static_cast<Mode>(number);
}

void add(std::initializer_list<std::uint32_t> corners, SceneShape& shape) {
    shape.corners.insert(shape.corners.end(), corners);
    shape.corner_counts.push_back(static_cast<std::uint32_t>(corners.size()));
}

/// A strip that continues elsewhere contains triangles with a repeated corner.
void add_triangle_of_strip(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                           const std::vector<Vec3d>& positions, SceneShape& shape) {
    if (positions[a] != positions[b] && positions[b] != positions[c] && positions[c] != positions[a])
        add({a, b, c}, shape);
}

void add_list(const std::vector<std::uint32_t>& corners, std::uint32_t polygon_size,
              const GltfValue& primitive, SceneShape& shape) {
    if (corners.size() % polygon_size != 0)
        primitive.fail("has " + std::to_string(corners.size()) + " corners, not a multiple of " +
                       std::to_string(polygon_size));
    shape.corners = corners;
    shape.corner_counts.assign(corners.size() / polygon_size, polygon_size);
}

void add_polygons(const std::vector<std::uint32_t>& corners, const std::vector<Vec3d>& positions,
                  const GltfValue& primitive, SceneShape& shape) {
    const std::size_t count = corners.size();
    switch (const Mode mode = mode_of(primitive)) {
    case Points:
        return;
    case Lines:
        return add_list(corners, 2, primitive, shape);
    case LineLoop:
    case LineStrip:
        for (std::size_t i = 1; i < count; ++i) add({corners[i - 1], corners[i]}, shape);
        if (mode == LineLoop && count > 1) add({corners.back(), corners.front()}, shape);
        return;
    case Triangles:
        return add_list(corners, 3, primitive, shape);
    case TriangleStrip: // every other triangle of a strip has the reverse orientation
        for (std::size_t i = 0; i + 2 < count; ++i)
            add_triangle_of_strip(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2], positions,
                                  shape);
        return;
    case TriangleFan:
        for (std::size_t i = 0; i + 2 < count; ++i)
            add_triangle_of_strip(corners[i + 1], corners[i + 2], corners[0], positions, shape);
        return;
    }
}

std::string name_of_mesh(const GltfValue& mesh) {
    const std::string name = mesh.member("name").string();
    return mesh.path() + (name.empty() ? "" : " (" + in_quotes(name) + ")");
}

} // namespace

const std::vector<std::size_t>& GltfShapes::shapes_of(const GltfValue& user) {
    const GltfValue& mesh = file_.element("meshes", user);
    const auto [entry, is_new] = shapes_of_meshes_.try_emplace(user.natural_number());
    if (!is_new) return entry->second;
    for (const GltfValue& primitive : mesh.member("primitives").elements()) {
        // Primitives without positions are skipped (section 3.7.2.1), and those of points have no faces.
        if (!primitive.member("attributes").member("POSITION").exists() || mode_of(primitive) == Points)
            continue;
        entry->second.push_back(shapes_.size());
        shapes_.push_back(make_shape(primitive, name_of_mesh(mesh)));
    }
    return entry->second;
}

SceneShape GltfShapes::make_shape(const GltfValue& primitive, const std::string& name) {
    const GltfValue position = primitive.member("attributes").member("POSITION");
    if (primitive.member("extensions").member("KHR_draco_mesh_compression").exists() &&
        !GltfAccessor(file_, position).has_own_bytes())
        primitive.fail("is compressed by KHR_draco_mesh_compression, which is not read; export it without",
                       ErrorCode::WrongFormat);
    const std::vector<Vec3d>& positions = positions_of(position);
    SceneShape shape;
    shape.name = name;
    add_polygons(corners_of(primitive, positions.size(), name), positions, primitive, shape);
    const std::vector<std::uint32_t> used = keep_used_vertices(positions.size(), shape);
    for (const std::uint32_t vertex : used) shape.vertices.push_back(positions[vertex]);
    read_targets(primitive, positions.size(), used, shape);
    read_influences(primitive, positions.size(), used, shape);
    return shape;
}

const std::vector<Vec3d>& GltfShapes::positions_of(const GltfValue& user) {
    const auto [entry, is_new] = positions_.try_emplace(user.natural_number());
    std::vector<Vec3d>& positions = entry->second;
    if (!is_new) return positions;
    const GltfAccessor accessor(file_, user);
    accessor.require_width(3);
    file_.spend(accessor.count());
    positions.reserve(accessor.count());
    for (std::size_t i = 0; i < accessor.count(); ++i) {
        positions.push_back(accessor.vector(i));
        if (!is_finite(positions.back()))
            user.fail("has the vertex " + std::to_string(i) + ", which is not finite");
    }
    return positions;
}

std::vector<std::uint32_t> GltfShapes::corners_of(const GltfValue& primitive, std::size_t vertex_count,
                                                  const std::string& name) {
    const GltfValue indices = primitive.member("indices");
    std::vector<std::uint32_t> corners;
    if (!indices.exists()) {
        file_.spend(vertex_count);
        corners.resize(vertex_count);
        std::iota(corners.begin(), corners.end(), 0U);
        return corners;
    }
    const GltfAccessor accessor(file_, indices);
    accessor.require_width(1);
    accessor.require_natural_numbers();
    file_.spend(accessor.count());
    corners.reserve(accessor.count());
    for (std::size_t i = 0; i < accessor.count(); ++i) {
        corners.push_back(accessor.natural_number(i));
        if (corners.back() >= vertex_count)
            file_.source().fail(ErrorCode::InvalidMesh,
                                "a face of " + name + " refers to vertex " + std::to_string(corners.back()) +
                                    ", but there are " + std::to_string(vertex_count) +
                                    " vertices, numbered from 0");
    }
    return corners;
}

/// Renumbers the corners' vertices.
/// @return the old numbers, ascending
std::vector<std::uint32_t> GltfShapes::keep_used_vertices(std::size_t vertex_count, SceneShape& shape) {
    if (new_numbers_.size() < vertex_count) new_numbers_.resize(vertex_count, kUnused);
    std::vector<std::uint32_t> used;
    for (const std::uint32_t vertex : shape.corners) {
        if (new_numbers_[vertex] == kUnused) used.push_back(vertex);
        new_numbers_[vertex] = 0;
    }
    std::sort(used.begin(), used.end());
    for (std::size_t i = 0; i < used.size(); ++i) new_numbers_[used[i]] = static_cast<std::uint32_t>(i);
    for (std::uint32_t& vertex : shape.corners) vertex = new_numbers_[vertex];
    for (const std::uint32_t vertex : used) new_numbers_[vertex] = kUnused;
    return used;
}

void GltfShapes::read_targets(const GltfValue& primitive, std::size_t vertex_count,
                              const std::vector<std::uint32_t>& used, SceneShape& shape) {
    for (const GltfValue& target : primitive.member("targets").elements()) {
        std::vector<Vec3d>& displacements = shape.targets.emplace_back(used.size());
        file_.spend(used.size() + 1);
        const GltfValue position = target.member("POSITION");
        if (!position.exists()) continue;
        const GltfAccessor accessor(file_, position);
        accessor.require_width(3);
        accessor.require_count(vertex_count);
        for (std::size_t i = 0; i < used.size(); ++i) displacements[i] = accessor.vector(used[i]);
    }
}

void GltfShapes::read_influences(const GltfValue& primitive, std::size_t vertex_count,
                                 const std::vector<std::uint32_t>& used, SceneShape& shape) {
    const GltfValue attributes = primitive.member("attributes");
    std::vector<GltfAccessor> joints, weights; // sets of four each
    for (std::size_t set = 0;; ++set) {
        const std::string number = std::to_string(set);
        const GltfValue joint = attributes.member(("JOINTS_" + number).c_str());
        const GltfValue weight = attributes.member(("WEIGHTS_" + number).c_str());
        if (!joint.exists() && !weight.exists()) break;
        if (!joint.exists()) weight.fail("has no JOINTS_" + number + " beside it; export the file again");
        if (!weight.exists()) joint.fail("has no WEIGHTS_" + number + " beside it; export the file again");
        joints.emplace_back(file_, joint).require_natural_numbers();
        weights.emplace_back(file_, weight);
        for (const GltfAccessor& accessor : {joints.back(), weights.back()}) {
            accessor.require_width(4);
            accessor.require_count(vertex_count);
        }
    }
    if (joints.empty()) return;
    file_.spend(4 * joints.size() * used.size());
    for (const std::uint32_t vertex : used) {
        const std::size_t first = shape.influences.size();
        shape.first_influences.push_back(static_cast<std::uint32_t>(first));
        double sum = 0;
        for (std::size_t set = 0; set < joints.size(); ++set)
            for (std::size_t k = 0; k < 4; ++k) {
                const double weight = weights[set].number(vertex, k);
                if (!std::isfinite(weight))
                    file_.source().fail(ErrorCode::InvalidMesh, "vertex " + std::to_string(vertex) + " of " +
                                                                    shape.name +
                                                                    " has a weight that is not finite");
                if (weight <= 0) continue;
                shape.influences.push_back({joints[set].natural_number(vertex, k), weight});
                sum += weight;
            }
        if (sum == 0 && !shape.boneless_vertex) shape.boneless_vertex = vertex;
        for (std::size_t i = first; i < shape.influences.size(); ++i) {
            shape.influences[i].weight /= sum;
            shape.bone_count = std::max(shape.bone_count, std::size_t{shape.influences[i].bone} + 1);
        }
    }
    shape.first_influences.push_back(static_cast<std::uint32_t>(shape.influences.size()));
}

} // namespace echinus
