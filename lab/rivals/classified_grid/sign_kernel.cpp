// contains_batch() in vector instructions. First every particle gets the state of its cell, which settles all
// but those in cells on the surface. These are sorted by the length of their cells' lists, so that particles
// with lists of one length are lanes: lane by lane another cell and another face, none of them idle.

#include "rivals/classified_grid/layout.hpp"
#include "rivals/classified_grid/query.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rivals/classified_grid/sign_kernel.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "rivals/classified_grid/lookup-inl.hpp"
#include "simd/compress-inl.hpp"
#include "simd/dispatch.hpp"

#ifndef ECHINUS_CLASSIFIED_GRID_SIGN_KERNEL_ONCE
#define ECHINUS_CLASSIFIED_GRID_SIGN_KERNEL_ONCE
namespace echinus::rivals {

/// Particles that are looked at together: few enough that what is noted of them stays in the first cache.
constexpr std::size_t kChunk = 1024;
constexpr std::size_t kMaxLanes = 16;
constexpr std::size_t kLongest = 63; ///< lists of this length and more are sorted alike

/// A particle in a cell on the surface, from the cell's centre, in lattice steps: whole numbers.
struct alignas(16) PlaceInCell {
    float x, y, z;
    std::uint32_t first_reference; ///< of the cell's list
};

/// The rest of a particle's data.
struct alignas(16) CellOfParticle {
    std::int32_t x, y, z;       ///< the cell's centre
    std::uint32_t particle = 0; ///< number in the chunk | winding number of the centre << 16
};

struct SignScratch {
    static constexpr std::size_t kSize = kChunk + kMaxLanes;

    alignas(64) float x[kSize], y[kSize], z[kSize];
    alignas(64) std::int32_t centre_x[kSize], centre_y[kSize], centre_z[kSize];
    alignas(64) std::uint32_t particles[kSize], cells[kSize]; ///< cells: brick << 6 | cell in brick
    alignas(64) std::uint32_t first_references[kSize];
    std::uint32_t lengths[kSize];
    alignas(64) PlaceInCell places[kSize];
    alignas(64) CellOfParticle cells_of[kSize];
    std::int32_t sorted_lengths[kSize];
};

} // namespace echinus::rivals
#endif

