#pragma once

#include "simulation/particles.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// Sheets with every second, every fourth ... row and column of the sheets that a deformable consists of. A
/// relaxation of sticks carries what pulls at one end of a sheet a few rows on; in a coarse sheet that is
/// far. So each is relaxed, from the coarsest on, and what moved there is interpolated to the next finer one
/// and at last to the particles (Mueller 2008, "Hierarchical Position Based Dynamics").
///
/// A coarse stick is as long as the sticks along its way, and only pulls: cloth between its ends may lie in
/// folds. A coarse particle weighs what is moved with it, so that the momentum of what is free stays as it
/// is, and where a pinned one is near it stands still.
class CoarseSheets {
  public:
    /// Finds the sheets: faces as make_cloth() lays them, row by row.
    /// @pre the deformable is valid
    explicit CoarseSheets(const Deformable& deformable);

    bool empty() const { return sheets_.empty(); }
    void relax(Particles& particles);

    /// Where a row or column stands between those of the next coarser level.
    struct Between {
        std::uint32_t cell; ///< of the coarser row or column before
        float share;        ///< of the one after it
    };
    struct CoarseStick {
        std::uint32_t a, b;
        float share_a, share_b, rest_length;
    };
    /// Some rows and columns of a sheet, by their numbers in it, and how they stand between those of the next
    /// coarser level, if there is one.
    struct Level {
        std::vector<std::uint32_t> rows, columns;
        std::vector<Between> rows_between, columns_between;
        std::vector<CoarseStick> sticks;
        std::vector<Vec3f> starts, places; ///< by row and column

        std::size_t count() const { return rows.size() * columns.size(); }
    };
    /// Level 0 is the sheet itself, without sticks.
    struct Sheet {
        std::uint32_t first, column_count;
        std::vector<Level> levels;
    };

  private:
    std::vector<Sheet> sheets_;
};

} // namespace echinus
