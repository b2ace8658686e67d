#include "simulation/surfaces/common_motion.hpp"

#include "mesh/union_find.hpp"

namespace echinus {

CommonMotion::CommonMotion(const Deformable& deformable)
    : piece_of_(deformable.particle_count()), pieces_(deformable.particle_count()) {
    UnionFind connected(deformable.particle_count());
    for (const Stick& stick : deformable.sticks) connected.join(stick.a, stick.b);
    for (const Triangle& face : deformable.faces)
        for (const std::uint32_t v : face) connected.join(face[0], v);
    for (const ElasticTetrahedron& tetrahedron : deformable.tetrahedra)
        for (const std::uint32_t v : tetrahedron.particles) connected.join(tetrahedron.particles[0], v);
    for (std::uint32_t v = 0; v < piece_of_.size(); ++v) {
        piece_of_[v] = connected.find(v);
        Piece& piece = pieces_[piece_of_[v]];
        piece.count += 1;
        if (deformable.inverse_masses[v] == 0) piece.held = Held::Pinned;
    }
    for (const Attachment& attachment : deformable.attachments)
        pieces_[piece_of_[attachment.particle]].held = Held::Attached;
}

void CommonMotion::measure(const Particles& particles, const PointArrays& goals) {
    for (Piece& piece : pieces_) piece.sum = {};
    for (std::uint32_t v = 0; v < piece_of_.size(); ++v)
        pieces_[piece_of_[v]].sum += Vec3d(goals[v] - particles.frame_start[v]);
}

std::optional<Vec3f> CommonMotion::way_of(std::uint32_t vertex) const {
    const Piece& piece = pieces_[piece_of_[vertex]];
    if (piece.held == Held::Attached) return std::nullopt;
    return piece.held == Held::Pinned ? Vec3f{} : Vec3f(piece.sum * (1 / piece.count));
}

} // namespace echinus
