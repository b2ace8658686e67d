#pragma once

#include "mechanics/energy_term.hpp"
#include "simulation/contact/contact_set.hpp"
#include "simulation/contact/contact_side.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// How the parts of a pair are pushed apart.
struct PushRules {
    std::span<const std::uint8_t> is_held; ///< [particle] 1 for those that go to their goals
    bool yields = false;                   ///< they do so only where the others of a pair can give way
    std::span<const double> masses;        ///< [particle] by which parts share a push; none: equally
    float share = 1;                       ///< of each gap that may be closed
};

/// Displacements from a safe state, corrected so that no pair closes farther than the plane between its parts
/// allows. Particles are pushed along normals, pair by pair, just as far as is missing; so they keep their
/// motion along surfaces and what they have in common with their surroundings.
class SafeDisplacements {
  public:
    /// @param sides    where pairs are listed; the others outlive this, too
    SafeDisplacements(std::span<ContactSide> sides, Places goals, const PushRules& rules,
                      const Workers& workers);

    /// Corrects what is still to be corrected, for instance when more pairs are listed. Leaves in each side
    /// the pairs measured that are near on the way to the ends.
    /// @return [particle] ends: its goal where nothing pushes it
    Places find();
    /// Whether find() has ended with nothing more to correct.
    bool has_converged() const { return has_converged_; }
    /// [particle] the side against which it was pushed last, or kNoObstacle.
    std::span<const std::uint32_t> pushed_by() const { return pushed_by_; }
    /// Pairs that touch in the safe state, or that are not kept apart: what is held closes them, or there is
    /// too little room.
    std::size_t unresolved_count() const { return unresolved_count_; }
    /// [side] those of them that are not kept apart.
    std::span<const std::size_t> closed_counts() const { return closed_counts_; }

  private:
    /// Between the parts of a pair: how far they may close along its normal, and how far they do.
    struct Plane {
        Vec3f normal;
        float room, closing;
        float left() const { return room - closing; }
    };

    float room_of(const ContactSide& side, float gap) const;
    Plane plane_between(const ContactSide& side, std::size_t index) const;
    bool stays_apart(const ContactSide& side, std::size_t index) const;
    float pushed(const ContactSide& side, std::size_t index) const;
    bool correct(ContactSide& side, ScratchVector<float>& enough);
    bool push_apart(ContactSide& side, const Pair& pair, const Plane& plane);

    std::span<ContactSide> sides_;
    Places goals_;
    const PushRules rules_;
    const Workers& workers_;
    ScratchVector<Vec3d> ends_;
    ScratchVector<float> pushed_; ///< [particle] how far in all
    ScratchVector<std::uint32_t> pushed_by_;
    ScratchVector<ScratchVector<float>> enough_; ///< [side][pair] as of correct()
    std::size_t unresolved_count_ = 0;
    ScratchVector<std::size_t> closed_counts_;
    bool has_converged_ = false;
};

} // namespace echinus
