#pragma once

#include "simulation/exact_collision.hpp"
#include "simulation/particles.hpp"
#include "simulation/sticks.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// What a simulation is made of. `deformable` is what the user sees: it changes when a frame is complete.
class Simulation::Solver {
  public:
    Solver(Deformable deformable, std::vector<Collider> colliders, const SimulationOptions& options);

    void step();
    void set_particle_velocity(std::size_t particle, const Vec3d& velocity);
    void blow(const Vec3d& wind, double rate);
    bool at_rest() const { return quiet_frame_count_ >= options.rest.frame_count; }

    Deformable deformable;
    std::vector<Collider> colliders;
    SimulationOptions options;
    std::uint32_t frame = 0;
    double largest_speed;
    SimulationProfile profile;

  private:
    void begin_frame();
    void integrate(double share_kept);
    void move_colliders();
    void restore_goal_lengths();
    void relax_sticks();
    void collide();
    void collide_by_contacts(const Collider& collider, const RigidTransform& previous_pose);
    void keep_free();
    void lead_to_free_place(std::uint32_t particle);
    bool is_free(std::uint32_t particle) const;
    void count_lost(std::uint32_t particle);
    void publish();
    void judge_frame();
    void judge_rest();

    /// What the faces around a particle would have it move.
    struct Gust {
        Vec3f sum;
        std::uint32_t face_count = 0;

        void add(const Vec3f& across) {
            sum += across;
            ++face_count;
        }
        Vec3f mean() const { return sum * (1 / static_cast<float>(face_count)); }
    };

    Particles particles_;
    StickArrays sticks_;
    bool goals_give_way_;
    double substep_seconds_;
    std::vector<RigidTransform> previous_poses_; // of the colliders, one substep ago
    std::vector<ExactCollision> exact_;          // with each exact map, in the order of the colliders
    std::vector<Vec3f> places_;                  // of a piece of the particles, and their contacts with a
    std::vector<Contact> contacts_;              // collider without an exact map
    std::vector<std::uint32_t> unsettled_;       // particles, in keep_free()
    Vec3d start_centre_;
    double bound_ = 0;
    std::vector<Gust> gusts_;           // in blow()
    std::vector<Vec3f> resting_places_; // where each particle was, quiet_frame_count_ frames ago
    std::uint32_t quiet_frame_count_ = 0;
};

} // namespace echinus
