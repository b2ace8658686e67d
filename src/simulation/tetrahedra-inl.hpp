// The correction of tetrahedra, one by one or as many at once as the instruction set has lanes. One text for
// both, hence the same bits. Compiled once for each instruction set.

#include "simulation/tetrahedra.hpp"

#include <array>
#include <cmath>

#if defined(ECHINUS_TETRAHEDRA_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_TETRAHEDRA_INL
#undef ECHINUS_TETRAHEDRA_INL
#else
#define ECHINUS_TETRAHEDRA_INL
#endif

#include "simd/lanes-inl.hpp"
#include "simulation/places-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

/// No relaxation changes the deformation gradient by more than this: near states without volume, gradients
/// vanish, and a whole step to the goal would throw the particles far beyond it. Where an element is
/// stretched beyond kStretched, as the norm of the gradient, by so much more: otherwise it would be drawn out
/// against less of a force than its energy has, and give back more.
constexpr float kLargestChange = 0.5F;
constexpr float kStretched = 2;

/// The square of a strain far below what the rounding of positions makes: what is divided by is never 0.
constexpr float kNoStrain = 1e-13F;
constexpr float kNoGain = 1e-24F; ///< that of the strain of a substep

/// Elements that are flatter or larger, or bend or turn farther in a substep, follow the gradient where they
/// are, less its moment. Turned back it would give energy to changes of shape at a constant volume where the
/// pressure in the element draws: the direction is that of a step before.
constexpr float kLeastVolume = 0.2F;
constexpr float kMostVolume = 1.5F;
constexpr float kLeastAlong = 0.5F;
constexpr float kMostTurned = 2;
constexpr float kOfALine = 1e-6F, kOfAPoint = 1e-10F; ///< so that what is divided by is never 0

/// An element that is pressed together from all sides, to about 0.6 of its size, is pushed apart: the energy
/// would have a minimum where it is but a point.
constexpr float kLeastSquare = 1.2F;
constexpr float kPush = 0.5F;

HWY_INLINE float root(float value) {
    return std::sqrt(value);
}
HWY_INLINE FloatLanes root(FloatLanes value) {
    return hn::Sqrt(value);
}
HWY_INLINE float choose(bool condition, float yes, float no) {
    return condition ? yes : no;
}
HWY_INLINE Vec3f choose(bool condition, const Vec3f& yes, const Vec3f& no) {
    return condition ? yes : no;
}
HWY_INLINE bool both(bool a, bool b) {
    return a && b;
}
HWY_INLINE FloatMask both(FloatMask a, FloatMask b) {
    return hn::And(a, b);
}
HWY_INLINE bool everywhere(bool condition) {
    return condition;
}
HWY_INLINE bool everywhere(FloatMask condition) {
    return hn::AllTrue(kFloat, condition);
}

/// How numbers of one tetrahedron are read and written, or of several.
struct OneByOne {
    using Real = float;
    using Point = Vec3f;
    static HWY_INLINE float number(float value) { return value; }
    static HWY_INLINE float load(const std::vector<float>& from, std::size_t i) { return from[i]; }
    static HWY_INLINE void store(float value, std::vector<float>& to, std::size_t i) { to[i] = value; }
    using Where = OneParticle;
    static HWY_INLINE OneParticle where(const std::vector<std::uint32_t>& particles, std::size_t i) {
        return {particles[i]};
    }
};
struct InLanes {
    using Real = FloatLanes;
    using Point = PointLanes;
    static HWY_INLINE FloatLanes number(float value) { return splat(value); }
    static HWY_INLINE FloatLanes load(const std::vector<float>& from, std::size_t i) {
        return hn::LoadU(kFloat, &from[i]);
    }
    static HWY_INLINE void store(FloatLanes value, std::vector<float>& to, std::size_t i) {
        hn::StoreU(value, kFloat, &to[i]);
    }
    using Where = GatheredParticles;
    static HWY_INLINE GatheredParticles where(const std::vector<std::uint32_t>& particles, std::size_t i) {
        return {load_indices(&particles[i])};
    }
};

/// A matrix by its columns.
template <typename Point>
struct Columns {
    Point x, y, z;
};
template <typename Real>
struct Symmetric {
    Real xx, yy, zz, xy, yz, zx;
};

