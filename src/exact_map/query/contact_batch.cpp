// Three passes: the sides of all particles; the nearest faces of those that need one, in an order that keeps
// neighbours together if there are many; and the contacts with these faces.

#include "exact_map/query/contact_search.hpp"
#include "exact_map/query/nearest.hpp"
#include "geometry/arena.hpp"
#include "geometry/scratch.hpp"
#include "geometry/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "exact_map/query/contact_batch.cpp"
#include <hwy/foreach_target.h>

// Must follow foreach_target.h, which includes this file once per instruction set.
#include "geometry/whole_numbers.hpp"
#include "simd/dispatch.hpp"
#include "simd/lanes-inl.hpp"

#include <hwy/cache_control.h>
#include <hwy/highway.h>

namespace echinus {
#ifndef ECHINUS_CONTACT_BLOCK
#define ECHINUS_CONTACT_BLOCK
namespace {

/// A block of particles that need contacts.
struct ContactBlock {
    static constexpr std::size_t kCapacity = 256;

    std::size_t size = 0;
    RawArray<std::uint32_t, kCapacity> particles;
    RawArray<Vec3f, kCapacity> points_local;
    RawArray<Side, kCapacity> sides;
    RawArray<NearestSearch, kCapacity> searches;
    RawArray<std::uint32_t, kCapacity> faces;
    RawArray<Contact, kCapacity> contacts;

    void add(const ContactSearch& search, std::uint32_t particle, const Vec3f& point_local, Side side) {
        particles[size] = particle;
        points_local[size] = point_local;
        sides[size] = side;
        searches[size] = {search.place_of(point_local), search.farthest(side)};
        ++size;
    }

    /// The contact of a particle whose nearest face is known, by the scalar code.
    void set_contact(const ContactSearch& search, std::size_t i) {
        contacts[i] = search.contact_at(
            points_local[i], sides[i],
            nearest_point_on_face(search.map(), faces[i], searches[i].place, search.stretch()));
    }
};

} // namespace
#endif
} // namespace echinus

HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

