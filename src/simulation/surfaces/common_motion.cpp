#include "simulation/surfaces/common_motion.hpp"

#include <algorithm>

namespace echinus {

namespace {

UnionFind connected_parts(const Deformable& deformable) {
    UnionFind connected(deformable.particle_count());
    for (const Stick& stick : deformable.sticks) connected.join(stick.a, stick.b);
    for (const Triangle& face : deformable.faces)
        for (const std::uint32_t v : face) connected.join(face[0], v);
    for (const ElasticTetrahedron& tetrahedron : deformable.tetrahedra)
        for (const std::uint32_t v : tetrahedron.particles) connected.join(tetrahedron.particles[0], v);
    return connected;
}

} // namespace

CommonMotion::CommonMotion(const Deformable& deformable)
    : connected_(connected_parts(deformable)), joined_(connected_), pieces_(deformable.particle_count()) {
    for (const float inverse_mass : deformable.inverse_masses)
        masses_.push_back(inverse_mass > 0 ? 1 / double{inverse_mass} : 0);
}

void CommonMotion::measure(const Particles& particles, const PointArrays& goals) {
    joined_ = connected_;
    std::fill(pieces_.begin(), pieces_.end(), Piece{});
    for (std::uint32_t v = 0; v < masses_.size(); ++v) {
        const Vec3f displacement = goals[v] - particles.frame_start[v];
        pieces_[piece_of(v)].add({.mass = masses_[v],
                                  .momentum = Vec3d(displacement) * masses_[v],
                                  .is_held = particles.pinned(v),
                                  .held = displacement});
    }
}

bool CommonMotion::join(std::span<const std::uint32_t> vertices) {
    bool is_any_new = false;
    for (const std::uint32_t v : vertices) {
        const std::uint32_t a = piece_of(vertices[0]), b = piece_of(v);
        if (a == b) continue;
        joined_.join(a, b);
        pieces_[std::min(a, b)].add(pieces_[std::max(a, b)]);
        is_any_new = true;
    }
    return is_any_new;
}

void CommonMotion::Piece::add(const Piece& other) {
    mass += other.mass;
    momentum += other.momentum;
    if (!other.is_held) return;
    is_pulled_apart = is_pulled_apart || (is_held && !(held == other.held));
    is_held = true;
    held = other.held;
}

std::optional<Vec3f> CommonMotion::displacement_of(std::uint32_t piece) const {
    const Piece& whole = pieces_[piece];
    if (whole.is_pulled_apart) return std::nullopt;
    return whole.is_held ? whole.held : Vec3f(whole.momentum * (1 / whole.mass));
}

void CommonMotion::begin_losses() {
    for (Piece& piece : pieces_) piece.lost_momentum = {};
}

void CommonMotion::lose(std::uint32_t vertex, const Vec3f& velocity) {
    pieces_[piece_of(vertex)].lost_momentum += Vec3d(velocity) * masses_[vertex];
}

Vec3f CommonMotion::loss_of(std::uint32_t vertex) {
    const Piece& piece = pieces_[piece_of(vertex)];
    if (piece.is_held || piece.lost_momentum == Vec3d{}) return {};
    return Vec3f(piece.lost_momentum * (1 / piece.mass));
}

} // namespace echinus
