// The task mechanics: what the solver newton moves, beside what is known of it: pendulums, energy, momentum,
// a chain, beams and bars.

#include "compare/turns.hpp"
#include "mechanics/elastic_model.hpp"
#include "simulation/elastic_parts.hpp"
#include "task.hpp"

#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

using namespace echinus;

namespace {

constexpr double kGravity = 9.81;

/// Nothing brakes, but for what a step loses.
SimulationOptions undamped(double frames_per_second) {
    SimulationOptions options{.solver = NewtonOptions{.air_drag = 0, .collision = CollisionMode::Particles},
                              .time_step = 1 / frames_per_second};
    options.newton().material.damping = 0;
    return options;
}

/// Records of one kind: what was measured, what theory says.
class Table {
  public:
    Table(Records& records, const Setting& setting) : records_(records), setting_(setting) {}

    void add(const std::string& what, double frames_per_second, double measured, double expected,
             const char* unit) {
        setting_.report_progress(what, 1);
        records_.add({{"table", "motion"},
                      {"what", what},
                      {"frames_per_second", fmt::format("{}", frames_per_second)},
                      {"measured", fmt::format("{:.6g}", measured)},
                      {"expected", fmt::format("{:.6g}", expected)},
                      {"unit", unit}});
    }

  private:
    Records& records_;
    const Setting& setting_;
};

// ---- Pendulums ----

struct Swings {
    double period = 0;         ///< seconds, the mean of ten
    double amplitude_kept = 0; ///< share of the first swing's, by the eleventh
};

/// Of a coordinate that swings about 0 and begins at its largest.
template <typename Coordinate>
Swings swing(Simulation& simulation, double expected_period, const Coordinate& coordinate) {
    constexpr int kSwings = 10;
    const double step = simulation.options().time_step;
    double last = coordinate(simulation), first_crossing = -1, last_crossing = -1;
    double first_most = std::abs(last), last_most = 0;
    int crossings = 0;
    while (crossings <= 2 * kSwings || simulation.frame() * step < (kSwings + 1) * expected_period) {
        simulation.step();
        if (simulation.frame() * step > 3 * kSwings * expected_period) break;
        const double now = coordinate(simulation);
        if ((now < 0) != (last < 0) && crossings <= 2 * kSwings) {
            last_crossing = (simulation.frame() - now / (now - last)) * step;
            if (crossings++ == 0) first_crossing = last_crossing;
        }
        if (simulation.frame() * step >= (kSwings - 0.25) * expected_period)
            last_most = std::max(last_most, std::abs(now));
        last = now;
    }
    return {(last_crossing - first_crossing) / kSwings, last_most / first_most};
}

constexpr std::uint32_t kStripColumns = 3, kStripRows = 33;

/// Of a metre, which hangs by its first row, with its rows where an angle against the vertical by the length
/// along it leads.
template <typename Angle>
Deformable strip(const Angle& angle) {
    ClothOptions sheet{.column_count = kStripColumns, .row_count = kStripRows, .width = 0.0625, .height = 1};
    for (std::uint32_t column = 0; column < kStripColumns; ++column) sheet.pins.push_back(column);
    Deformable cloth = make_cloth(sheet);
    cloth.rest_positions = cloth.positions;
    constexpr double kPiece = 1.0 / (kStripRows - 1);
    Vec3d place;
    for (std::uint32_t row = 0; row < kStripRows; ++row) {
        for (std::uint32_t column = 0; column < kStripColumns; ++column) {
            Vec3f& p = cloth.positions[row * kStripColumns + column];
            p = {p.x, float(place.y), float(place.z)};
        }
        const double a = angle((row + 0.5) * kPiece);
        place += Vec3d{0, std::sin(a), -std::cos(a)} * kPiece;
    }
    return cloth;
}

/// The first zero of J0, the Bessel function of order 0.
constexpr double kZero = 2.404825557695773;

/// Of the lowest mode of a chain that hangs.
double lowest_mode(double along) {
    return std::cyl_bessel_j(0, kZero * std::sqrt(1 - along));
}

/// How much of that there is in a strip, whose modes are orthogonal.
double share_of_lowest_mode(const Simulation& simulation) {
    double sum = 0;
    for (std::uint32_t row = 1; row < kStripRows; ++row) {
        const double weight = row + 1 == kStripRows ? 0.5 : 1;
        sum += weight * lowest_mode(row / (kStripRows - 1.0)) *
               double{simulation.positions()[row * kStripColumns].y};
    }
    return sum;
}

double end_of_strip(const Simulation& simulation) {
    return double{simulation.positions().back().y};
}

void add_pendulums(const Setting& setting, Table& table) {
    for (const double pace : {60.0, 120.0}) {
        constexpr double kRodAngle = 0.1;
        SimulationOptions options = undamped(pace);
        options.newton().material.bending_stiffness = 1;
        Simulation rod(strip([](double) { return kRodAngle; }), {}, options);
        const double rod_period =
            2 * std::numbers::pi * std::sqrt(2.0 / 3 / kGravity) * (1 + kRodAngle * kRodAngle / 16);
        if (setting.is_short && pace > 60) return;
        const Swings of_rod = swing(rod, rod_period, end_of_strip);
        table.add("period of a stiff strip", pace, of_rod.period, rod_period, "s");
        table.add("amplitude of a stiff strip after ten swings", pace, 100 * of_rod.amplitude_kept, 100, "%");

        constexpr double kAmplitude = 0.02;
        const auto steepness = [](double along) { // of the lowest mode
            const double root = std::sqrt(1 - along);
            return kAmplitude * std::cyl_bessel_j(1, kZero * root) * kZero / (2 * root);
        };
        Simulation limp(strip([&](double along) { return std::asin(steepness(along)); }), {}, undamped(pace));
        const double limp_period = 2 * std::numbers::pi / (kZero / 2 * std::sqrt(kGravity));
        const Swings of_limp = swing(limp, limp_period, share_of_lowest_mode);
        table.add("period of a limp strip", pace, of_limp.period, limp_period, "s");
        table.add("amplitude of a limp strip after ten swings", pace, 100 * of_limp.amplitude_kept, 100, "%");
    }
}

// ---- Energy and momentum ----

/// Computes energy and momentum of the published state in double precision.
class Judge {
  public:
    explicit Judge(const Simulation& simulation) : gravity_(simulation.options().gravity) {
        const ElasticParts parts = elastic_parts(simulation.deformable(), simulation.options());
        masses_ = parts.masses;
        model_.emplace(parts); // which dissipates nothing, since no step begins
    }

