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

/// One thread's share of a LimitedCount, handed in by large portions: threads seldom meet there.
class CountShare {
  public:
    explicit CountShare(LimitedCount& total) : total_(total) {}
    ~CountShare() { total_.add(mine_); }
    CountShare(const CountShare&) = delete;
    CountShare& operator=(const CountShare&) = delete;

    /// @returns  false when it is known that all threads together have counted too much
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

/// A face's range in a cell.
struct Interval {
    /// Lower and upper end in band units, rounded outwards, and the face, from the high bits to the low: the
    /// order of intervals.
    std::uint64_t key;
    std::uint32_t cell;
    std::uint16_t parts;
    std::int8_t crossing; ///< of the ray through the cell's middle: 1 outwards, -1 inwards, 0 none
    bool edge_on;         ///< no ray meets the face, but it does part the inside from the outside

    std::uint16_t lower() const { return static_cast<std::uint16_t>(key >> 48); }
    std::uint16_t upper() const { return static_cast<std::uint16_t>(key >> 32); }
    std::uint32_t face() const { return static_cast<std::uint32_t>(key); }
};
static_assert(sizeof(Interval) == 16);

/// The faces of every cell of some octants, and the memory that it takes to find them: two intervals for each
/// that is found.
class CellIntervals {
  public:
    /// Covers all faces and puts what was found by cells: each worker lists what it finds, and counts it by
    /// cells, so that afterwards each knows where its own goes (a counting sort).
    /// @param octants  all, or one after the other, beginning with the first
    /// @param count    to which the intervals are added
    /// @returns  false when the count was exceeded; nothing is found then
    bool find(const LatticeMesh& lattice, const OctahedralCells& cells, const Octants& octants,
              unsigned thread_count, LimitedCount& count);

    std::size_t count() const { return by_cell_.size(); }
    std::uint32_t first_cell() const { return first_cell_; }
    std::size_t cell_count() const { return offsets_.size() - 1; }

    /// A cell's intervals, in an order that depends on chance; the caller may sort them.
    /// @pre first_cell() <= cell < first_cell() + cell_count()
    std::span<Interval> of(std::uint32_t cell) {
        const std::size_t i = cell - first_cell_;
        return std::span<Interval>(by_cell_).subspan(offsets_[i], offsets_[i + 1] - offsets_[i]);
    }

  private:
    struct Worker {
        std::vector<CellCover> covers;
        Arena<Interval> found;
        std::vector<std::uint32_t> next; ///< [cell_count] how many in each cell; then, where the next goes
    };

    void cover_all_faces(const LatticeMesh& lattice, const OctahedralCells& cells, const Octants& octants,
                         unsigned thread_count, LimitedCount& count);
    void find_octants_met(const LatticeMesh& lattice, unsigned thread_count);
    void set_offsets();

    Arena<std::uint8_t> octants_met_; ///< [face_count] by each face; of no use when all octants are asked for
    std::uint32_t first_cell_ = 0;
    std::vector<Worker> workers_;
    Arena<Interval> by_cell_;
    Arena<std::uint32_t> offsets_; ///< [cell_count + 1]
};

} // namespace echinus
