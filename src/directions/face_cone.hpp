#pragma once

#include "directions/lattice.hpp"

#include <cstdint>

/// Decides exactly whether a ray from the origin of the lattice crosses a face.
///
/// A ray along d meets the triangle (a, b, c) if and only if d.(a x b), d.(b x c) and d.(c x a) all have the
/// sign of a.(b x c). Each of the three belongs to an edge and has opposite signs in the two neighbouring
/// faces, so no ray slips between two faces or is counted by both. Zeros are resolved by moving d to d + (e,
/// e^2, e^3) with e infinitely small (Edelsbrunner and Muecke, "Simulation of simplicity", 1990). One
/// perturbation applies to the whole map, so the decisions at edges and vertices are consistent.
namespace echinus {

/// Sign of n.(e, e^2, e^3): that of the first component that is not zero.
inline int sign_of_perturbation(const LatticePoint& n) {
    const std::int64_t first = n.x != 0 ? n.x : n.y != 0 ? n.y : n.z;
    return (first > 0) - (first < 0);
}

/// A face seen from the origin: the planes through the origin and its edges, and six times the signed volume
/// of the tetrahedron that the face and the origin form.
class FaceCone {
  public:
    FaceCone(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c)
        : ab_(cross(a, b)), bc_(cross(b, c)), ca_(cross(c, a)), determinant_(dot(a, bc_)) {}

    /// Does the origin lie in the face's plane? No perturbed ray meets such a face.
    bool edge_on() const { return determinant_ == 0; }

    /// Does a ray leave the solid here? It then sees the face from behind, since faces run counter-clockwise
    /// seen from outside.
    bool outward() const { return determinant_ > 0; }

    /// Does the perturbed ray along d meet the face? @pre !edge_on(); components of d within kLatticeExtent
    bool meets(const LatticePoint& d) const {
        return on_face_side(d, ab_) && on_face_side(d, bc_) && on_face_side(d, ca_);
    }

    /// The distance of the crossing in multiples of d. Rounded; only meets() is exact. @pre meets(d)
    double parameter(const LatticePoint& d) const {
        return static_cast<double>(determinant_) / static_cast<double>(denominator(d));
    }

    /// Does the ray meet the face before it reaches the point d? Exact. @pre meets(d)
    bool nearer_than(const LatticePoint& d) const {
        return outward() ? determinant_ < denominator(d) : determinant_ > denominator(d);
    }

  private:
    std::int64_t denominator(const LatticePoint& d) const { // below 2^62
        return dot(d, ab_) + dot(d, bc_) + dot(d, ca_);
    }
    bool on_face_side(const LatticePoint& d, const LatticePoint& n) const {
        const std::int64_t value = dot(d, n);
        const bool positive = value != 0 ? value > 0 : sign_of_perturbation(n) > 0;
        return positive == outward();
    }

    LatticePoint ab_, bc_, ca_;
    std::int64_t determinant_;
};

} // namespace echinus