namespace {

using Doubles = hn::ScalableTag<double>;
using DoubleLanes = hn::Vec<Doubles>;
using DoubleMask = hn::Mask<Doubles>;
constexpr std::size_t kMaxLanes = 8;

using PlaceLanes = Vec3Lanes<DoubleLanes>;

PlaceLanes same(const Vec3d& v) {
    constexpr Doubles d;
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

/// ContactSearch::contact_at() of several particles at once.
class ContactLanes {
  public:
    explicit ContactLanes(const ContactSearch& search)
        : search_(search), map_(search.map()), stretch_(same(search.stretch())),
          centre_(same(search.frame().centre)), step_(hn::Set(Doubles(), search.frame().step)) {}

    void measure(ContactBlock& block) {
        for (std::size_t first = 0; first < block.size; first += hn::Lanes(Doubles())) {
            const std::size_t count = std::min(hn::Lanes(Doubles()), block.size - first);
            load(block, first, count);
            measure_loaded();
            for (std::size_t lane = 0; lane < count; ++lane) store(block, first + lane, lane);
        }
    }

  private:
    static constexpr double kFarthestInLanes = 0x1p40;

    using Row = std::array<double, kMaxLanes>;
    struct Rows {
        alignas(64) Row x, y, z;

        PlaceLanes lanes() const {
            constexpr Doubles d;
            return {hn::Load(d, x.data()), hn::Load(d, y.data()), hn::Load(d, z.data())};
        }
        void set(const PlaceLanes& v) {
            constexpr Doubles d;
            hn::Store(v.x, d, x.data());
            hn::Store(v.y, d, y.data());
            hn::Store(v.z, d, z.data());
        }
        void set(std::size_t lane, const Vec3d& v) {
            x[lane] = v.x;
            y[lane] = v.y;
            z[lane] = v.z;
        }
        Vec3f operator[](std::size_t lane) const {
            return {static_cast<float>(x[lane]), static_cast<float>(y[lane]), static_cast<float>(z[lane])};
        }
    };

    void load(const ContactBlock& block, std::size_t first, std::size_t count) {
        for (std::size_t lane = 0; lane < count; ++lane) {
            const std::size_t i = first + lane;
            const std::size_t face = block.faces[i] == kNoFace ? 0 : block.faces[i];
            for (std::size_t k = 0; k < 3; ++k)
                corners_[k].set(lane, Vec3d(map_.vertices[map_.corners[3 * face + k]]));
            places_.set(lane, block.searches[i].place);
            signs_[lane] = (block.sides[i] & kInsideBit) != 0 ? 1 : -1;
        }
    }

    /// The point of a segment that is nearest to the origin, as a fraction of the segment.
    static DoubleLanes nearest_share(const PlaceLanes& start, const PlaceLanes& edge) {
        constexpr Doubles d;
        const DoubleLanes zero = hn::Zero(d), one = hn::Set(d, 1), length_sq = dot(edge, edge);
        const DoubleLanes share = hn::Div(hn::Neg(dot(start, edge)), length_sq);
        const DoubleLanes clamped =
            hn::IfThenElse(hn::Lt(share, zero), zero, hn::IfThenElse(hn::Gt(share, one), one, share));
        return hn::IfThenElseZero(hn::Gt(length_sq, zero), clamped);
    }

    void measure_loaded() {
        constexpr Doubles d;
        const PlaceLanes place = places_.lanes();
        const auto around_place = [&](const Rows& corner) { return times(corner.lanes() - place, stretch_); };
        const std::array<PlaceLanes, 3> corners{around_place(corners_[0]), around_place(corners_[1]),
                                                around_place(corners_[2])};
        const PlaceLanes normal = cross(corners[1] - corners[0], corners[2] - corners[1]);
        const DoubleLanes zero = hn::Zero(d), one = hn::Set(d, 1);
        PlaceLanes nearest{zero, zero, zero};
        DoubleLanes nearest_sq = hn::Set(d, std::numeric_limits<double>::infinity());
        DoubleMask above = hn::Eq(zero, zero), on_edge = hn::Ne(zero, zero);
        for (std::size_t k = 0; k < 3; ++k) {
            const PlaceLanes& start = corners[k];
            const PlaceLanes edge = corners[(k + 1) % 3] - start;
            above = hn::And(above, hn::Gt(dot(cross(normal, start), edge), zero));
            const DoubleLanes share = nearest_share(start, edge);
            const PlaceLanes candidate = start + edge * share;
            const DoubleLanes distance_sq = dot(candidate, candidate);
            const DoubleMask nearer = hn::Lt(distance_sq, nearest_sq);
            nearest_sq = hn::IfThenElse(nearer, distance_sq, nearest_sq);
            nearest = choose(nearer, candidate, nearest);
            const DoubleMask within = hn::And(hn::Gt(share, zero), hn::Lt(share, one));
            on_edge = hn::Or(hn::And(nearer, within), hn::AndNot(nearer, on_edge));
        }
        const PlaceLanes on_plane = normal * hn::Div(dot(corners[0], normal), dot(normal, normal));
        nearest = choose(above, on_plane, nearest);
        hn::Store(hn::IfThenElse(above, hn::Set(d, double(Feature::Face)),
                                 hn::IfThenElse(on_edge, hn::Set(d, double(Feature::Edge)),
                                                hn::Set(d, double(Feature::Vertex)))),
                  d, features_.data());
        const DoubleLanes distance = length(nearest);

        const PlaceLanes point =
            place + PlaceLanes{hn::Div(nearest.x, stretch_.x), hn::Div(nearest.y, stretch_.y),
                               hn::Div(nearest.z, stretch_.z)};
        points_.set(centre_ + point * step_);
        const DoubleLanes sign = hn::Load(d, signs_.data());
        const DoubleLanes depth = hn::Mul(hn::Mul(distance, hn::Set(d, search_.unit())), step_);
        hn::Store(hn::Mul(depth, sign), d, depths_.data());
        const PlaceLanes offset = point - place;
        const DoubleMask by_reference = hn::Or(hn::Le(length(offset), hn::Set(d, kSnapping)),
                                               hn::Gt(distance, hn::Set(d, kFarthestInLanes)));
        hn::Store(hn::IfThenElseZero(by_reference, one), d, by_reference_.data());
        normals_.set(times(offset, stretch_) * hn::Div(sign, distance));
    }

    void store(ContactBlock& block, std::size_t i, std::size_t lane) const {
        if (block.faces[i] == kNoFace) return;
        if (by_reference_[lane] != 0) [[unlikely]] {
            block.set_contact(search_, i);
            return;
        }
        Contact& contact = block.contacts[i];
        contact.point = points_[lane];
        contact.normal = normals_[lane];
        contact.depth = static_cast<float>(depths_[lane]);
        contact.face = map_.face_numbers[block.faces[i]];
        contact.inside = (block.sides[i] & kInsideBit) != 0;
        contact.certain = (block.sides[i] & kUncertainBit) == 0;
        contact.feature = static_cast<Feature>(static_cast<int>(features_[lane]));
    }

    const ContactSearch& search_;
    const ExactMapView& map_;
    PlaceLanes stretch_, centre_;
    DoubleLanes step_;

    // The current particles.
    std::array<Rows, 3> corners_{};
    Rows places_{}, points_{}, normals_{};
    alignas(64) Row signs_{}, depths_{}, features_{};
    alignas(64) Row by_reference_{}; ///< near the surface the normal is a sum over faces, and far away double
                                     ///< is not precise enough
};

} // namespace

void measure_contacts(const ContactSearch& search, ContactBlock& block) {
    ContactLanes(search).measure(block);
}

#else

void measure_contacts(const ContactSearch& search, ContactBlock& block) {
    for (std::size_t i = 0; i < block.size; ++i)
        if (block.faces[i] != kNoFace) block.set_contact(search, i);
}

#endif

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(measure_contacts);

/// Where contacts_batch() writes its answers.
struct ContactOutput {
    /// The number of particles sorted at a time: few enough for the written data to stay in a cache, and
    /// enough for neighbours to be close to each other.
    static constexpr std::size_t kQueueCapacity = 1 << 16;