HWY_BEFORE_NAMESPACE();
namespace echinus::rivals::HWY_NAMESPACE {

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
        take_from_centres(count);
        find_lists(count);
        sort(count);
        const Indices& references = grid_.references;
        for (std::size_t i = 0; i < count; i += hn::Lanes(Floats())) {
            if (references.wide.empty())
                test(references.narrow.data(), i, count);
            else
                test(references.wide.data(), i, count);
        }
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
        alignas(64) float padded[3 * kMaxLanes] = {};
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
                alignas(64) std::uint8_t answers[kMaxLanes];
                hn::StoreU(bytes, d8, answers);
                std::memcpy(&inside_[i], answers, left);
                on_surface = hn::And(on_surface, hn::RebindMask(di, hn::FirstN(df, left)));
            } else {
                hn::StoreU(bytes, d8, &inside_[i]);
            }
            if (hn::AllFalse(di, on_surface)) continue;
            const ::echinus::HWY_NAMESPACE::Compressor compress(on_surface);
            hn::StoreU(compress(x), df, &s_.x[count]);
            hn::StoreU(compress(y), df, &s_.y[count]);
            hn::StoreU(compress(z), df, &s_.z[count]);
            hn::StoreU(hn::BitCast(du, compress(found.cell)), du, &s_.cells[count]);
            const auto particles = compress(hn::Iota(di, static_cast<std::int32_t>(i)));
            hn::StoreU(hn::BitCast(du, particles), du, &s_.particles[count]);
            count += compress.count();
        }
        return count;
    }

    /// Snaps particles to the lattice and counts from the centres of their cells.
    HWY_ATTR void take_from_centres(std::size_t count) {
        const Floats df;
        const Ints di;
        const std::size_t n = hn::Lanes(df);
        const CellLookup lookup(grid_);
        for (std::size_t i = count; i < count + n; ++i) s_.x[i] = s_.y[i] = s_.z[i] = 0;
        for (std::size_t i = 0; i < count; i += n) {
            const auto found =
                lookup.from_centre(hn::Load(df, &s_.x[i]), hn::Load(df, &s_.y[i]), hn::Load(df, &s_.z[i]));
            hn::Store(found.place.x, df, &s_.x[i]);
            hn::Store(found.place.y, df, &s_.y[i]);
            hn::Store(found.place.z, df, &s_.z[i]);
            hn::Store(found.centre.x, di, &s_.centre_x[i]);
            hn::Store(found.centre.y, di, &s_.centre_y[i]);
            hn::Store(found.centre.z, di, &s_.centre_z[i]);
        }
    }

    HWY_ATTR void find_lists(std::size_t count) {
        begins_.fill(0);
        for (std::size_t i = 0; i < count; ++i) {
            const Brick& brick = grid_.bricks[s_.cells[i] >> 6];
            const std::uint32_t cell = s_.cells[i] & 63;
            const CellList list = list_of(grid_, brick, cell);
            const int winding = winding_of_centre(grid_, list.number, state_of(brick, cell));
            s_.particles[i] |= static_cast<std::uint32_t>(winding) << 16;
            s_.first_references[i] = list.first;
            s_.lengths[i] = list.last - list.first;
            ++begins_[place_of_length(s_.lengths[i]) + 1];
        }
    }

    /// Where lists of a length come in the order: the longest first.
    static std::size_t place_of_length(std::uint32_t length) {
        return kLongest - std::min<std::size_t>(length, kLongest);
    }

    HWY_ATTR void sort(std::size_t count) {
        for (std::size_t l = 0; l <= kLongest; ++l) begins_[l + 1] += begins_[l];
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t to = begins_[place_of_length(s_.lengths[i])]++;
            s_.places[to] = {s_.x[i], s_.y[i], s_.z[i], s_.first_references[i]};
            s_.cells_of[to] = {s_.centre_x[i], s_.centre_y[i], s_.centre_z[i], s_.particles[i]};
            s_.sorted_lengths[to] = static_cast<std::int32_t>(s_.lengths[i]);
        }
        for (std::size_t i = count; i < count + kMaxLanes; ++i) {
            s_.places[i] = {};
            s_.cells_of[i] = {};
            s_.sorted_lengths[i] = 0;
        }
    }

    /// Lanes of particles, from the i-th of the sorted on.
    template <class Index>
    HWY_ATTR void test(const Index* references, std::size_t i, std::size_t count) {
        const Floats df;
        const Ints di;
        const std::size_t n = hn::Lanes(df);
        hn::VFromD<Floats> x, y, z, first_bits;
        hn::LoadInterleaved4(df, &s_.places[i].x, x, y, z, first_bits);
        const FloatVectors p{x, y, z};
        hn::VFromD<Ints> centre_x, centre_y, centre_z, particle;
        hn::LoadInterleaved4(di, &s_.cells_of[i].x, centre_x, centre_y, centre_z, particle);
        const IntVectors centre{centre_x, centre_y, centre_z};
        const auto lengths = hn::LoadU(di, &s_.sorted_lengths[i]);
        const std::int32_t longest = *std::max_element(&s_.sorted_lengths[i], &s_.sorted_lengths[i] + n);
        auto winding = hn::ShiftRight<16>(particle);
        const FaceGather gather(grid_);
        for (std::int32_t k = 0; k < longest; ++k) {
            const auto is_active = hn::Gt(lengths, hn::Set(di, k));
            // Of lanes that are through, the first of all; without a branch.
            const auto face_of = [&](std::size_t lane) {
                const auto active = static_cast<std::uint32_t>(k < s_.sorted_lengths[i + lane]);
                const std::uint32_t number =
                    s_.places[i + lane].first_reference + static_cast<std::uint32_t>(k);
                return references[number & (0 - active)];
            };
            const Verdict verdict = cross_face(gather(face_of, centre), p);
            winding = hn::Add(winding, hn::IfThenElseZero(is_active, verdict.crossing));
            const auto unsure = hn::And(hn::RebindMask(di, verdict.unsure), is_active);
            if (HWY_UNLIKELY(!hn::AllFalse(di, unsure)))
                winding = hn::Add(winding, crossings_exactly(i, static_cast<std::uint32_t>(k), unsure));
        }
        alignas(64) std::int32_t windings[kMaxLanes];
        hn::Store(winding, di, windings);
        const std::size_t valid = std::min(n, count - i);
        for (std::size_t lane = 0; lane < valid; ++lane)
            inside_[s_.cells_of[i + lane].particle & 0xFFFF] = windings[lane] != 0 ? 1 : 0;
    }

    struct Verdict {
        hn::VFromD<Ints> crossing; ///< what it adds to the winding number; 0 where not sure
        hn::Mask<Floats> unsure;
    };

    /// Is a face between the particle p and the centre of its cell, which is the origin? p passes each edge
    /// (a, b) on the side of p . (a x b), and both ends lie on sides of the plane of normal n.
    ///
    /// With u = 2^-24, L the longest coordinate of a corner and r that of p, corners and edges are exact.
    /// Each component of a x (b - a) is off by at most 4.1 u L 2L, and its product with p by 31 u L 2L r; n .
    /// p and n . a by 31 u (2L)^2 (r + L), sums included. The bounds are twice that.
    HWY_ATTR HWY_INLINE Verdict cross_face(const FaceVectors& face, const FloatVectors& p) const {
        const Floats df;
        const Ints di;
        const auto &a = face.a, &b = face.b, &c = face.c;
        const auto ab = sub(b, a), bc = sub(c, b), ca = sub(a, c);
        const auto normal = cross(ab, bc);
        const auto from_centre = dot(normal, a); // how far the centre lies behind the plane
        const auto from_p = hn::Sub(from_centre, dot(normal, p));
        const auto past_ab = dot(cross(a, ab), p), past_bc = dot(cross(b, bc), p),
                   past_ca = dot(cross(c, ca), p);
        const auto least = hn::Min(hn::Min(past_ab, past_bc), past_ca);
        const auto most = hn::Max(hn::Max(past_ab, past_bc), past_ca);

        const auto extent = hn::Max(hn::Max(longest(a), longest(b)), longest(c));
        const auto reach = hn::Set(df, static_cast<float>(frame_.cell_steps) * 0.5F + 2 * GridFrame::kSlack);
        const auto area = hn::Mul(extent, extent);
        const auto edge_bound = hn::Mul(hn::Mul(area, reach), hn::Set(df, 0x1p-17F));
        const auto plane_bound = hn::Mul(hn::Mul(area, hn::Add(reach, extent)), hn::Set(df, 0x1p-16F));

        const auto behind = hn::Gt(from_centre, hn::Zero(df)); // the centre: the face is crossed from behind
        const auto p_behind = hn::Gt(from_p, hn::Zero(df));
        const auto sides_sure =
            hn::And(hn::Gt(hn::Abs(from_centre), plane_bound), hn::Gt(hn::Abs(from_p), plane_bound));
        const auto all_positive = hn::Gt(least, edge_bound);
        const auto all_negative = hn::Lt(most, hn::Neg(edge_bound));
        const auto mixed = hn::And(hn::Lt(least, hn::Neg(edge_bound)), hn::Gt(most, edge_bound));
        // Crossed from behind where all are positive, from the front where all are negative. A line that
        // leaves the plane on one side cannot pass the edges as if it came from the other.
        const auto same_side = hn::AndNot(hn::Xor(behind, p_behind), sides_sure);
        const auto parted = hn::And(hn::Xor(behind, p_behind), sides_sure);
        const auto hit = hn::And(parted, hn::Or(all_positive, all_negative));
        const auto missed = hn::Or(mixed, same_side);
        const auto crossing = hn::IfThenElse(behind, hn::Set(df, -1.0F), hn::Set(df, 1.0F));
        return {hn::ConvertTo(di, hn::IfThenElseZero(hit, crossing)), hn::Not(hn::Or(hit, missed))};
    }

    /// Decides unsure lanes by integers: the crossings with the k-th face of each list.
    template <class M>
    HWY_ATTR HWY_NOINLINE hn::VFromD<Ints> crossings_exactly(std::size_t i, std::uint32_t k, M unsure) const {
        const Ints di;
        alignas(64) std::int32_t lanes[kMaxLanes];
        hn::Store(hn::IfThenElseZero(unsure, hn::Set(di, 1)), di, lanes);
        for (std::size_t lane = 0; lane < hn::Lanes(di); ++lane) {
            if (lanes[lane] == 0) continue;
            const CellOfParticle& cell = s_.cells_of[i + lane];
            const PlaceInCell& place = s_.places[i + lane];
            const LatticePoint centre{cell.x, cell.y, cell.z};
            const LatticePoint offset{static_cast<std::int64_t>(place.x), static_cast<std::int64_t>(place.y),
                                      static_cast<std::int64_t>(place.z)};
            lanes[lane] =
                crossing_between(grid_, grid_.references[place.first_reference + k], centre, centre + offset);
        }
        return hn::Load(di, lanes);
    }

    const GridArrays& grid_;
    const GridFrame& frame_;
    SignScratch& s_;
    std::span<const Vec3f> points_;
    std::span<std::uint8_t> inside_;
    std::array<std::uint32_t, kLongest + 2> begins_; ///< of lists by length, while sorting
};

HWY_ATTR void contains_chunk(const GridArrays& grid, SignScratch& scratch, std::span<const Vec3f> points,
                             std::span<std::uint8_t> inside) {
    SignKernel(grid, scratch).run(points, inside);
}

#endif

} // namespace echinus::rivals::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus::rivals {

HWY_EXPORT(contains_chunk);

void contains_kernel(const GridArrays& grid, std::span<const Vec3f> points_local,
                     std::span<std::uint8_t> inside) {
    SignScratch scratch;
    for (std::size_t i = 0; i < points_local.size(); i += kChunk) {
        const std::size_t count = std::min(kChunk, points_local.size() - i);
        ECHINUS_DISPATCH(contains_chunk)
        (grid, scratch, points_local.subspan(i, count), inside.subspan(i, count));
    }
}

} // namespace echinus::rivals
#endif
