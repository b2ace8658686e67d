#pragma once

#include "rivals/system.hpp"

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace echinus::comparison {

using rivals::Progress;

using Built = std::unique_ptr<const rivals::System>;

/// Builds a system in a fixed size, any number of times.
struct Builder {
    std::function<Built()> build;
    /// Processor time of what all sizes have in common and `build` need not do again, seconds.
    double shared_seconds = 0;
};

/// One system around one mesh, in all its sizes.
class Sizes {
  public:
    virtual ~Sizes() = default;

    /// The finest that takes at most this many bytes. A system without sizes is built as it is.
    /// @throws Error InvalidOptions when the coarsest exceeds the budget, or as the system's own build does
    virtual Builder within(std::size_t byte_budget) = 0;

    /// The usual size, for a system worth showing even where its coarsest exceeds the budget.
    virtual std::optional<Builder> usual() { return {}; }
};

struct SystemOptions {
    std::uint32_t segment_count = 0; ///< of the superquadric map; 0: as many as the shape asks for
};

/// A system that takes part.
struct SystemType {
    std::string_view name;    ///< one word, as in options: "dense-16bit"
    std::string_view title;   ///< for people: "dense grid, 16 bit"
    std::string_view package; ///< what it is built with, where that need not be there
    bool has_sizes;           ///< does its number of bytes depend on a budget?
    /// Empty when this program was built without the system. @param mesh  outlives what is returned
    std::function<std::unique_ptr<Sizes>(const TriangleMesh& mesh, const SystemOptions&, const Progress&)> on;

    bool available() const { return static_cast<bool>(on); }
};

/// All systems, ours first; including those that this program was built without.
const std::vector<SystemType>& all_systems();

/// @throws Error InvalidOptions for a name that no system has, naming those that do, and for a system that
/// this program was built without, naming what it needs
const SystemType& system_named(std::string_view name);

} // namespace echinus::comparison