template <typename Point>
HWY_INLINE Point product(const Columns<Point>& m, const Point& v) {
    return m.x * v.x + m.y * v.y + m.z * v.z;
}
template <typename Point, typename Real>
HWY_INLINE Columns<Point> product(const Columns<Point>& m, const Symmetric<Real>& s) {
    return {m.x * s.xx + m.y * s.xy + m.z * s.zx, m.x * s.xy + m.y * s.yy + m.z * s.yz,
            m.x * s.zx + m.y * s.yz + m.z * s.zz};
}
template <typename Real>
HWY_INLINE Symmetric<Real> times(const Symmetric<Real>& s, const Real& factor) {
    return {s.xx * factor, s.yy * factor, s.zz * factor, s.xy * factor, s.yz * factor, s.zx * factor};
}
template <typename Point>
HWY_INLINE Columns<Point> cofactors(const Columns<Point>& m) {
    return {cross(m.y, m.z), cross(m.z, m.x), cross(m.x, m.y)};
}
template <typename Point>
HWY_INLINE auto dot(const Columns<Point>& a, const Columns<Point>& b) {
    return dot(a.x, b.x) + dot(a.y, b.y) + dot(a.z, b.z);
}
/// M^T M.
template <typename Real, typename Point>
HWY_INLINE Symmetric<Real> square_of(const Columns<Point>& m) {
    return {dot(m.x, m.x), dot(m.y, m.y), dot(m.z, m.z), dot(m.x, m.y), dot(m.y, m.z), dot(m.z, m.x)};
}

/// What the tetrahedra of a run have in common with one: where they are, and their rest shape.
template <typename Kind>
class Tetrahedra {
  public:
    using Real = typename Kind::Real;
    using Point = typename Kind::Point;

    using Where = typename Kind::Where;
    using Place = CompensatedPlace<Point>;

    /// @param previous  places when the substep began
    template <typename PreviousPlaces>
    HWY_INLINE Tetrahedra(const TetrahedronArrays& all, std::size_t i, const CompensatedPlaces& places,
                          const PreviousPlaces& previous)
        : where_{Kind::where(all.particles[0], i), Kind::where(all.particles[1], i),
                 Kind::where(all.particles[2], i), Kind::where(all.particles[3], i)},
          places_{places.load(where_[0]), places.load(where_[1]), places.load(where_[2]),
                  places.load(where_[3])},
          edges_{places_[1].from(places_[0]), places_[2].from(places_[0]), places_[3].from(places_[0])},
          ways_{none(), none(), none(), none()}, b_{gradient(all, i, 0), gradient(all, i, 3),
                                                    gradient(all, i, 6)},
          masses_{Kind::load(all.inverse_masses[0], i), Kind::load(all.inverse_masses[1], i),
                  Kind::load(all.inverse_masses[2], i), Kind::load(all.inverse_masses[3], i)},
          spread_(Kind::load(all.spreads, i)), before_(deformation_of(previous)) {}

    /// @param stiffness, multiplier  of the constraint
    HWY_INLINE void relax_shape(const Real& stiffness, Real& multiplier) {
        const Columns<Point> f = deformation(), cof = cofactors(f);
        const Real one = Kind::number(1), two = Kind::number(2);
        const Real volume = dot(f.x, cof.x), away = volume - two;
        const Real lacking = positive(Kind::number(kLeastSquare) - dot(f, f));
        const Real push = Kind::number(kPush) * lacking, own = one - two * push;
        const Columns<Point> gradient{f.x * own + cof.x * away, f.y * own + cof.y * away,
                                      f.z * own + cof.z * away};
        const Columns<Point> turned =
            product(before_, with_diagonal(times(square_of<Real>(cof), away / volume), own));
        const Real square = positive(shape_squared(f, volume - one)) + push * lacking;
        const Real value = root(square + Kind::number(kNoStrain));
        correct(f, gradient, turned, value, one / value, stiffness, multiplier);
    }

    HWY_INLINE void relax_volume(const Real& stiffness, Real& multiplier) {
        const Columns<Point> f = deformation(), cof = cofactors(f);
        const Real one = Kind::number(1);
        const Real volume = dot(f.x, cof.x);
        const Columns<Point> turned = product(before_, times(square_of<Real>(cof), one / volume));
        correct(f, cof, turned, volume - one, one, stiffness, multiplier);
    }

