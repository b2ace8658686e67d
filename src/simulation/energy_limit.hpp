#pragma once

#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/tetrahedra.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// Takes off what relaxations of tetrahedra add to the energy of a body.
///
/// Where particles or waves move by a good part of an element in a substep, one relaxation of each
/// tetrahedron does not resolve what happens, and may leave more energy than there was. So the energy of
/// motion and of elasticity is measured, but only in bodies that are violent, or so stiff that substeps do
/// not resolve their waves. While a relaxation adds much to the sum of both, another
/// follows, and what is left of it is taken off the motion: not off that of the body as a whole, whose
/// momentum and angular momentum stay. What contacts, loads and viscosity do is not counted.
///
/// Energies are times the square of a substep, since ways in a substep stand for velocities.
class EnergyLimit {
  public:
    /// Bodies are what tetrahedra with common particles make up.
    /// @param tetrahedra  stay as they are, but for their multipliers
    EnergyLimit(const TetrahedronArrays& tetrahedra, const Particles& particles,
                const std::vector<float>& inverse_masses);

    /// Which bodies are measured. Those of which a particle moves faster than waves do, relative to the mean,
    /// are violent.
    void begin_frame(const Particles& particles);
    /// Before particles are moved.
    void begin_substep(const TetrahedronArrays& tetrahedra, const Particles& particles);
    /// Relaxations may be repeated in this frame.
    bool measures() const { return measures_; }
    /// Before a relaxation.
    void note(const TetrahedronArrays& tetrahedra, const Particles& particles);
    /// After it. @return whether it added so much that one more should follow
    bool charge(const TetrahedronArrays& tetrahedra, const Particles& particles);
    void end_substep(Particles& particles);

    void archive(StateArchive& state);

  private:
    struct Body {
        std::vector<std::uint32_t> particles; ///< that are free
        std::vector<std::uint32_t> pinned;
        std::vector<std::uint32_t> tetrahedra;
        double mass = 0;
        double wave_way_sq = 0; ///< of the way of a wave in a substep
        bool is_unresolved = false;
        bool is_measured = false;
        double elastic = 0; ///< energy when the substep, or the relaxation, began
        double gain = 0;    ///< since it was noted
        double excess = 0;  ///< that was not taken off yet
    };
    /// Of the free particles about their centre of mass.
    struct RigidMotion {
        Vec3d centre, way, turn;
    };

    void weigh(Body& body, const TetrahedronArrays& all) const;
    bool is_violent(const Body& body, const Particles& particles) const;
    static bool is_led(const Body& body, const Particles& particles);
    RigidMotion rigid_motion(const Body& body, const Particles& particles) const;
    void take_off(Body& body, Particles& particles) const;

    std::vector<double> masses_; ///< of the particles; 0 where pinned
    std::vector<Body> bodies_;
    std::vector<Vec3d> noted_;      ///< ways before the relaxation
    bool measures_ = false;         ///< some body is measured
    bool has_begun_ = false;        ///< the substep has had a relaxation
    std::uint32_t relaxations_ = 0; ///< since ways were noted
};

} // namespace echinus
