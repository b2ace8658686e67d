#include "simulation/deforming_collider.hpp"

#include "collider/frame_change.hpp"
#include "files/text.hpp"
#include "simulation/start/validation.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <echinus/error.hpp>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace echinus {

namespace {

std::uint64_t hash_of(const VertexCache& cache) {
    const std::array<double, 2> times{cache.start_time, cache.sample_seconds};
    return XXH64(cache.samples->data(), cache.samples->size() * sizeof(Vec3f),
                 XXH64(times.data(), sizeof times, cache.vertex_count));
}

Vec3f scaled(const Vec3f& local, const Vec3d& scale) {
    return Vec3f(times(Vec3d(local), scale));
}

} // namespace

std::array<float, 3> shares_in(const std::array<Vec3f, 3>& corners, const Vec3f& point) {
    const Vec3f ab = corners[1] - corners[0], ac = corners[2] - corners[0], ap = point - corners[0];
    const float bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
    const float pb = dot(ap, ab), pc = dot(ap, ac);
    const float determinant = bb * cc - bc * bc;
    // A triangle without an area counts as its longer edge.
    if (!(determinant > 1e-12F * bb * cc)) {
        const bool along_b = bb >= cc;
        const float size = along_b ? bb : cc;
        const float share = size > 0 ? std::clamp((along_b ? pb : pc) / size, 0.0F, 1.0F) : 0;
        return {1 - share, along_b ? share : 0, along_b ? 0 : share};
    }
    const float b = std::clamp((cc * pb - bc * pc) / determinant, 0.0F, 1.0F);
    const float c = std::clamp((bb * pc - bc * pb) / determinant, 0.0F, 1 - b);
    return {1 - b - c, b, c};
}

/// Calls build(). Adds to its error whose map could not be built.
template <typename Build>
ExactMap DeformingCollider::naming_it(const std::string& vertices, const Build& build) const {
    try {
        return build();
    } catch (const Error& error) {
        throw Error(error.code(), name_ + vertices + ": " + error.what());
    }
}

DeformingCollider::DeformingCollider(const ExactMap& map, std::string name)
    : name_(std::move(name)), first_map_(map) {
    const ExactMapView& view = map.view();
    const TriangleMesh in_map_order = model_mesh(view, {1, 1, 1});
    std::vector<Triangle> faces(view.face_count());
    for (std::size_t f = 0; f < faces.size(); ++f) faces[view.face_numbers[f]] = in_map_order.faces[f];
    faces_ = std::make_shared<const std::vector<Triangle>>(std::move(faces));
    vertices_ = in_map_order.vertices;
    options_ = {.rule = view.rule, .find_certain_gaps = false, .thread_count = 1};
}

DeformingCollider::DeformingCollider(const DeformingCollider& other)
    : name_(other.name_), first_map_(other.first_map_), has_deformed_(other.has_deformed_),
      faces_(other.faces_), options_(other.options_), vertices_(other.vertices_), cache_(other.cache_),
      cache_hash_(other.cache_hash_), next_vertices_(other.next_vertices_), next_map_(other.next_map_) {}

void DeformingCollider::lead_to(std::span<const Vec3f> vertices_local) {
    if (vertices_local.size() != vertices_.size())
        throw Error(ErrorCode::InvalidOptions,
                    name_ + " has " + std::to_string(vertices_.size()) +
                        " vertices, and was given positions for " + std::to_string(vertices_local.size()) +
                        "; a model deforms with the faces and vertices that it has");
    for (std::size_t i = 0; i < vertices_local.size(); ++i)
        if (!is_finite(vertices_local[i]))
            throw Error(ErrorCode::InvalidOptions,
                        name_ + ": the position of vertex " + std::to_string(i) + " is not finite");
    next_map_ = naming_it(", with the vertices that it was given", [&] { return built_of(vertices_local); });
    next_vertices_.assign(vertices_local.begin(), vertices_local.end());
}

ExactMap DeformingCollider::built_of(std::span<const Vec3f> vertices) {
    std::optional<ExactMapBuilder>& builder = builders_[turn_];
    if (!builder) builder.emplace(*faces_, options_);
    ExactMap map = builder->rebuild(vertices);
    turn_ = 1 - turn_;
    return map;
}

void DeformingCollider::follow(VertexCache cache) {
    require_valid(cache, vertices_.size(), name_);
    cache_ = std::move(cache);
    cache_hash_ = hash_of(*cache_);
    prepared_map_.reset();
}

std::array<Vec3f, 3> DeformingCollider::corners(const Triangle& face, const Vec3d& scale) const {
    return {scaled(vertices_[face[0]], scale), scaled(vertices_[face[1]], scale),
            scaled(vertices_[face[2]], scale)};
}

bool DeformingCollider::has_arrived(double time) const {
    return !cache_ || time >= cache_->end_time();
}

void DeformingCollider::build_ahead(double end_time) {
    if (!cache_) return;
    std::vector<Vec3f> goal = vertices_at(*cache_, end_time);
    if (prepared_map_ && goal == prepared_vertices_) return;
    prepared_map_.reset();
    if (goal == vertices_) return;
    prepared_map_ =
        naming_it(", with the vertices of " + name_of(*cache_) + " at " + number_text(end_time) + " s",
                  [&] { return built_of(goal); });
    prepared_vertices_ = std::move(goal);
}

void DeformingCollider::begin_frame(Collider& collider) {
    if (prepared_map_) {
        next_map_ = std::exchange(prepared_map_, std::nullopt);
        next_vertices_ = prepared_vertices_;
    }
    deforms_ = next_map_.has_value() && next_vertices_ != vertices_;
    if (deforms_) find_motion(collider);
    if (!next_map_) return;
    collider.map = *next_map_;
    has_deformed_ = true;
    next_map_.reset();
    std::swap(vertices_, next_vertices_);
}

void DeformingCollider::archive(StateArchive& state, Collider& collider) {
    bool has_cache = cache_.has_value();
    std::uint64_t hash = cache_hash_;
    state.flag(has_cache);
    state.value(hash);
    if (state.reads() && has_cache && !(cache_ && hash == cache_hash_))
        throw Error(ErrorCode::InvalidOptions,
                    name_ + " followed a vertex cache when the state was saved, and follows " +
                        (cache_ ? "another one" : "none") + " here; set that cache first");
    if (!has_cache) cache_.reset();
    state.flag(has_deformed_);
    state.array(vertices_);
    bool is_led = next_map_.has_value();
    state.flag(is_led);
    if (is_led) {
        next_vertices_.resize(vertices_.size());
        state.array(next_vertices_);
    }
    if (!state.reads()) return;
    deforms_ = false;
    prepared_map_.reset();
    for (const std::vector<Vec3f>* points : {&vertices_, &next_vertices_})
        for (const Vec3f& p : *points) state.require(is_finite(p));
    collider.map = has_deformed_ ? archived_map(state, vertices_) : first_map_;
    next_map_.reset();
    if (is_led) next_map_ = archived_map(state, next_vertices_);
}

ExactMap DeformingCollider::archived_map(const StateArchive& state, std::span<const Vec3f> vertices) {
    try {
        return built_of(vertices);
    } catch (const Error&) {
        state.require(false); // the vertices had a map when they were saved
        throw;
    }
}

void DeformingCollider::find_motion(const Collider& collider) {
    const std::size_t count = vertices_.size();
    motion_.from.resize(count);
    motion_.to.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        motion_.from.set(i, scaled(vertices_[i], collider.scale));
        motion_.to.set(i, scaled(next_vertices_[i], collider.scale));
    }
}

} // namespace echinus
