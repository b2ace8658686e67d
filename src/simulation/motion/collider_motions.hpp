#pragma once

#include "simulation/motion/rigid_body.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/collider.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace echinus {

/// First the pose, then the motion.
RigidTransform after(const RigidTransform& motion, const RigidTransform& pose);

/// The prescribed motions of the colliders of a simulation: constant velocities, a pose for the next frame,
/// or keys. All become velocities for a frame.
class ColliderMotions {
  public:
    explicit ColliderMotions(std::size_t collider_count) : motions_(collider_count) {}

    void keep_velocity(std::size_t collider) { motions_[collider] = {}; }
    /// @param name  of the collider, for errors
    /// @throws Error InvalidOptions
    void lead_to(std::size_t collider, const std::string& name, const RigidTransform& pose);
    /// The same.
    void follow(std::size_t collider, const std::string& name, std::vector<PoseKey> keys);

    /// All that leads a collider is elsewhere.
    void move(std::size_t collider, const RigidTransform& motion);

    void set_free(std::size_t collider, const RigidBody& body) {
        motions_[collider] = {.is_led = true, .body = body};
    }

    /// The body of a collider that is free; null: it is not.
    RigidBody* body_of(std::size_t collider) {
        std::optional<RigidBody>& body = motions_[collider].body;
        return body ? &*body : nullptr;
    }
    /// A free collider is an unknown of steps from now on: begin_frame() gives it the velocities that it has.
    void leave_to_step(std::size_t collider, bool is_unknown) { motions_[collider].is_unknown = is_unknown; }
    bool is_unknown(std::size_t collider) const { return motions_[collider].is_unknown; }

    /// Gives the colliders that are led or free the velocities of the frame that begins.
    /// @param end_time  when the frame ends, seconds since the simulation began
    /// @param loads     of the frame before, by collider
    void begin_frame(std::vector<Collider>& colliders, double end_time, double frame_seconds,
                     std::span<const Load> loads, const Vec3d& gravity);
    /// Has every collider that follows keys come to its last one, and every free one to rest?
    bool all_arrived(double time, double rest_speed) const;

    void archive(StateArchive& state);

  private:
    struct Motion {
        bool is_led = false; ///< by a pose or by keys, or it is free
        std::optional<RigidTransform> next{};
        std::vector<PoseKey> keys{};
        std::optional<RigidTransform> last{}; ///< where the frame before led
        std::optional<RigidBody> body{};      ///< it is free
        bool is_unknown = false;              ///< its body is, in each step
    };
    std::vector<Motion> motions_; ///< one for each collider
};

} // namespace echinus
