#pragma once

#include "compare/measuring.hpp"
#include "support/point_sets.hpp"

#include <echinus/mesh.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// The paper's comparison, for any mesh: each system's bytes and time, and how often and how far it is wrong.
namespace echinus::comparison {

/// In R: a little more than the exact map's lattice step.
inline constexpr double kUndecided = 2e-6;

struct CompareOptions {
    std::vector<std::string> systems{}; ///< their names; empty: all that this program has
    std::size_t byte_budget = 630'000;  ///< of each, the size of the paper's map of a horse
    std::size_t point_count = 100'000;  ///< particles in a set, at least 100
    test::Axis up = test::Axis::Z;      ///< for the set C
    SystemOptions system{};
    /// How many sizes each curve is made of: the budget times powers of two, up to kTopOfCurve times; 0: no
    /// curves. Builds and measures each system so many times more.
    std::size_t curve_length = 0;
    std::function<void(const std::string& what, double fraction)> report_progress{};

    static constexpr std::size_t kTopOfCurve = 8;
    static constexpr std::size_t kMaxBytes = 1'000'000'000; ///< of a budget, and of what curves are made of
};

/// A system in one size.
struct Figures {
    const SystemType* system;
    std::size_t byte_count;
    std::string counted; ///< what the bytes comprise
    std::string excess;  ///< why it takes more bytes than the budget; empty when it does not
    double build_ms;     ///< processor time of all threads, the median of several builds where they are quick
    std::vector<SetFigures> sets;
};

/// A system that could not be built, and why.
struct Refusal {
    const SystemType* system;
    std::string reason;
};

struct Comparison {
    std::size_t face_count;
    double radius; ///< R, of the bounding sphere
    std::vector<std::string> set_names;
    std::vector<Figures> systems; ///< each as large as the budget allows, on all sets
    std::vector<Refusal> refusals;
    /// Do parts of the surface overlap, or lie in each other, where particles are? Systems that count
    /// crossings, and not windings, then take other places for inside.
    bool parts_overlap;
    /// Each on S alone, in ascending sizes; in the order of `systems`, of which those that have one size are
    /// a point. Empty without curves.
    std::vector<std::vector<Figures>> curves;
};

/// Builds all systems around the mesh and queries them with the same particles, taking turns on one thread.
/// The judge is an ExactMap's nearest point; echinus-check verifies it (docs/accuracy.md). Where parts of the
/// surface overlap, depths inside are to the nearest surface, within the solid or not. The map is exact on
/// its lattice: particles nearer to the surface than kUndecided R never count as wrong.
///
/// Times are processor times, comparable only within one run. Everything else depends on mesh and options
/// only.
/// @throws Error InvalidMesh for a mesh that is not closed or has no area; InvalidOptions for a system that
/// does not exist, is not there or is named twice, when none fits, for a budget of 0 or above kMaxBytes, or
/// fewer than 100 particles; and what report_progress throws
Comparison compare(const TriangleMesh& mesh, const CompareOptions& options = {});

} // namespace echinus::comparison
