#include "simulation/energy_limit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace echinus {

namespace {

/// As the relaxation has it: an element that is pressed together from all sides is pushed apart.
constexpr double kLeastSquare = 1.2, kPush = 0.5;
/// Bodies in which waves cross more of an element in a substep, in the mean, were seen to gain energy.
constexpr double kResolvedSquared = 0.25;
/// A relaxation that adds more of a body's energy is followed by another: what it left undone is more than
/// the motion should answer for. More of them no longer help bodies that fly apart in a single substep.
constexpr double kMuch = 0.01;
constexpr std::uint32_t kMostRelaxations = 20;
/// Of strain: what is less is rounding.
constexpr double kLeastStrainSquared = 1e-10;

Vec3d place_of(std::size_t i, const Particles& particles) {
    return Vec3d(particles.positions[i]) + Vec3d(particles.remainders[i]);
}

/// The first particle of what it is connected with.
class Connected {
  public:
    Connected(const TetrahedronArrays& tetrahedra, std::size_t particle_count) : firsts_(particle_count) {
        std::iota(firsts_.begin(), firsts_.end(), 0U);
        for (std::size_t i = 0; i < tetrahedra.count(); ++i)
            for (std::size_t k = 1; k < 4; ++k) join(tetrahedra.particles[0][i], tetrahedra.particles[k][i]);
    }
    std::uint32_t first_of(std::uint32_t particle) {
        while (firsts_[particle] != particle) particle = firsts_[particle] = firsts_[firsts_[particle]];
        return particle;
    }

  private:
    void join(std::uint32_t a, std::uint32_t b) {
        a = first_of(a);
        b = first_of(b);
        firsts_[std::max(a, b)] = std::min(a, b);
    }

    std::vector<std::uint32_t> firsts_;
};

/// Young's modulus times volume.
double stiffness_of(std::size_t i, const TetrahedronArrays& all) {
    const double mu{all.shape_stiffnesses[i]}, lambda{all.volume_stiffnesses[i]};
    return mu * (3 * lambda + 2 * mu) / (lambda + mu);
}

/// About the square of how many times its own height a wave of compression crosses in a substep.
double crossed_squared(std::size_t i, const TetrahedronArrays& all) {
    const double modulus = 2 * double{all.shape_stiffnesses[i]} + double{all.volume_stiffnesses[i]};
    return modulus * double{all.spreads[i]};
}

/// The energy whose constraints are relaxed.
double elastic_energy(std::size_t i, const TetrahedronArrays& all, const Particles& particles) {
    const Vec3d first = place_of(all.particles[0][i], particles);
    std::array<Vec3d, 3> f;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d edge = place_of(all.particles[k + 1][i], particles) - first;
        for (std::size_t axis = 0; axis < 3; ++axis) f[axis] += edge * double{all.gradients[3 * k + axis][i]};
    }
    const double square = dot(f[0], f[0]) + dot(f[1], f[1]) + dot(f[2], f[2]);
    const double volume = dot(f[0], cross(f[1], f[2]));
    const double lacking = std::max(0.0, kLeastSquare - square);
    const double shape = square + volume * (volume - 4) + kPush * lacking * lacking;
    return (double{all.shape_stiffnesses[i]} * shape +
            double{all.volume_stiffnesses[i]} * (volume - 1) * (volume - 1)) /
           2;
}

double elastic_energy(const std::vector<std::uint32_t>& of, const TetrahedronArrays& all,
                      const Particles& particles) {
    double sum = 0;
    for (const std::uint32_t i : of) sum += elastic_energy(i, all, particles);
    return sum;
}

/// x of A x = b for a symmetric A with these columns.
Vec3d solve(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& right) {
    const double determinant = dot(a, cross(b, c));
    if (!(determinant > 0)) return {};
    return Vec3d{dot(right, cross(b, c)), dot(right, cross(c, a)), dot(right, cross(a, b))} *
           (1 / determinant);
}

} // namespace

EnergyLimit::EnergyLimit(const TetrahedronArrays& tetrahedra, const Particles& particles,
                         const std::vector<float>& inverse_masses)
    : masses_(particles.count(), 0), noted_(particles.count()) {
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    Connected connected(tetrahedra, particles.count());
    std::vector<std::size_t> body_at(particles.count(), kNone); ///< of first particles
    for (std::uint32_t i = 0; i < tetrahedra.count(); ++i) {
        std::size_t& body = body_at[connected.first_of(tetrahedra.particles[0][i])];
        if (body == kNone) {
            body = bodies_.size();
            bodies_.emplace_back();
        }
        bodies_[body].tetrahedra.push_back(i);
    }
    for (std::uint32_t i = 0; i < particles.count(); ++i) {
        const std::size_t body = body_at[connected.first_of(i)];
        if (body == kNone) continue;
        if (!particles.pinned(i)) masses_[i] = 1 / double{inverse_masses[i]};
        (particles.pinned(i) ? bodies_[body].pinned : bodies_[body].particles).push_back(i);
    }
    for (Body& body : bodies_) weigh(body, tetrahedra);
}

void EnergyLimit::weigh(Body& body, const TetrahedronArrays& all) const {
    for (const std::uint32_t i : body.particles) body.mass += masses_[i];
    double stiffness = 0, crossed_sq = 0;
    for (const std::uint32_t i : body.tetrahedra) {
        stiffness += stiffness_of(i, all);
        crossed_sq += crossed_squared(i, all);
    }
    body.wave_way_sq = stiffness / body.mass;
    body.is_unresolved = crossed_sq > kResolvedSquared * static_cast<double>(body.tetrahedra.size());
}

