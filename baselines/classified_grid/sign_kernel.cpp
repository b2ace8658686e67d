// contains_batch() in vector instructions. First every particle gets the state of its cell, which settles all
// but those in cells on the surface. These are sorted by cell. Then, cell after cell, each listed face
// becomes four linear functions of the particle's place, and particles are lanes.

#include "baselines/classified_grid/kernels.hpp"
#include "baselines/classified_grid/nearest.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "baselines/classified_grid/sign_kernel.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "baselines/classified_grid/lookup-inl.hpp"
#include "simd/dispatch.hpp"

#ifndef ECHINUS_CLASSIFIED_GRID_SIGN_KERNEL_ONCE
#define ECHINUS_CLASSIFIED_GRID_SIGN_KERNEL_ONCE
namespace echinus::baselines {

/// Particles that are sorted together: enough that cells on the surface get many each, few enough that they
/// stay in the outer caches.
constexpr std::size_t kChunk = std::size_t{1} << 18;
constexpr std::size_t kMostLanes = 16;
constexpr std::size_t kBlocks = 32; ///< of kMostLanes faces that are prepared together

/// A particle in a cell on the surface, from the cell's centre, in lattice steps: whole numbers.
struct alignas(16) SortedParticle {
    float x, y, z;
    std::uint32_t number; ///< in the chunk
};

/// One face of one list, prepared with the 15 others of its block. The particle p is separated from the
/// centre by the face where four functions are positive: of its edges n_k . p, and of its plane n_3 . p + d.
/// All are divided by the bound of what rounding can do to them, so that beyond 1 a sign is sure.
struct alignas(64) FaceBlock {
    float functions[13][kMostLanes];
    std::int32_t crossings[kMostLanes]; ///< what crossing it adds to the winding number
};

struct SignScratch {
    std::unique_ptr<float[]> x, y, z;
    std::unique_ptr<std::uint32_t[]> numbers, cells; ///< cells: brick << 6 | cell in brick, then the list
    std::unique_ptr<SortedParticle[]> sorted;
    std::vector<std::uint32_t> cursors; ///< [list_count + 1]
    std::vector<FaceBlock> blocks;
    std::vector<std::uint32_t> faces;     ///< [kBlocks kMostLanes]
    std::vector<std::int32_t> centres[3]; ///< of their cells

    explicit SignScratch(const GridArrays& grid, std::size_t size)
        : x(new float[size + kMostLanes]), y(new float[size + kMostLanes]), z(new float[size + kMostLanes]),
          numbers(new std::uint32_t[size + kMostLanes]), cells(new std::uint32_t[size + kMostLanes]),
          sorted(new SortedParticle[size + kMostLanes]), cursors(grid.list_begins.size() + 1),
          blocks(kBlocks), faces(kBlocks * kMostLanes) {
        for (auto& c : centres) c.resize(kBlocks * kMostLanes);
    }
};

} // namespace echinus::baselines
#endif

HWY_BEFORE_NAMESPACE();
namespace echinus::baselines::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