    std::span<Contact> contacts;

    std::size_t size() const { return contacts.size(); }
    void prefetch(std::uint32_t particle) const {
        hwy::Prefetch(&contacts[particle]);
        hwy::Prefetch(&contacts[particle].feature); // may be on the next cache line
    }
    void set(std::uint32_t particle, const Contact& contact) const { contacts[particle] = contact; }
    void set_none(std::uint32_t particle, const Vec3f& point_local, Side side) const {
        ContactSearch::set_no_contact(contacts[particle], point_local, side);
    }
};

/// Where signed_distance_batch() writes its answers.
struct SignedDistanceOutput {
    static constexpr std::size_t kQueueCapacity = 1 << 18; // a number takes less cache than a contact

    std::span<float> distances;
    std::span<Vec3f> gradients; ///< may be empty

    std::size_t size() const { return distances.size(); }
    void prefetch(std::uint32_t particle) const {
        hwy::Prefetch(&distances[particle]);
        if (!gradients.empty()) hwy::Prefetch(&gradients[particle]);
    }
    void set(std::uint32_t particle, const Contact& contact) const {
        distances[particle] = -contact.depth;
        if (!gradients.empty()) gradients[particle] = contact.normal;
    }
    void set_none(std::uint32_t particle, const Vec3f& point_local, Side) const {
        distances[particle] = signed_distance_without_contact(point_local);
        if (!gradients.empty()) gradients[particle] = {};
    }
};

template <typename Output>
void answer(const ContactSearch& search, ContactBlock& block, const Output& output) {
    const std::span<const NearestSearch> searches(block.searches.data(), block.size);
    find_nearest_faces(search.map(), search.stretch(), searches, {block.faces.data(), block.size});
    ECHINUS_DISPATCH(measure_contacts)(search, block);
    for (std::size_t i = 0; i < block.size; ++i) {
        if (block.faces[i] != kNoFace)
            output.set(block.particles[i], block.contacts[i]);
        else
            output.set_none(block.particles[i], block.points_local[i], block.sides[i]);
    }
    block.size = 0;
}

/// Fewer particles are not sorted, since that takes longer than it saves: they are searched one by one,
/// unless they come in an order that keeps neighbours together.
constexpr std::size_t kFewestSorted = 512;

/// Memory for a batch.
struct ContactMemory {
    std::span<Side> sides;                 ///< one for each particle of the batch
    std::span<KeyedParticle> queue, spare; ///< of equal length: the number of particles sorted at a time
};

template <typename Output>
void find_with(const ContactSearch& search, const StridedSpan<const Vec3f>& points_local,
               const Output& output, const ContactMemory& memory) {
    const std::span<Side> sides = memory.sides;
    find_sides(search.map(), points_local, sides);
    const MortonCurve curve(search.map().centre, search.map().radius);
    OnScratch<std::array<ContactBlock, 2>>
        block_memory; // for places near the lattice and afar, which are searched differently
    std::array<ContactBlock, 2>& blocks = *block_memory;
    std::size_t queued = 0;
    const auto answer_queue = [&] {
        const std::span<KeyedParticle> queue = memory.queue.first(queued);
        if (queued >= kFewestSorted) sort_by_key(queue, memory.spare.first(queued));
        for (std::size_t k = 0; k < queue.size(); ++k) {
            // Neighbours in space are not neighbours in memory, so data that is used soon is prefetched now.
            constexpr std::size_t kAhead = 16;
            const std::uint32_t later = queue[std::min(k + kAhead, queue.size() - 1)].particle;
            hwy::Prefetch(&points_local[later]);
            hwy::Prefetch(&sides[later]);
            const std::uint32_t particle = queue[k].particle;
            output.prefetch(particle);
            const Vec3f& point_local = points_local[particle];
            ContactBlock& block = blocks[is_afar(search.place_of(point_local)) ? 1 : 0];
            block.add(search, particle, point_local, sides[particle]);
            if (block.size == ContactBlock::kCapacity) answer(search, block, output);
        }
        for (ContactBlock& block : blocks) answer(search, block, output);
        queued = 0;
    };
    const auto count = kept_as<std::uint32_t>(output.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        if (!search.is_wanted(points_local[i], sides[i])) {
            output.set_none(i, points_local[i], sides[i]);
            continue;
        }
        memory.queue[queued++] = {curve.key(points_local[i]), i};
        if (queued == memory.queue.size()) answer_queue();
    }
    answer_queue();
}

template <typename Output>
void find_with(const ContactSearch& search, const StridedSpan<const Vec3f>& points_local,
               const Output& output) {
    // A solver queries few particles at a time, but many times.
    constexpr std::size_t kStackCapacity = 256;
    if (output.size() <= kStackCapacity) {
        std::array<Side, kStackCapacity> sides;
        std::array<KeyedParticle, kStackCapacity> queue, spare;
        find_with(search, points_local, output, {{sides.data(), output.size()}, queue, spare});
        return;
    }
    const std::size_t count = std::min(Output::kQueueCapacity, output.size());
    // std::make_unique would initialise the elements.
    const std::unique_ptr<Side[]> sides(new Side[output.size()]);
    const std::unique_ptr<KeyedParticle[]> queue(new KeyedParticle[2 * count]);
    find_with(search, points_local, output,
              {{sides.get(), output.size()}, {queue.get(), count}, {queue.get() + count, count}});
}

} // namespace

void find_contacts(const ContactSearch& search, const StridedSpan<const Vec3f>& points_local,
                   std::span<Contact> contacts) {
    find_with(search, points_local, ContactOutput{contacts});
}

void find_signed_distances(const ContactSearch& search, const StridedSpan<const Vec3f>& points_local,
                           std::span<float> distances, std::span<Vec3f> gradients) {
    find_with(search, points_local, SignedDistanceOutput{distances, gradients});
}

} // namespace echinus
#endif