    double energy(const Simulation& simulation) const {
        const Deformable& body = simulation.deformable();
        std::vector<Vec3d> places;
        double sum = 0;
        for (std::size_t i = 0; i < masses_.size(); ++i) {
            places.emplace_back(body.positions[i]);
            if (body.inverse_masses[i] == 0) continue;
            const Vec3d v = velocity(body, i);
            sum += masses_[i] * (dot(v, v) / 2 - dot(gravity_, places.back()));
        }
        return sum + model_->energy(places, Workers(1));
    }
    Vec3d momentum(const Simulation& simulation) const {
        Vec3d sum;
        for (std::size_t i = 0; i < masses_.size(); ++i)
            sum += velocity(simulation.deformable(), i) * masses_[i];
        return sum;
    }
    /// About the origin.
    Vec3d angular_momentum(const Simulation& simulation) const {
        const Deformable& body = simulation.deformable();
        Vec3d sum;
        for (std::size_t i = 0; i < masses_.size(); ++i)
            sum += cross(Vec3d(body.positions[i]), velocity(body, i) * masses_[i]);
        return sum;
    }

  private:
    static Vec3d velocity(const Deformable& body, std::size_t i) { return Vec3d(body.velocities[i]); }

    Vec3d gravity_;
    std::vector<double> masses_;
    std::optional<ElasticModel> model_;
};

/// @param velocity_at  of a place
template <typename VelocityAt>
void throw_with(Deformable& body, const VelocityAt& velocity_at) {
    for (const Vec3f& place : body.positions) body.velocities.push_back(Vec3f(velocity_at(Vec3d(place))));
}

/// @param scale  of the energy, J
void add_energy(const std::string& what, Simulation simulation, double seconds, double scale, Table& table) {
    const double pace = 1 / simulation.options().time_step;
    const Judge judge(simulation);
    double before = judge.energy(simulation), growth = 0;
    const double start = before;
    for (int i = 0; i < seconds * pace; ++i) {
        simulation.step();
        const double now = judge.energy(simulation);
        growth = std::max(growth, now - before);
        before = now;
    }
    table.add("energy of a " + what + ": most that a frame gains", pace, 100 * growth / scale, 0, "%");
    table.add(fmt::format("energy of a {}: lost in {} s", what, seconds), pace,
              100 * (start - before) / scale, 0, "%");
}

void add_energies(const Setting& setting, Table& table) {
    const double seconds = setting.is_short ? 0.2 : 4;
    for (const double pace : {60.0, 120.0}) {
        SimulationOptions weightless = undamped(pace);
        weightless.gravity = {};
        Deformable block = make_soft_body(make_solid_box({0.4, 0.2, 0.2}, {8, 4, 4}), {.young_modulus = 2e4});
        throw_with(block, [](const Vec3d& p) { return cross(Vec3d{1, 2, 3}, p) + Vec3d{2 * p.x, -p.y, 0}; });
        const Simulation body(block, {}, weightless);
        add_energy("free soft block", body, seconds, Judge(body).energy(body), table);

        constexpr std::uint32_t kSide = 33;
        ClothOptions sheet{.column_count = kSide, .row_count = kSide};
        for (std::uint32_t column = 0; column < kSide; ++column) sheet.pins.push_back(column);
        const SimulationOptions options = undamped(pace);
        add_energy("sheet that swings down", Simulation(make_cloth(sheet), {}, options), seconds,
                   options.newton().material.density * kGravity / 2, table);
    }
}

void add_momenta(const Setting& setting, Table& table) {
    const double seconds = setting.is_short ? 0.2 : 2;
    for (const double pace : {60.0, 120.0, 240.0}) {
        SimulationOptions weightless = undamped(pace);
        weightless.gravity = {};
        Deformable sheet = make_cloth({.column_count = 33, .row_count = 33});
        throw_with(sheet, [](const Vec3d& p) {
            return Vec3d{0.5, -0.2, 0.3} + cross(Vec3d{3, 1, 1}, p) + Vec3d{0, 0, 2 * p.x * p.x};
        });
        Simulation simulation(sheet, {}, weightless);
        const Judge judge(simulation);
        const Vec3d linear = judge.momentum(simulation), angular = judge.angular_momentum(simulation);
        while (simulation.frame() < seconds * pace) simulation.step();
        const auto changed = [](const Vec3d& now, const Vec3d& before) {
            return 100 * length(now - before) / length(before);
        };
        table.add("momentum of a free sheet that tumbles: changed in 2 s", pace,
                  changed(judge.momentum(simulation), linear), 0, "%");
        table.add("angular momentum of a free sheet that tumbles: changed in 2 s", pace,
                  changed(judge.angular_momentum(simulation), angular), 0, "%");
    }
}

// ---- A chain ----

/// How far a chain of length 1 sags below its ends, which are `span` apart.
double catenary_sag(double span) {
    double low = 1e-3, high = 100; // of the parameter a: the length is 2 a sinh(span / 2a)
    for (int i = 0; i < 100; ++i) {
        const double a = (low + high) / 2;
        (2 * a * std::sinh(span / (2 * a)) > 1 ? low : high) = a;
    }
    return low * (std::cosh(span / (2 * low)) - 1);
}

/// It begins as a triangle that hangs down.
void add_chain(Table& table) {
    constexpr std::uint32_t kPieces = 64;
    constexpr double kSpan = 1 / 1.3;
    const double depth = std::sqrt(0.25 - kSpan * kSpan / 4);
    TriangleMesh start;
    MeshClothOptions thread{.pins = {0, kPieces}};
    for (std::uint32_t i = 0; i <= kPieces; ++i) {
        const double share = double(i) / kPieces;
        start.vertices.push_back(Vec3f(Vec3d{kSpan * share, 0, -depth * (1 - std::abs(2 * share - 1))}));
        if (i > 0) thread.threads.push_back({i - 1, i});
    }
    SimulationOptions options{.solver = NewtonOptions{.air_drag = 3, .collision = CollisionMode::Particles}};
    options.newton().material.stretch_stiffness = 1e5; // it hardly stretches
    Simulation chain(make_cloth(start, thread), {}, options);
    while (chain.frame() < 600) chain.step();
    table.add("sag of a chain", 60, -double{chain.positions()[kPieces / 2].z}, catenary_sag(kSpan), "m");
}

// ---- Beams and bars ----

struct Beam {
    const char* kind;
    double slenderness, poisson_ratio;
    std::uint32_t segments; ///< across its height
};

constexpr double kBeamDensity = 1000, kBeamGravity = 10, kYoung = 5e7; // SI

/// Of the end of a beam of a metre under its own weight: Timoshenko's, with Cowper's shear coefficient of a
/// rectangle; of a bar that hangs, Hooke's.
double expected_way(const Beam& beam) {
    const double strain = kBeamDensity * kBeamGravity / kYoung;
    if (beam.kind == std::string("bar")) return strain / 2;
    return strain * (1.5 * beam.slenderness * beam.slenderness + (12 + 11 * beam.poisson_ratio) / 10);
}

void add_beam(const Beam& beam, const Setting& setting, Records& records) {
    const bool hangs = beam.kind == std::string("bar");
    const double height = 1 / beam.slenderness, spacing = height / beam.segments;
    const std::uint32_t across = hangs ? beam.segments : beam.segments / 2;
    TetrahedralMesh mesh =
        make_solid_box({1, across * spacing, height},
                       {static_cast<std::uint32_t>(std::lround(1 / spacing)), across, beam.segments});
    SoftBodyOptions material{
        .density = kBeamDensity, .young_modulus = kYoung, .poisson_ratio = beam.poisson_ratio};
    std::vector<std::uint32_t> end;
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
        mesh.vertices[i].x += 0.5F;
        if (mesh.vertices[i].x < 1e-4F) material.pins.push_back(i);
        if (mesh.vertices[i].x > 1 - 1e-4F) end.push_back(i);
    }
    const Vec3d down = hangs ? Vec3d{1, 0, 0} : Vec3d{0, 0, -1};
    const double pace =
        std::sqrt(kYoung / kBeamDensity) * (hangs ? std::numbers::pi / 2 : 3.516 * height / std::sqrt(12.0));
    // The drag of the air makes the lowest oscillation die away soonest.
    Simulation simulation(
        make_soft_body(mesh, material), {},
        {.solver = NewtonOptions{.air_drag = 1.6 * pace, .collision = CollisionMode::Particles},
         .gravity = down * kBeamGravity});
    constexpr std::uint32_t kFrames = 60;
    const double start = comparison::thread_seconds();
    while (simulation.frame() < kFrames) {
        simulation.step();
        setting.report_progress(fmt::format("{} of {} segments", beam.kind, beam.segments),
                                double(simulation.frame()) / kFrames);
    }
    const double seconds = comparison::thread_seconds() - start;
    double way = 0;
    for (const std::uint32_t i : end)
        way += dot(Vec3d(simulation.positions()[i]) - Vec3d(mesh.vertices[i]), down) /
               static_cast<double>(end.size());
    records.add({{"table", "beams"},
                 {"what", beam.kind},
                 {"poisson_ratio", fmt::format("{}", beam.poisson_ratio)},
                 {"segments", fmt::format("{}", beam.segments)},
                 {"tetrahedra", fmt::format("{}", mesh.tetrahedra.size())},
                 {"measured", fmt::format("{:.6g}", way)},
                 {"expected", fmt::format("{:.6g}", expected_way(beam))},
                 {"unit", "m"},
                 {"frame_ms", fmt::format("{:.4g}", 1e3 * seconds / kFrames)}});
    setting.store(records);
}

void add_beams(const Setting& setting, Records& records) {
    const auto sizes = [&](std::vector<std::uint32_t> all) {
        if (setting.is_short) all.resize(1);
        return all;
    };
    for (const double poisson : {0.3, 0.45, 0.49}) {
        for (const std::uint32_t segments : sizes({2, 4, 8, 16}))
            add_beam({"beam", 5, poisson, segments}, setting, records);
        for (const std::uint32_t segments : sizes({3, 6, 12}))
            add_beam({"bar", 8, poisson, segments}, setting, records);
    }
}

} // namespace

Records measure_mechanics(const Setting& setting) {
    Records records({"table", "what", "frames_per_second", "poisson_ratio", "segments", "tetrahedra",
                     "measured", "expected", "unit", "frame_ms"});
    Table table(records, setting);
    add_pendulums(setting, table);
    add_energies(setting, table);
    add_momenta(setting, table);
    add_chain(table);
    add_beams(setting, records);
    return records;
}
