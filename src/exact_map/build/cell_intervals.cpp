#include "exact_map/build/cell_intervals.hpp"

#include "directions/crossing.hpp"
#include "exact_map/layout.hpp"
#include "geometry/parallel.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <string>

namespace echinus {

namespace {

/// Asked while faces are covered, before their number fills the memory.
void require_manageable(std::size_t total) {
    constexpr std::size_t kMost = std::size_t{1} << 28; // 32 bytes each, for the moment
    if (total <= kMost) return;
    throw Error(ErrorCode::InvalidMesh, "the faces pass through cells more than " + std::to_string(kMost) +
                                            " times, which is more than a map can hold; take fewer cells, or "
                                            "drop faces that lie on each other");
}

/// In band units, widened to whole ones.
std::uint64_t range_of(const CellCover& cover) {
    constexpr double kRounding = 0.01; // lattice steps, far above what the cover rounds
    const auto lower = static_cast<std::int32_t>(std::max(0.0, cover.nearest - kRounding));
    const auto upper = static_cast<std::int32_t>(cover.farthest + kRounding) + 1;
    const auto first = static_cast<std::uint64_t>(band_unit_of(lower));
    const auto last = static_cast<std::uint64_t>(band_unit_of(upper) + 1);
    return first << 16 | last;
}

/// A face on its way into the lists of the cells.
struct CoveredFace {
    std::uint32_t number;
    std::array<LatticePoint, 3> corners;
    std::int64_t determinant;

    bool meets(MiddleRay ray, const OctahedralCells& cells, std::uint32_t cell) const {
        if (ray != MiddleRay::Unsure) return ray == MiddleRay::Meets;
        return FaceCone(corners[0], corners[1], corners[2]).meets(cells.middle(cell));
    }

    Interval interval(const CellCover& cover, const OctahedralCells& cells) const {
        const int outward = (determinant > 0) - (determinant < 0);
        const bool counts = determinant != 0 && meets(cover.middle, cells, cover.cell);
        return {range_of(cover) << 32 | number, cover.cell, cover.parts,
                static_cast<std::int8_t>(counts ? outward : 0), determinant == 0};
    }
};

/// Counts over all threads, but seldom.
class CoverCount {
  public:
    explicit CoverCount(std::atomic<std::size_t>& total) : total_(total) {}

    void add(std::size_t count) {
        constexpr std::size_t kPortion = 1U << 16;
        mine_ += count;
        if (mine_ < kPortion) return;
        require_manageable(total_ += mine_);
        mine_ = 0;
    }

  private:
    std::atomic<std::size_t>& total_;
    std::size_t mine_ = 0;
};

} // namespace

void CellIntervals::find(const LatticeMesh& lattice, const OctahedralCells& cells, unsigned thread_count) {
    cover_all_faces(lattice, cells, thread_count);
    set_offsets(cells.count());
    parallel_for(workers_.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t w = begin; w < end; ++w)
            for (const Interval& interval : workers_[w].found)
                by_cell_[workers_[w].next[interval.cell]++] = interval;
    });
}

void CellIntervals::cover_all_faces(const LatticeMesh& lattice, const OctahedralCells& cells,
                                    unsigned thread_count) {
    workers_.resize(worker_count(thread_count));
    constexpr std::size_t kCellsPerFace = 8; // seldom more; what is not needed costs no memory
    for (Worker& worker : workers_) {
        worker.found.clear();
        worker.found.room_for(kCellsPerFace * lattice.faces.size() / workers_.size());
        worker.next.assign(cells.count(), 0);
    }
    std::atomic<std::size_t> total = 0;
    parallel_for_workers(
        lattice.faces.size(), thread_count, [&](std::size_t w, std::size_t begin, std::size_t end) {
            Worker& worker = workers_[w];
            CoverCount count(total);
            for (std::size_t i = begin; i < end; ++i) {
                const auto number = static_cast<std::uint32_t>(i);
                const auto corners = lattice.corners(number);
                if (is_collapsed(corners)) continue;
                worker.covers.clear();
                cover_cells(cells, corners, worker.covers);
                count.add(worker.covers.size());
                const CoveredFace face{number, corners, dot(corners[0], cross(corners[1], corners[2]))};
                Interval* next = worker.found.room_for(worker.covers.size());
                for (const CellCover& cover : worker.covers) {
                    *next++ = face.interval(cover, cells);
                    ++worker.next[cover.cell];
                }
                worker.found.extend(worker.covers.size());
            }
        });
}

void CellIntervals::set_offsets(std::size_t cell_count) {
    offsets_.reset(cell_count + 1);
    std::uint32_t offset = 0;
    for (std::size_t cell = 0; cell < cell_count; ++cell) {
        offsets_[cell] = offset;
        for (Worker& worker : workers_) {
            const std::uint32_t count = worker.next[cell];
            worker.next[cell] = offset;
            offset += count;
        }
    }
    offsets_[cell_count] = offset;
    by_cell_.reset(offset);
}

} // namespace echinus
