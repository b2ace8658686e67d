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

/// Applies the pose first, then the motion.
RigidTransform after(const RigidTransform& motion, const RigidTransform& pose);

/// The prescribed motions of the colliders of a simulation: constant velocities, a pose for the next frame,
/// or keys. Each of these becomes velocities for a frame.
class ColliderMotions {
  public:
    explicit ColliderMotions(std::size_t collider_count) : motions_(collider_count) {}

    void keep_velocity(std::size_t collider) { motions_[collider] = {}; }
    /// @param name  the collider's name, for errors
    /// @throws Error InvalidOptions
    void lead_to(std::size_t collider, const std::string& name, const RigidTransform& pose);
    /// The same, along keys.
    void follow(std::size_t collider, const std::string& name, std::vector<PoseKey> keys);

    /// Moves all poses to which a collider is led.
    void move(std::size_t collider, const RigidTransform& motion);

    void set_free(std::size_t collider, const RigidBody& body) {
        motions_[collider] = {.is_led = true, .body = body};
    }

    /// The body of a free collider, or null if it is not free.
    RigidBody* body_of(std::size_t collider) {
        std::optional<RigidBody>& body = motions_[collider].body;
        return body ? &*body : nullptr;
    }
    /// From now on a free collider is an unknown of the steps: begin_frame() gives it its present velocities.
    void leave_to_step(std::size_t collider, bool is_unknown) { motions_[collider].is_unknown = is_unknown; }
    bool is_unknown(std::size_t collider) const { return motions_[collider].is_unknown; }

    /// Gives led and free colliders the velocities of the frame that begins.
    /// @param end_time  the end of the frame, in seconds since the simulation began
    /// @param loads     [collider] of the frame before
    void begin_frame(std::vector<Collider>& colliders, double end_time, double frame_seconds,
                     std::span<const Load> loads, const Vec3d& gravity);
    /// Whether every collider that follows keys has reached the last one, and every free collider is at rest.
    bool all_arrived(double time, double rest_speed) const;

    void archive(StateArchive& state);

  private:
    struct Motion {
        bool is_led = false; ///< by a pose or by keys; or it is free
        std::optional<RigidTransform> next{};
        std::vector<PoseKey> keys{};
        std::optional<RigidTransform> last{}; ///< the pose to which the frame before led
        std::optional<RigidBody> body{};      ///< if it is free
        bool is_unknown = false;              ///< whether its body is an unknown of each step
    };
    std::vector<Motion> motions_; ///< one for each collider
};

} // namespace echinus
