#pragma once

#include "geometry/union_find.hpp"
#include "mechanics/energy_term.hpp"
#include "simulation/contact/contact_side.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The part of displacements that particles make together, so that no pair loses more than a share of its gap
/// by it. Particles of pairs that would run into each other on their own displacements make a common one:
/// that of one that is held among them; or of the model that they would run into; or else the mean by mass.
/// All others keep their own.
class JoinedDisplacements {
  public:
    /// Models stand; or they move, and carry particles: then the farthest led particle of a group leaves all
    /// of them behind. Beside models that deform no common displacement keeps all gaps: there the particles
    /// of pairs are moved apart just as far as is missing, pair by pair.
    enum class Kind : std::uint8_t { Standing, Carrying, Deforming };

    /// @param sides  where pairs are listed; the others outlive this, too
    JoinedDisplacements(std::span<ContactSide> sides, Places safe, Places goals,
                        std::span<const double> masses, std::span<const std::uint8_t> is_held, Kind kind);

    /// Joins what is to be joined beside what was before, for instance when more pairs are listed. Leaves in
    /// each side `base` and `goal`, and the pairs measured that are near on the way there.
    /// @return [particle] where each goes together with others: its goal where it is alone
    Places find(const Workers& workers);
    /// Whether find() has ended with nothing more to join.
    bool has_converged() const { return has_converged_; }

  private:
    bool join(ContactSide& side, bool all);
    bool join_particles(std::uint32_t a, std::uint32_t b);
    bool lead(std::uint32_t particle, const ContactSide& side, const Separation& apart, float room);
    bool push_apart(ContactSide& side, const Pair& pair, const Vec3f& normal, float room);
    void find_displacements();

    Kind kind_;
    std::span<ContactSide> sides_;
    Places safe_, goals_;
    std::span<const double> masses_;
    std::span<const std::uint8_t> is_held_;
    UnionFind groups_;
    std::vector<std::uint8_t> is_led_; ///< by a model
    bool has_converged_ = false;
    std::vector<Vec3d> led_to_; ///< the goal, or where the model leads
    std::vector<Vec3d> joined_;
    std::vector<std::uint8_t> is_changed_; ///< whether the last round has changed where a particle goes
};

} // namespace echinus
