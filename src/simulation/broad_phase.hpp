#pragma once

#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/collider.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// A box along the axes of some frame, in double precision.
struct WideBox {
    Vec3d low, high;

    void add(const Vec3d& point);
    void grow(double by);
    std::array<Vec3d, 8> corners() const;
};

/// Which of several colliders a deformable can meet in a frame: those whose box, in the frame of the model,
/// touches the box of all places between where the deformable begins the frame and where it ends it. The
/// others are *away*, and nothing is done about them. Since the box is convex, the straight way of every
/// particle and every face lies in it.
///
/// When a frame begins, where it ends is only expected; when it ends, it is known, and a collider that was
/// expected to be away and is not is *met late*: its proofs are made up for.
///
/// A single collider, and one without an exact map, is never away.
class BroadPhase {
  public:
    /// @pre the colliders are valid
    explicit BroadPhase(const std::vector<Collider>& colliders);

    /// A model's vertices go from here to there in the frame that begins. @param from, to  in the body frame
    void deform(std::size_t collider, const PointArrays& from, const PointArrays& to);
    /// @param colliders  where they stand, with the velocities of the frame
    /// @param keep       how far from the deformable a collider is away at least
    void begin_frame(const std::vector<Collider>& colliders, const Particles& particles, double frame_seconds,
                     double keep, std::uint32_t substeps);
    bool is_away(std::size_t collider) const { return away_[collider] != 0; }

    /// @param colliders  where they end the frame
    /// @return those that are met late; they are not away from now on
    const std::vector<std::size_t>& end_frame(const std::vector<Collider>& colliders,
                                              const Particles& particles);

    void archive(StateArchive& state);

  private:
    bool touches(std::size_t collider, const RigidTransform& end_pose, const WideBox& end, double by) const;

    std::vector<WideBox> models_; ///< in the body frame
    std::vector<std::uint8_t> can_be_away_, away_;
    std::vector<std::size_t> met_late_;
    std::vector<RigidTransform> start_poses_;
    WideBox start_{};
    double carry_ = 0; ///< how far a collider that moves may take something along
};

} // namespace echinus