    /// As if the strain of this substep, sym(F_middle^T (F - F_before)), were a constraint, with the
    /// viscosity as its stiffness. That strain is the one between the metrics, hence 0 for any turn.
    HWY_INLINE void damp(const Real& viscosity) {
        const Columns<Point> f = deformation();
        const Real half = Kind::number(0.5F);
        const Columns<Point> gain{f.x - before_.x, f.y - before_.y, f.z - before_.z};
        const Columns<Point> middle{(f.x + before_.x) * half, (f.y + before_.y) * half,
                                    (f.z + before_.z) * half};
        const Symmetric<Real> strain{
            dot(middle.x, gain.x),
            dot(middle.y, gain.y),
            dot(middle.z, gain.z),
            (dot(middle.x, gain.y) + dot(middle.y, gain.x)) * half,
            (dot(middle.y, gain.z) + dot(middle.z, gain.y)) * half,
            (dot(middle.z, gain.x) + dot(middle.x, gain.z)) * half,
        };
        const Real one = Kind::number(1), two = Kind::number(2);
        const Real square = strain.xx * strain.xx + strain.yy * strain.yy + strain.zz * strain.zz +
                            two * (strain.xy * strain.xy + strain.yz * strain.yz + strain.zx * strain.zx);
        const Real value = root(two * square + Kind::number(kNoGain));
        const Symmetric<Real> twice = times(strain, two);
        Real multiplier = Kind::number(0);
        correct(f, product(f, twice), product(before_, twice), value, one / value, viscosity, multiplier);
    }

    HWY_INLINE void store(const CompensatedPlaces& places) {
        for (std::size_t k = 0; k < 4; ++k) {
            places_[k].move(ways_[k]);
            places.store(places_[k], where_[k]);
        }
    }

  private:
    static HWY_INLINE Point none() { return {Kind::number(0), Kind::number(0), Kind::number(0)}; }
    static HWY_INLINE Point gradient(const TetrahedronArrays& all, std::size_t i, std::size_t first) {
        return {Kind::load(all.gradients[first], i), Kind::load(all.gradients[first + 1], i),
                Kind::load(all.gradients[first + 2], i)};
    }
    static HWY_INLINE Symmetric<Real> with_diagonal(const Symmetric<Real>& s, const Real& more) {
        return {more + s.xx, more + s.yy, more + s.zz, s.xy, s.yz, s.zx};
    }
    static HWY_INLINE Real positive(const Real& value) {
        const Real zero = Kind::number(0);
        return choose(zero < value, value, zero);
    }

    HWY_INLINE Columns<Point> deformation(const Point& to_a, const Point& to_b, const Point& to_c) const {
        return {to_a * b_[0].x + to_b * b_[1].x + to_c * b_[2].x,
                to_a * b_[0].y + to_b * b_[1].y + to_c * b_[2].y,
                to_a * b_[0].z + to_b * b_[1].z + to_c * b_[2].z};
    }
    HWY_INLINE Columns<Point> deformation() const { return deformation(edges_[0], edges_[1], edges_[2]); }
    template <typename Places>
    HWY_INLINE Columns<Point> deformation_of(const Places& places) const {
        const auto first = places.load(where_[0]);
        return deformation(places.load(where_[1]).from(first), places.load(where_[2]).from(first),
                           places.load(where_[3]).from(first));
    }

    /// |F|^2 + J^2 - 4 J. @param growth  J - 1
    static HWY_INLINE Real shape_squared(const Columns<Point>& f, const Real& growth) {
        const Real one = Kind::number(1);
        Symmetric<Real> s = square_of<Real>(f);
        s.xx = s.xx - one;
        s.yy = s.yy - one;
        s.zz = s.zz - one;
        const Real minor_xx = s.yy * s.zz - s.yz * s.yz, minor_yy = s.zz * s.xx - s.zx * s.zx,
                   minor_zz = s.xx * s.yy - s.xy * s.xy;
        const Real determinant =
            s.xx * minor_xx + s.xy * (s.yz * s.zx - s.xy * s.zz) + s.zx * (s.xy * s.yz - s.yy * s.zx);
        return Kind::number(2) * growth * growth - (minor_xx + minor_yy + minor_zz) - determinant;
    }

    /// On the particles, per unit of a stress: no force in all, hence the first.
    HWY_INLINE std::array<Point, 4> forces_of(const Columns<Point>& stress) const {
        const Point a = product(stress, b_[0]), b = product(stress, b_[1]), c = product(stress, b_[2]);
        return {-(a + b + c), a, b, c};
    }
    HWY_INLINE Real work(const std::array<Point, 4>& a, const std::array<Point, 4>& b) const {
        return dot(a[0], b[0]) * masses_[0] + dot(a[1], b[1]) * masses_[1] + dot(a[2], b[2]) * masses_[2] +
               dot(a[3], b[3]) * masses_[3];
    }
    HWY_INLINE void move(const std::array<Point, 4>& forces, const Real& size) {
        const Point first = forces[0] * (size * masses_[0]);
        ways_[0] = ways_[0] + first;
        for (std::size_t k = 1; k < 4; ++k) {
            const Point way = forces[k] * (size * masses_[k]);
            ways_[k] = ways_[k] + way;
            edges_[k - 1] = edges_[k - 1] + (way - first);
        }
    }