void contains_chunk(const GridArrays& grid, SignScratch&, std::span<const Vec3f> points,
                    std::span<std::uint8_t> inside) {
    for (std::size_t i = 0; i < points.size(); ++i) inside[i] = is_inside(grid, points[i]) ? 1 : 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;

class SignKernel {
  public:
    SignKernel(const GridArrays& grid, SignScratch& scratch) : grid_(grid), frame_(grid.frame), s_(scratch) {}

    HWY_ATTR void run(std::span<const Vec3f> points, std::span<std::uint8_t> inside) {
        points_ = points;
        inside_ = inside;
        const std::size_t count = settle();
        if (count == 0) return;
        number_lists(count);
        take_from_centres(count);
        sort(count);
        test_cells();
    }

  private:
    /// States of all cells; returns how many particles are left, whose numbers and places are kept.
    HWY_ATTR std::size_t settle() {
        const Floats df;
        const Ints di;
        const hn::Rebind<std::uint32_t, Floats> du;
        const hn::Rebind<std::uint8_t, Floats> d8;
        const std::size_t n = hn::Lanes(df);
        const CellLookup lookup(grid_);
        std::size_t count = 0, i = 0;
        alignas(64) float padded[3 * kMostLanes] = {};
        for (; i < points_.size(); i += n) {
            const std::size_t left = points_.size() - i;
            const float* from = &points_[i].x;
            if (HWY_UNLIKELY(left < n)) {
                std::memcpy(padded, from, left * sizeof(Vec3f));
                from = padded;
            }
            hn::VFromD<Floats> x, y, z;
            hn::LoadInterleaved3(df, from, x, y, z);
            const auto found = lookup(x, y, z);
            const auto bits = hn::And(found.state, hn::Set(di, std::int32_t{kInsideBit}));
            const auto bytes = hn::DemoteTo(d8, bits);
            auto on_surface = hn::Gt(found.state, hn::Set(di, std::int32_t{kInsideBit}));
            if (HWY_UNLIKELY(left < n)) {
                alignas(64) std::uint8_t answers[kMostLanes];
                hn::StoreU(bytes, d8, answers);
                std::memcpy(&inside_[i], answers, left);
                on_surface = hn::And(on_surface, hn::RebindMask(di, hn::FirstN(df, left)));
            } else {
                hn::StoreU(bytes, d8, &inside_[i]);
            }
            if (hn::AllFalse(di, on_surface)) continue;
            const auto mask = hn::RebindMask(df, on_surface);
            hn::CompressStore(x, mask, df, &s_.x[count]);
            hn::CompressStore(y, mask, df, &s_.y[count]);
            hn::CompressStore(z, mask, df, &s_.z[count]);
            hn::CompressStore(hn::BitCast(du, found.cell), hn::RebindMask(du, on_surface), du,
                              &s_.cells[count]);
            count += hn::CompressStore(hn::Iota(du, static_cast<std::uint32_t>(i)),
                                       hn::RebindMask(du, on_surface), du, &s_.numbers[count]);
        }
        return count;
    }

    /// Replaces cells by their lists, and counts the particles of each.
    HWY_ATTR void number_lists(std::size_t count) {
        std::fill(s_.cursors.begin(), s_.cursors.end(), 0);
        for (std::size_t i = 0; i < count; ++i) {
            const Brick& brick = grid_.bricks[s_.cells[i] >> 6];
            const std::uint32_t list = brick.first_list + rank_in_brick(brick, s_.cells[i] & 63);
            s_.cells[i] = list;
            ++s_.cursors[list + 1];
        }
    }

    /// Snaps particles to the lattice and counts from the centres of their cells.
    HWY_ATTR void take_from_centres(std::size_t count) {
        const Floats df;
        const std::size_t n = hn::Lanes(df);
        const CellLookup lookup(grid_);
        for (std::size_t i = count; i < count + n; ++i) s_.x[i] = s_.y[i] = s_.z[i] = 0;
        for (std::size_t i = 0; i < count; i += n) {
            const auto place =
                lookup.from_centre(hn::LoadU(df, &s_.x[i]), hn::LoadU(df, &s_.y[i]), hn::LoadU(df, &s_.z[i]));
            hn::StoreU(place.x, df, &s_.x[i]);
            hn::StoreU(place.y, df, &s_.y[i]);
            hn::StoreU(place.z, df, &s_.z[i]);
        }
    }

    /// By list. Afterwards cursors[l] is where list l ends.
    HWY_ATTR void sort(std::size_t count) {
        std::uint32_t sum = 0;
        for (std::uint32_t& cursor : s_.cursors) sum = cursor += sum;
        for (std::size_t i = 0; i < count; ++i)
            s_.sorted[s_.cursors[s_.cells[i]]++] = {s_.x[i], s_.y[i], s_.z[i], s_.numbers[i]};
        for (std::size_t i = count; i < count + kMostLanes; ++i) s_.sorted[i] = {0, 0, 0, 0};
    }

    /// Particles of one cell.
    struct Visit {
        std::uint32_t first, last; ///< sorted particles
        CellList list;
        CellPlace cell;
        int winding; ///< of the centre
    };

    /// Cells with particles, several at a time as their faces fit the blocks.
    HWY_ATTR void test_cells() {
        constexpr std::size_t kMostFaces = kBlocks * kMostLanes;
        std::array<Visit, kMostFaces> visits;
        std::size_t visit_count = 0, face_count = 0;
        const auto flush = [&]() HWY_ATTR {
            prepare(face_count);
            std::size_t first = 0;
            for (std::size_t v = 0; v < visit_count; ++v) {
                test(visits[v], first);
                first += visits[v].list.last - visits[v].list.first;
            }
            visit_count = face_count = 0;
        };
        std::uint32_t begin = 0;
        for (std::uint32_t list = 0; list + 1 < s_.cursors.size(); ++list) {
            const std::uint32_t end = s_.cursors[list];
            if (begin == end) continue;
            const Visit visit = visit_of(begin, end);
            begin = end;
            const std::size_t faces = visit.list.last - visit.list.first;
            if (face_count + faces > kMostFaces || visit_count == visits.size()) flush();
            if (faces > kMostFaces) {
                for (std::uint32_t i = visit.first; i < visit.last; ++i) decide_exactly(visit, i);
                continue;
            }
            const auto centre = frame_.centre_of(visit.cell);
            for (std::uint32_t r = visit.list.first; r < visit.list.last; ++r, ++face_count) {
                s_.faces[face_count] = grid_.references[r];
                s_.centres[0][face_count] = centre.x;
                s_.centres[1][face_count] = centre.y;
                s_.centres[2][face_count] = centre.z;
            }
            visits[visit_count++] = visit;
        }
        flush();
    }

    HWY_ATTR Visit visit_of(std::uint32_t begin, std::uint32_t end) const {
        const CellPlace cell = cell_at(frame_.in_cells(points_[s_.sorted[begin].number]));
        const Brick& brick = grid_.brick(cell);
        const std::uint32_t in_brick = cell_in_brick(cell);
        const CellList list = list_of(grid_, brick, in_brick);
        return {begin, end, list, cell, winding_of_centre(grid_, list.number, state_of(brick, in_brick))};
    }

    HWY_ATTR void prepare(std::size_t face_count) {
        if (face_count == 0) return;
        const std::size_t n = hn::Lanes(Floats());
        const std::size_t padded = (face_count + n - 1) / n * n;
        for (std::size_t i = face_count; i < padded; ++i) {
            s_.faces[i] = s_.faces[face_count - 1];
            for (auto& c : s_.centres) c[i] = c[face_count - 1];
        }
        for (std::size_t i = 0; i < padded; i += n) prepare_lanes(i);
    }

    /// The functions of FaceBlock. With u = 2^-24, relative corners a, b exact and the edge w = b - a, each
    /// component of a x w is off by at most 4.1 u |a| |w| (longest components); so p . (a x w) by 31 u
    /// |a| |w| |p|, and n . p - n . a by 31 u |v| |w| (|p| + |a|), rounding of the sums included. Divided by
    /// twice that and more.
    HWY_ATTR void prepare_lanes(std::size_t first) {
        const Floats df;
        const Ints di;
        FaceBlock& block = s_.blocks[first / kMostLanes];
        const std::size_t lane = first % kMostLanes;
        const FaceGather gather(grid_);
        const auto corners =
            gather(hn::LoadU(di, reinterpret_cast<const std::int32_t*>(&s_.faces[first])),
                   hn::LoadU(di, &s_.centres[0][first]), hn::LoadU(di, &s_.centres[1][first]),
                   hn::LoadU(di, &s_.centres[2][first]));
        const auto &a = corners.a, &b = corners.b, &c = corners.c;
        const auto ab = sub(b, a), bc = sub(c, b), ca = sub(a, c);
        const auto normal = cross(ab, bc);
        const auto reach = hn::Set(df, static_cast<float>(frame_.cell_steps) * 0.5F + 2 * GridFrame::kSlack);
        const auto unit = hn::Set(df, 0x1p-18F); // 64 u
        const auto distance = dot(normal, a); // of the plane from the centre: how far the centre is behind it
        // A corner on the centre would make a bound 0.
        const auto least_bound = hn::Set(df, 0x1p-18F);
        const auto plane_bound =
            hn::Max(least_bound,
                    hn::Mul(unit, hn::Mul(hn::Mul(longest(ab), longest(bc)), hn::Add(reach, longest(a)))));
        // The centre is in front where the distance is negative; faces that it is not sure of are asked
        // exactly.
        auto front = hn::Lt(distance, hn::Zero(df));
        const auto unsure = hn::Not(hn::Gt(hn::Abs(distance), plane_bound));
        if (HWY_UNLIKELY(!hn::AllFalse(df, unsure))) front = front_exactly(first, unsure, front);
        // Crossed from the front: positive where p . (a x b) is negative and p behind the plane.
        const auto sign = hn::IfThenElse(front, hn::Set(df, -1.0F), hn::Set(df, 1.0F));
        const auto edge = [&](const auto& from, const auto& way, std::size_t k) HWY_ATTR {
            const auto bound =
                hn::Max(least_bound, hn::Mul(unit, hn::Mul(hn::Mul(longest(from), longest(way)), reach)));
            store(scaled(cross(from, way), hn::Div(sign, bound)), block, 3 * k, lane);
        };
        edge(a, ab, 0);
        edge(b, bc, 1);
        edge(c, ca, 2);
        const auto per_bound = hn::Div(sign, plane_bound);
        store(scaled(normal, per_bound), block, 9, lane);
        // A face with two equal corners is never crossed.
        const auto collapsed = hn::Or(hn::Or(is_zero(ab), is_zero(bc)), is_zero(ca));
        const auto offset =
            hn::IfThenElse(collapsed, hn::Set(df, -2.0F), hn::Neg(hn::Mul(distance, per_bound)));
        hn::Store(offset, df, &block.functions[12][lane]);
        if (HWY_UNLIKELY(!hn::AllFalse(df, collapsed)))
            for (std::size_t k = 0; k < 12; ++k)
                hn::Store(hn::IfThenZeroElse(collapsed, hn::Load(df, &block.functions[k][lane])), df,
                          &block.functions[k][lane]);
        hn::Store(hn::ConvertTo(di, hn::Neg(sign)), di, &block.crossings[lane]);
    }

    template <class V>
    HWY_ATTR void store(const V& v, FaceBlock& block, std::size_t function, std::size_t lane) const {
        const Floats df;
        hn::Store(v.x, df, &block.functions[function][lane]);
        hn::Store(v.y, df, &block.functions[function + 1][lane]);
        hn::Store(v.z, df, &block.functions[function + 2][lane]);
    }

    /// On which side of each unsure face the centre of its cell lies, by integers and the perturbation.
    template <class M>
    HWY_ATTR M front_exactly(std::size_t first, M unsure, M front) const {
        const Floats df;
        alignas(64) float is_unsure[kMostLanes], is_front[kMostLanes];
        const auto one = hn::Set(df, 1.0F);
        hn::Store(hn::IfThenElseZero(unsure, one), df, is_unsure);
        hn::Store(hn::IfThenElseZero(front, one), df, is_front);
        for (std::size_t i = 0; i < hn::Lanes(df); ++i)
            if (is_unsure[i] != 0)
                is_front[i] = is_in_front(grid_.face(s_.faces[first + i]),
                                          {s_.centres[0][first + i], s_.centres[1][first + i],
                                           s_.centres[2][first + i]})
                                  ? 1.0F
                                  : 0.0F;
        return hn::Gt(hn::Load(df, is_front), hn::Zero(df));
    }

    HWY_ATTR void test(const Visit& visit, std::size_t first_face) {
        const Floats df;
        const Ints di;
        const std::size_t n = hn::Lanes(df);
        const std::size_t face_count = visit.list.last - visit.list.first;
        for (std::uint32_t i = visit.first; i < visit.last; i += static_cast<std::uint32_t>(n)) {
            hn::VFromD<Floats> x, y, z, numbers;
            hn::LoadInterleaved4(df, &s_.sorted[i].x, x, y, z, numbers);
            auto winding = hn::Set(di, visit.winding);
            auto surest = hn::Set(df, 2.0F);
            for (std::size_t f = first_face; f < first_face + face_count; ++f) {
                const FaceBlock& block = s_.blocks[f / kMostLanes];
                const float* k = &block.functions[0][f % kMostLanes];
                const auto at = [&](std::size_t j) HWY_ATTR { return hn::Set(df, k[j * kMostLanes]); };
                const auto ab = hn::MulAdd(at(0), x, hn::MulAdd(at(1), y, hn::Mul(at(2), z)));
                const auto bc = hn::MulAdd(at(3), x, hn::MulAdd(at(4), y, hn::Mul(at(5), z)));
                const auto ca = hn::MulAdd(at(6), x, hn::MulAdd(at(7), y, hn::Mul(at(8), z)));
                const auto plane = hn::MulAdd(at(9), x, hn::MulAdd(at(10), y, hn::MulAdd(at(11), z, at(12))));
                const auto least = hn::Min(hn::Min(ab, bc), hn::Min(ca, plane));
                surest = hn::Min(surest, hn::Abs(least));
                const auto crossed = hn::RebindMask(di, hn::Gt(least, hn::Zero(df)));
                winding = hn::Add(winding,
                                  hn::IfThenElseZero(crossed, hn::Set(di, block.crossings[f % kMostLanes])));
            }
            alignas(64) std::int32_t windings[kMostLanes];
            hn::Store(winding, di, windings);
            const std::size_t valid = std::min<std::size_t>(n, visit.last - i);
            for (std::size_t lane = 0; lane < valid; ++lane)
                inside_[s_.sorted[i + lane].number] = windings[lane] != 0 ? 1 : 0;
            const auto unsure = hn::Le(surest, hn::Set(df, 1.0F));
            if (HWY_UNLIKELY(!hn::AllFalse(df, unsure))) decide_exactly(visit, i, unsure);
        }
    }

    template <class M>
    HWY_ATTR void decide_exactly(const Visit& visit, std::uint32_t first, M unsure) {
        const Floats df;
        alignas(64) float is_unsure[kMostLanes];
        hn::Store(hn::IfThenElseZero(unsure, hn::Set(df, 1.0F)), df, is_unsure);
        for (std::uint32_t lane = 0; lane < hn::Lanes(df) && first + lane < visit.last; ++lane)
            if (is_unsure[lane] != 0) decide_exactly(visit, first + lane);
    }

    HWY_ATTR void decide_exactly(const Visit& visit, std::uint32_t i) {
        const SortedParticle& p = s_.sorted[i];
        const LatticePoint centre(frame_.centre_of(visit.cell));
        const LatticePoint particle =
            centre + LatticePoint{static_cast<std::int64_t>(p.x), static_cast<std::int64_t>(p.y),
                                  static_cast<std::int64_t>(p.z)};
        inside_[p.number] = winding_in_cell(grid_, visit.list, visit.winding, centre, particle) != 0 ? 1 : 0;
    }

    const GridArrays& grid_;
    const GridFrame& frame_;
    SignScratch& s_;
    std::span<const Vec3f> points_;
    std::span<std::uint8_t> inside_;
};

HWY_ATTR void contains_chunk(const GridArrays& grid, SignScratch& scratch, std::span<const Vec3f> points,
                             std::span<std::uint8_t> inside) {
    SignKernel(grid, scratch).run(points, inside);
}

#endif

} // namespace echinus::baselines::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus::baselines {

HWY_EXPORT(contains_chunk);

void contains_kernel(const GridArrays& grid, std::span<const Vec3f> points_local,
                     std::span<std::uint8_t> inside) {
    SignScratch scratch(grid, std::min(kChunk, points_local.size()));
    for (std::size_t i = 0; i < points_local.size(); i += kChunk) {
        const std::size_t count = std::min(kChunk, points_local.size() - i);
        ECHINUS_DISPATCH(contains_chunk)
        (grid, scratch, points_local.subspan(i, count), inside.subspan(i, count));
    }
}

} // namespace echinus::baselines
#endif
