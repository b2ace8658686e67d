#pragma once

#include "simulation/start/exit_directions.hpp"
#include "simulation/start/inner_layer.hpp"
#include "simulation/start/model_pairs.hpp"
#include "simulation/start/openings.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace echinus {

/// Finds the gaps to be opened so that a deformable leaves one model: those of particles inside, and those of
/// faces that intersect the model although no corner is inside.
class ModelOpenings {
  public:
    /// @param passes  [particle] 1 for particles that the collider lets through, or empty
    /// @param gap     the distance that particles keep from the model
    /// @param edge_length  the mean edge length of the deformable
    /// @pre the collider has an exact map
    ModelOpenings(const Elements& elements, const Collider& collider, std::vector<std::uint8_t> passes,
                  float gap, float edge_length, ExitSide side);
    /// @param layer  stays alive as long as the object
    ModelOpenings(const Elements& elements, const InnerLayer& layer, float gap, float edge_length,
                  ExitSide side);

    /// @return the number of intersecting pairs, touching faces and particles inside
    std::size_t add(std::span<const Vec3f> positions, std::vector<Opening>& openings);
    /// The sum of the distances by which particles were inside in add().
    double depths() const { return depths_; }

  private:
    /// The part of the model that comes through an element, or through several.
    struct Protrusion {
        Vec3d normals;    ///< the sum of the area normals of its faces
        Vec3d nearer_end; ///< the normals of the elements, towards its nearer end, weighted by `area`
        double area = 0;  ///< the sum of the lengths of its normals

        Protrusion& operator+=(const Protrusion& other) {
            normals += other.normals;
            nearer_end += other.nearer_end;
            area += other.area;
            return *this;
        }
    };

    Contact nearest_point(const Vec3f& from, float margin) const;
    bool is_inside(const Vec3f& point) const;
    std::size_t find_inside(std::span<const Vec3f> positions);
    void add_particles(std::span<const Vec3f> positions, std::vector<Opening>& openings);
    std::optional<Vec3f> exit_along(Vec3f from, const Vec3f& direction) const;
    void lift_faces(std::span<const Vec3f> positions, const ModelPairs::Found& found,
                    std::vector<Opening>& openings) const;
    Opening lift(std::span<const Vec3f> positions, std::uint32_t element, const Vec3d& direction,
                 double height) const;
    Protrusion protrusion_through(std::span<const Vec3f> positions, std::span<const FacePair> pairs) const;
    std::vector<Vec3d> lift_directions(std::span<const Vec3f> positions,
                                       const ModelPairs::Found& found) const;

    const Elements& elements_;
    ModelPairs pairs_;
    const InnerLayer* layer_ = nullptr; ///< if the model is one
    Collider collider_;                 ///< with its exact map
    float gap_, edge_length_;
    float extent_; ///< no straight path inside the model is longer
    ExitDirections directions_;
    std::vector<std::uint8_t> inside_; ///< [particle]
    std::vector<Contact> nearest_;     ///< [particle] for those inside, and those near the model
    double depths_ = 0;
};

} // namespace echinus