    /// The nearest of those stresses whose forces have no moment about the places where the substep began:
    /// the stress less an infinitesimal turn of that deformation.
    HWY_INLINE Columns<Point> without_moment(const Columns<Point>& stress) const {
        const Columns<Point>& f = before_;
        const Point moment = cross(f.x, stress.x) + cross(f.y, stress.y) + cross(f.z, stress.z);
        const Point x{f.x.x, f.y.x, f.z.x}, y{f.x.y, f.y.y, f.z.y}, z{f.x.z, f.y.z, f.z.z};
        const Real xx = dot(x, x), yy = dot(y, y), zz = dot(z, z), zero = Kind::number(0);
        // Of an element that is but a line no turn is defined about it, nor has it a moment there.
        const Real some = (xx + yy + zz) * Kind::number(kOfALine) + Kind::number(kOfAPoint);
        const Point a{yy + zz + some, zero - dot(x, y), zero - dot(x, z)},
            b{a.y, zz + xx + some, zero - dot(y, z)}, c{a.z, b.z, xx + yy + some};
        const Point across = cross(b, c);
        const Point turn = Point{dot(moment, across), dot(moment, cross(c, a)), dot(moment, cross(a, b))} *
                           (Kind::number(1) / dot(a, across));
        return {stress.x - cross(turn, f.x), stress.y - cross(turn, f.y), stress.z - cross(turn, f.z)};
    }

    /// @param change  of the deformation gradient by a whole step  @return how much of that step is taken
    static HWY_INLINE Real share_of_step(const Columns<Point>& f, const Real& change) {
        const Real one = Kind::number(1), most = Kind::number(kLargestChange);
        if (everywhere(change <= most)) return one;
        const Real stretch = root(dot(f, f)) * Kind::number(1 / kStretched);
        const Real most_here = most * choose(one < stretch, stretch, one);
        return choose(most_here < change, most_here / change, one);
    }

    /// @param f  the deformation now
    /// @param gradient, turned  of the constraint times its value, where `per_value` is not 1
    HWY_INLINE void correct(const Columns<Point>& f, const Columns<Point>& gradient,
                            const Columns<Point>& turned, const Real& value, const Real& per_value,
                            const Real& stiffness, Real& multiplier) {
        std::array<Point, 4> forces = forces_of(gradient);
        const std::array<Point, 4> turned_forces = forces_of(turned);
        const Real own = work(forces, forces), along = work(forces, turned_forces);
        const Real own_sq = dot(gradient, gradient), turned_sq = dot(turned, turned);
        const Real volume = dot(f.x, cross(f.y, f.z));
        const auto is_along = both(
            both(along >= own * Kind::number(kLeastAlong), turned_sq <= own_sq * Kind::number(kMostTurned)),
            both(volume >= Kind::number(kLeastVolume), volume <= Kind::number(kMostVolume)));
        if (!everywhere(is_along)) forces = forces_of(without_moment(gradient));
        for (std::size_t k = 0; k < 4; ++k) forces[k] = choose(is_along, turned_forces[k], forces[k]);
        const Real rate = choose(is_along, along, own) * per_value * per_value;
        const Real size = root(choose(is_along, turned_sq, own_sq));

        const Real one = Kind::number(1), zero = Kind::number(0);
        const Real wanted = zero - (stiffness * value + multiplier) / (stiffness * rate + one);
        const Real change = choose(wanted < zero, zero - wanted, wanted) * per_value * size * spread_;
        const Real step = wanted * share_of_step(f, change);
        move(forces, step * per_value);
        multiplier = multiplier + step;
    }

    std::array<Where, 4> where_;
    std::array<Place, 4> places_; ///< when the relaxation began
    std::array<Point, 3> edges_;  ///< from the first particle to the others, now
    std::array<Point, 4> ways_;   ///< of the particles, so far
    std::array<Point, 3> b_;
    std::array<Real, 4> masses_;
    Real spread_;
    Columns<Point> before_; ///< the deformation when the substep began
};

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#endif
