#pragma once

#include "mechanics/implicit_step.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

template <typename T>
Vec3<T> unit_or_zero(const Vec3<T>& v) {
    const T size = length(v);
    return size > 0 ? v * (1 / size) : Vec3<T>{};
}

/// A gap to be opened between parts of a deformable, or between a part and a model that stays: it is linear
/// in the positions.
struct Opening {
    /// The most particles that one gap can depend on: those of an edge and a face.
    static constexpr std::size_t kMostParts = 5;

    std::array<std::uint32_t, kMostParts> particles{};
    std::array<double, kMostParts> weights{}; ///< 0 for those that are not used
    Vec3d normal;                             ///< of unit length, towards positive weights
    double least = 0;     ///< the sum of weight * (normal . position) has to become at least this
    double stiffness = 0; ///< force / length
};

/// The energy of openings: stiffness / 2 times the square of the missing part of each gap.
class Openings : public ContactEnergy {
  public:
    std::vector<Opening> all;

    double energy(Places places, const Workers& workers) const override;
    void add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                         const Workers& workers) const override;
};

} // namespace echinus
