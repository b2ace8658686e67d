#include "exact_map/build/cell_intervals.hpp"

#include "directions/face_cone.hpp"
#include "exact_map/layout.hpp"
#include "geometry/parallel.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <array>

namespace echinus {

namespace {

/// The range of a cover in band units, widened to integers. It is never empty, since the cover's range
/// ascends, and fits into 16 bits, since it ends within the lattice.
std::uint64_t range_of(const CellCover& cover) {
    constexpr double kRounding = 0.01; // lattice steps, far above the rounding errors of the cover
    static_assert((kMostL1Norm + 1) / ExactMapView::kBandUnit + 1 <= 0xFFFF);
    const auto lower = truncated_to<std::int32_t>(std::max(0.0, cover.nearest - kRounding));
    const auto upper = truncated_to<std::int32_t>(cover.farthest + kRounding) + 1;
    return packed<16>(static_cast<std::uint64_t>(band_unit_of(lower)),
                      static_cast<std::uint64_t>(band_unit_of(upper)) + 1);
}

/// A face that is being added to the lists of cells.
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
        return {packed<32>(range_of(cover), number), cover.cell, cover.parts,
                static_cast<std::int8_t>(counts ? outward : 0), determinant == 0};
    }
};

} // namespace

bool CellIntervals::find(const LatticeMesh& lattice, const OctahedralCells& cells, const Octants& octants,
                         unsigned thread_count, LimitedCount& count) {
    const auto cells_per_octant = static_cast<std::uint32_t>(cells.count() / 8);
    first_cell_ = octants.first * cells_per_octant;
    offsets_.reset(std::size_t{octants.count()} * cells_per_octant + 1);
    if (octants.first == 0 && octants.count() < 8) find_octants_met(lattice, thread_count);
    cover_all_faces(lattice, cells, octants, thread_count, count);
    if (count.exceeded()) return false;
    set_offsets();
    parallel_for(workers_.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t w = begin; w < end; ++w)
            for (const Interval& interval : workers_[w].found)
                by_cell_[workers_[w].next[interval.cell - first_cell_]++] = interval;
    });
    return true;
}

void CellIntervals::find_octants_met(const LatticeMesh& lattice, unsigned thread_count) {
    octants_met_.reset(lattice.faces.size());
    parallel_for(lattice.faces.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t face = begin; face < end; ++face)
            octants_met_[face] =
                static_cast<std::uint8_t>(octants_met(lattice.corners(static_cast<std::uint32_t>(face))));
    });
}

void CellIntervals::cover_all_faces(const LatticeMesh& lattice, const OctahedralCells& cells,
                                    const Octants& octants, unsigned thread_count, LimitedCount& total) {
    workers_.resize(worker_count(thread_count));
    const std::size_t cells_per_face = octants.count(); // a face seldom touches more
    const bool all_octants = octants.count() == 8;
    for (Worker& worker : workers_) {
        worker.found.clear();
        worker.found.room_for(cells_per_face * lattice.faces.size() / workers_.size());
        worker.next.assign(cell_count(), 0);
    }
    parallel_for_workers(
        lattice.faces.size(), thread_count, [&](std::size_t w, std::size_t begin, std::size_t end) {
            Worker& worker = workers_[w];
            CountShare count(total);
            for (std::size_t i = begin; i < end; ++i) {
                if (!all_octants && (octants_met_[i] & octants.bits()) == 0) continue;
                const auto number = static_cast<std::uint32_t>(i);
                const auto corners = lattice.corners(number);
                if (is_collapsed(corners)) continue;
                worker.covers.clear();
                cover_cells(cells, octants, corners, worker.covers);
                if (worker.covers.empty()) continue;
                if (!count.add(worker.covers.size())) return;
                const CoveredFace face{number, corners, dot(corners[0], cross(corners[1], corners[2]))};
                Interval* next = worker.found.room_for(worker.covers.size());
                for (const CellCover& cover : worker.covers) {
                    *next++ = face.interval(cover, cells);
                    ++worker.next[cover.cell - first_cell_];
                }
                worker.found.extend(worker.covers.size());
            }
        });
}

void CellIntervals::set_offsets() {
    std::uint32_t offset = 0; // at most BandFinder::kMostIntervals, 2^28
    for (std::size_t cell = 0; cell < cell_count(); ++cell) {
        offsets_[cell] = offset;
        for (Worker& worker : workers_) {
            const std::uint32_t count = worker.next[cell];
            worker.next[cell] = offset;
            offset += count;
        }
    }
    offsets_[cell_count()] = offset;
    by_cell_.reset(offset);
}

} // namespace echinus
