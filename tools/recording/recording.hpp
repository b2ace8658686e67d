#pragma once

#include <echinus/exact_map.hpp>
#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

/// The numbers of pairs of faces that intersect.
struct PairCounts {
    std::size_t with_models = 0; ///< a face of the cloth and one of a model
    std::size_t own = 0;         ///< two faces of the cloth, other than at shared vertices and edges
};

/// A frame that was recorded.
struct RecordedFrame {
    std::uint32_t number;
    std::vector<echinus::Vec3f> positions;      ///< [particle_count] of the cloth, in the world
    std::vector<echinus::RigidTransform> poses; ///< of the colliders
    std::size_t inside_count; ///< particles inside a model, by its exact map; a particle inside two models
                              ///< counts twice
    std::optional<PairCounts> pairs; ///< none if they were not counted
};

/// The recording that a page plays: a simulation's cloth and collider in some of its frames, including the
/// first and the last.
class Recording {
  public:
    /// @param models  exact maps of the colliders' meshes, which judge the particles, independently of the
    /// maps that the simulation uses
    /// @param stride  frames from one recorded frame to the next, at least 1
    Recording(std::vector<echinus::ExactMap> models, std::uint32_t stride)
        : models_(std::move(models)), stride_(stride) {}

    /// Records the frame if it is due. To be called at the start and after each step.
    void watch(const echinus::Simulation& simulation);
    /// Records the last frame, due or not.
    void finish(const echinus::Simulation& simulation);

    /// Adds the pairs of a frame, which are ignored unless it is the last recorded frame.
    void add_pairs(std::uint32_t frame, const PairCounts& pairs);

    const std::vector<RecordedFrame>& frames() const { return frames_; }

  private:
    void add(const echinus::Simulation& simulation);

    std::vector<echinus::ExactMap> models_;
    std::uint32_t stride_;
    std::vector<RecordedFrame> frames_;
};

/// The least stride at which a recording has at most 60 frames per second of simulated time.
std::uint32_t stride_for_display(double time_step);

/// @param frame_limit  the most frames of the simulation
/// @throws echinus::Error InvalidOptions if that could be more than a browser can hold; the sentence names
/// the stride that helps
void require_playable(std::size_t particle_count, std::uint32_t frame_limit, std::uint32_t stride);
