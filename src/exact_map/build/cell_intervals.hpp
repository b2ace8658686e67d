#pragma once

#include "directions/lattice.hpp"
#include "directions/octahedral_cells.hpp"
#include "exact_map/build/cell_cover.hpp"
#include "geometry/arena.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// A count that several threads share, with a limit. Whether it finally exceeds the limit does not depend on
/// which thread counted which items.
class LimitedCount {
  public:
    explicit LimitedCount(std::size_t most) : most_(most) {}

    void add(std::size_t count) { total_.fetch_add(count, std::memory_order_relaxed); }
    bool exceeded() const { return total_.load(std::memory_order_relaxed) > most_; }

  private:
    std::size_t most_;
    std::atomic<std::size_t> total_ = 0;
};

/// One thread's share of a LimitedCount, added in large portions, so that threads seldom contend for it.
class CountShare {
  public:
    explicit CountShare(LimitedCount& total) : total_(total) {}
    ~CountShare() { total_.add(mine_); }
    CountShare(const CountShare&) = delete;
    CountShare& operator=(const CountShare&) = delete;

    /// @returns  false if all threads together are known to have counted too many
    bool add(std::size_t count) {
        constexpr std::size_t kPortion = 1U << 16;
        mine_ += count;
        if (mine_ < kPortion) return true;
        total_.add(mine_);
        mine_ = 0;
        return !total_.exceeded();
    }

  private:
    LimitedCount& total_;
    std::size_t mine_ = 0;
};

/// The range of a face in a cell.
struct Interval {
    /// From the high bits to the low: the lower and upper end in band units, rounded outwards, and the face.
    /// Its order is that of intervals.
    std::uint64_t key;
    std::uint32_t cell;
    std::uint16_t parts;
    std::int8_t crossing; ///< crossing of the ray through the cell's middle: 1 outwards, -1 inwards, 0 none
    bool edge_on;         ///< no ray meets the face, but it does separate the inside from the outside

    std::uint16_t lower() const { return static_cast<std::uint16_t>(key >> 48); }
    std::uint16_t upper() const { return static_cast<std::uint16_t>(key >> 32); }
    std::uint32_t face() const { return static_cast<std::uint32_t>(key); }
};
static_assert(sizeof(Interval) == 16);

/// The faces of every cell of some octants, and the memory that the search takes: two intervals for each that
/// is found.
class CellIntervals {
  public:
    /// Covers all faces and sorts the intervals by cell. Each worker lists the intervals that it finds and
    /// counts them per cell, so that afterwards it knows where its intervals go (a counting sort).
    /// @param octants  all octants, or one at a time, beginning with the first
    /// @param count    the intervals are added to it
    /// @returns  false if the count exceeded its limit; the object then holds no intervals
    bool find(const LatticeMesh& lattice, const OctahedralCells& cells, const Octants& octants,
              unsigned thread_count, LimitedCount& count);

    std::size_t count() const { return by_cell_.size(); }
    std::uint32_t first_cell() const { return first_cell_; }
    std::size_t cell_count() const { return offsets_.size() - 1; }

    /// A cell's intervals, in a nondeterministic order; the caller may sort them.
    /// @pre first_cell() <= cell < first_cell() + cell_count()
    std::span<Interval> of(std::uint32_t cell) {
        const std::size_t i = cell - first_cell_;
        return std::span<Interval>(by_cell_).subspan(offsets_[i], offsets_[i + 1] - offsets_[i]);
    }

  private:
    struct Worker {
        std::vector<CellCover> covers;
        Arena<Interval> found;
        std::vector<std::uint32_t> next; ///< [cell_count] number of intervals; later, index of the next one
    };

    void cover_all_faces(const LatticeMesh& lattice, const OctahedralCells& cells, const Octants& octants,
                         unsigned thread_count, LimitedCount& count);
    void find_octants_met(const LatticeMesh& lattice, unsigned thread_count);
    void set_offsets();

    Arena<std::uint8_t> octants_met_; ///< [face_count] of each face; unused if all octants are searched
    std::uint32_t first_cell_ = 0;
    std::vector<Worker> workers_;
    Arena<Interval> by_cell_;
    Arena<std::uint32_t> offsets_; ///< [cell_count + 1]
};

} // namespace echinus
