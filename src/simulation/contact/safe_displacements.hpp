#pragma once

#include "geometry/union_find.hpp"
#include "mechanics/energy_term.hpp"
#include "simulation/contact/contact_side.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Displacements from a safe state, corrected so that no pair closes farther than the plane between its parts
/// allows. What is corrected is moved along normals only, so that it keeps its motion along surfaces and what
/// it has in common with its surroundings.
class SafeDisplacements {
  public:
    enum class Kind : std::uint8_t {
        /// Models stand. Particles of a pair are pushed apart just as far as is missing, pair by pair.
        Standing,
        /// Models move, and carry particles, which keep half of each gap. Those of pairs that would lose more
        /// make a
        /// common displacement: that of one that is held among them; or of the model that they would run
        /// into; or else
        /// the mean by mass.
        Carrying,
        /// Models deform meanwhile: no common displacement keeps all gaps, and particles are pushed apart.
        Deforming,
    };

    /// @param sides  where pairs are listed; the others outlive this, too
    SafeDisplacements(std::span<ContactSide> sides, Places safe, Places goals, std::span<const double> masses,
                      std::span<const std::uint8_t> is_held, Kind kind);

    /// Corrects what is still to be corrected, for instance when more pairs are listed. Leaves in each side
    /// `base` and `goal`, and the pairs measured that are near on the way there.
    /// @return [particle] ends: its goal where nothing corrects it
    Places find(const Workers& workers);
    /// Whether find() has ended with nothing more to correct.
    bool has_converged() const { return has_converged_; }
    /// Pairs that touch in the safe state, or cannot be told apart.
    std::size_t touching_count() const { return touching_count_; }

  private:
    bool correct(ContactSide& side, bool all);
    bool join(std::uint32_t a, std::uint32_t b);
    bool lead(std::uint32_t particle, const ContactSide& side);
    bool push_apart(ContactSide& side, const Pair& pair, const Vec3f& normal, float room);
    void take_wanted();
    void find_common_ends();
    void end_at(std::uint32_t particle, const Vec3d& end);

    Kind kind_;
    std::span<ContactSide> sides_;
    Places safe_, goals_;
    std::span<const double> masses_;
    std::span<const std::uint8_t> is_held_;
    UnionFind groups_;                 ///< that make a common displacement
    std::vector<std::uint8_t> is_led_; ///< by a model
    std::vector<Vec3d> wanted_;        ///< by each particle alone: its goal, or where it is led or pushed
    std::vector<Vec3d> ends_;
    std::vector<std::uint8_t> is_changed_, changes_; ///< of `ends_` in the last round, and in this one
    std::size_t touching_count_ = 0;
    bool has_converged_ = false;
};

} // namespace echinus