bool EnergyLimit::is_violent(const Body& body, const Particles& particles) const {
    Vec3d sum;
    for (const std::uint32_t i : body.particles) sum += Vec3d(particles.step(i)) * masses_[i];
    const Vec3f mean(sum * (1 / body.mass));
    const auto most_sq = static_cast<float>(body.wave_way_sq);
    return std::any_of(body.particles.begin(), body.particles.end(), [&](std::uint32_t i) {
        const Vec3f way = particles.step(i) - mean;
        return dot(way, way) > most_sq;
    });
}

void EnergyLimit::begin_frame(const Particles& particles) {
    measures_ = false;
    for (Body& body : bodies_) {
        body.is_measured = body.is_unresolved || is_violent(body, particles);
        body.excess = body.is_measured ? std::max(body.excess, 0.0) : 0;
        measures_ = measures_ || body.is_measured;
    }
}

void EnergyLimit::begin_substep(const TetrahedronArrays& tetrahedra, const Particles& particles) {
    if (!measures_) return;
    has_begun_ = false;
    for (Body& body : bodies_)
        if (body.is_measured) body.elastic = elastic_energy(body.tetrahedra, tetrahedra, particles);
}

/// The first relaxation of a substep answers for what elastic energy particles gained on their way, too.
void EnergyLimit::note(const TetrahedronArrays& tetrahedra, const Particles& particles) {
    if (!measures_) return;
    if (has_begun_) begin_substep(tetrahedra, particles);
    has_begun_ = true;
    relaxations_ = 0;
    for (Body& body : bodies_) {
        body.gain = 0;
        if (body.is_measured)
            for (const std::uint32_t i : body.particles) noted_[i] = Vec3d(particles.step(i));
    }
}

bool EnergyLimit::charge(const TetrahedronArrays& tetrahedra, const Particles& particles) {
    if (!measures_) return false;
    bool is_much = false;
    for (Body& body : bodies_) {
        // What leads pinned particles does work on the body, which nothing here measures.
        if (!body.is_measured || is_led(body, particles)) continue;
        const double elastic = elastic_energy(body.tetrahedra, tetrahedra, particles);
        double gain = elastic - body.elastic, motion = 0;
        for (const std::uint32_t i : body.particles) {
            const Vec3d way(particles.step(i));
            gain += masses_[i] * dot(way - noted_[i], way + noted_[i]) / 2;
            motion += masses_[i] * dot(way, way) / 2;
        }
        body.excess += gain - body.gain;
        body.gain = gain;
        const double rounding = kLeastStrainSquared * body.wave_way_sq * body.mass;
        is_much = is_much || gain > kMuch * (elastic + motion) + rounding;
    }
    return is_much && ++relaxations_ < kMostRelaxations;
}

bool EnergyLimit::is_led(const Body& body, const Particles& particles) {
    return std::any_of(body.pinned.begin(), body.pinned.end(),
                       [&](std::uint32_t i) { return !(particles.step(i) == Vec3f{}); });
}

void EnergyLimit::end_substep(Particles& particles) {
    if (!measures_) return;
    for (Body& body : bodies_)
        if (body.is_measured && body.excess > 0) take_off(body, particles);
}

void EnergyLimit::archive(StateArchive& state) {
    for (Body& body : bodies_) state.value(body.excess);
}

EnergyLimit::RigidMotion EnergyLimit::rigid_motion(const Body& body, const Particles& particles) const {
    RigidMotion motion;
    for (const std::uint32_t i : body.particles) {
        motion.centre += place_of(i, particles) * masses_[i];
        motion.way += Vec3d(particles.step(i)) * masses_[i];
    }
    motion.centre = motion.centre * (1 / body.mass);
    motion.way = motion.way * (1 / body.mass);
    Vec3d moment, squares, products; // sums of x x, y y, z z and of x y, y z, z x
    for (const std::uint32_t i : body.particles) {
        const Vec3d p = place_of(i, particles) - motion.centre;
        moment += cross(p, Vec3d(particles.step(i))) * masses_[i];
        squares += Vec3d{p.x * p.x, p.y * p.y, p.z * p.z} * masses_[i];
        products += Vec3d{p.x * p.y, p.y * p.z, p.z * p.x} * masses_[i];
    }
    motion.turn = solve({squares.y + squares.z, -products.x, -products.z},
                        {-products.x, squares.z + squares.x, -products.y},
                        {-products.z, -products.y, squares.x + squares.y}, moment);
    return motion;
}

/// Never more than there is; the rest stays due.
void EnergyLimit::take_off(Body& body, Particles& particles) const {
    const RigidMotion rigid = rigid_motion(body, particles);
    const auto own_way = [&](std::uint32_t i) {
        return Vec3d(particles.step(i)) - rigid.way -
               cross(rigid.turn, place_of(i, particles) - rigid.centre);
    };
    double energy = 0;
    for (const std::uint32_t i : body.particles) {
        const Vec3d way = own_way(i);
        energy += masses_[i] * dot(way, way) / 2;
    }
    if (!(energy > 0)) return;
    const double taken = std::min(body.excess, energy);
    const double lost = 1 - std::sqrt(1 - taken / energy);
    for (const std::uint32_t i : body.particles) particles.move_previous(i, Vec3f(own_way(i) * lost));
    body.excess -= taken;
}

} // namespace echinus
