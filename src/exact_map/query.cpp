// Inside or outside, exactly. This scalar code is the specification.

#include "exact_map/border.hpp"
#include "exact_map/layout.hpp"
#include "exact_map/nearest.hpp"
#include "exact_map/ray_crossing.hpp"

#include <cassert>
#include <cmath>

namespace echinus {

namespace {

/// A particle on the lattice. One that is not finite or lies beyond the mesh's lattice stands at the
/// lattice's corner: that is outside.
LatticePoint snapped(const LatticeFrame& frame, const Vec3f& point_local) {
    constexpr auto kExtent = static_cast<double>(kLatticeExtent);
    constexpr double kLimit = kExtent + 0.5; // what is rounded into the lattice lies in it
    const Vec3d place = frame.to_lattice(point_local);
    const bool on_lattice =
        (std::fabs(place.x) <= kLimit) & (std::fabs(place.y) <= kLimit) & (std::fabs(place.z) <= kLimit);
    return rounded(on_lattice ? place : Vec3d{kExtent, kExtent, kExtent});
}

/// The lists of a map with the width of their numbers known.
template <typename Face, typename Vertex>
struct Lists {
    const ExactMapView& map;
    const Face* references;
    const Vertex* corners;

    const std::int32_t* corner(std::uint32_t face, std::size_t k) const {
        return &map.vertices[corners[3 * std::size_t{face} + k]].x;
    }

    /// Signed crossings of a particle's ray with references [first, last), on one side of the particle.
    /// @param part  of its cell in which the particle lies
    int crossings(RaySide side, std::uint32_t first, std::uint32_t last, std::uint32_t part,
                  const LatticePoint& p) const {
        const CrossingFilter filter(p);
        constexpr std::uint32_t kPieceSize = 64;
        std::array<Face, kPieceSize> faces;
        int sum = 0;
        for (std::uint32_t begin = first; begin < last; begin += kPieceSize) {
            const std::uint32_t end = std::min(begin + kPieceSize, last);
            std::uint32_t count = 0; // of the faces that touch the part; listed without a branch
            for (std::uint32_t r = begin; r < end; ++r) {
                faces[count] = references[r];
                count += std::uint32_t{map.reference_parts[r]} >> part & 1U;
            }
            for (std::uint32_t i = 0; i < count; ++i) {
                const std::uint32_t face = faces[i];
                const auto [crossing, sure] = filter(side, corner(face, 0), corner(face, 1), corner(face, 2));
                sum += sure ? crossing : crossing_on(side, face_corners(map, face), p);
            }
        }
        return sum;
    }
};

/// Clang deduces the parameters of an aggregate only if told how.
template <typename Face, typename Vertex>
Lists(const ExactMapView&, const Face*, const Vertex*) -> Lists<Face, Vertex>;

int crossings_in_band(const ExactMapView& map, RaySide side, std::uint32_t band, std::uint32_t part,
                      const LatticePoint& p) {
    const auto crossings = [&](const auto& lists) {
        return lists.crossings(side, map.bands[band].first_reference, map.bands[band + 1].first_reference,
                               part, p);
    };
    const auto with_corners = [&](const auto* references) {
        return map.corners.wide.empty() ? crossings(Lists{map, references, map.corners.narrow.data()})
                                        : crossings(Lists{map, references, map.corners.wide.data()});
    };
    return map.references.wide.empty() ? with_corners(map.references.narrow.data())
                                       : with_corners(map.references.wide.data());
}

/// The generalised winding number, rounded: in the open, where no gap's number is known.
std::int64_t generalised_winding(const ExactMapView& map, std::uint32_t innermost_band,
                                 const BandRange& bands, std::uint32_t part, const LatticePoint& p) {
    int crossings = 0;
    for (std::uint32_t band = innermost_band; band < bands.last; ++band)
        crossings += crossings_in_band(map, RaySide::Beyond, band, part, p);
    return std::lrint(crossings + border_part(map.border, map.vertices, p));
}

Containment containment(const ExactMapView& map, const LatticePoint& p) {
    const auto [cell, part] = OctahedralCells(map.divisions).locate(p);
    const BandRange bands = bands_of_cell(map, cell);
    const std::int64_t t = band_unit_of(l1_norm(p));
    std::uint32_t band = bands.first;
    while (band < bands.last && t >= map.bands[band].upper) ++band;
    if (band == bands.last) return {};
    const bool in_gap = t < map.bands[band].lower;
    int winding = in_gap ? map.winding_below[band] : winding_beyond(map, band, bands);
    if (winding == ExactMapView::kUncertain)
        return {is_inside(map.rule, generalised_winding(map, band, bands, part, p)), false};
    if (winding == ExactMapView::kSplit)
        winding = map.winding_below[band] - crossings_in_band(map, RaySide::Before, band, part, p);
    else if (!in_gap)
        winding += crossings_in_band(map, RaySide::Beyond, band, part, p);
    return {is_inside(map.rule, winding), true};
}

Containment containment(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local) {
    return containment(map, snapped(frame, point_local));
}

/// In lattice steps: the diameter of the lattice and more.
constexpr double kEverything = 4 * static_cast<double>(kLatticeExtent);

/// Two snapped positions differ from the true ones by at most sqrt(3) lattice steps together.
constexpr double kSnapping = 2;

/// Contacts in a stretched world. The stretch is taken apart into one number, which is the unit of lengths,
/// and what is left for the axes, at most 1.
class ContactSearch {
  public:
    ContactSearch(const ExactMapView& map, const Vec3d& stretch, float margin)
        : map_(map), frame_(frame_of(map)),
          unit_(std::max({std::fabs(stretch.x), std::fabs(stretch.y), std::fabs(stretch.z)})),
          stretch_(stretch * (1 / unit_)), margin_(margin > 0 ? margin / (unit_ * frame_.step) : 0) {}

    Contact operator()(const Vec3f& point_local) const {
        Contact result;
        result.point = point_local;
        if (!is_finite(point_local)) return result;
        const Containment found = containment(map_, frame_, point_local);
        result.certain = found.certain;
        if (!found.inside && margin_ == 0) return result;
        const Vec3d place = frame_.to_lattice(point_local);
        const auto nearest = nearest_point(map_, place, stretch_, found.inside ? kEverything : margin_);
        if (!nearest) return result;
        result.inside = found.inside;
        result.point = Vec3f(frame_.to_local(nearest->point));
        const double distance = nearest->distance * unit_ * frame_.step;
        result.depth = static_cast<float>(found.inside ? distance : -distance);
        result.normal = outward_normal(*nearest, place, found.inside);
        result.face = static_cast<std::int32_t>(map_.face_numbers[nearest->face]);
        result.feature = nearest->feature;
        return result;
    }

  private:
    Vec3f outward_normal(const NearestPoint& nearest, const Vec3d& place, bool inside) const {
        if (nearest.distance <= kSnapping) return pseudonormal(map_, nearest.point, stretch_, kSnapping);
        const Vec3d offset = nearest.point - place;
        const Vec3d in_world{offset.x * stretch_.x, offset.y * stretch_.y, offset.z * stretch_.z};
        return Vec3f(in_world * ((inside ? 1 : -1) / nearest.distance));
    }

    const ExactMapView& map_;
    LatticeFrame frame_;
    double unit_;
    Vec3d stretch_;
    double margin_; ///< in lattice steps
};

} // namespace

bool contains(const ExactMapView& map, Vec3f point_local) noexcept {
    return classify(map, point_local).inside;
}

Containment classify(const ExactMapView& map, Vec3f point_local) noexcept {
    return containment(map, frame_of(map), point_local);
}

Contact contact(const ExactMapView& map, Vec3f point_local, float margin, const Vec3d& stretch) noexcept {
    return ContactSearch(map, stretch, margin)(point_local);
}

void contains_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                    std::span<std::uint8_t> inside) noexcept {
    assert(points_local.size() == inside.size());
    const LatticeFrame frame = frame_of(map);
    for (std::size_t i = 0; i < inside.size(); ++i)
        inside[i] = containment(map, frame, points_local[i]).inside ? 1 : 0;
}

void contacts_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local, float margin,
                    std::span<Contact> contacts, const Vec3d& stretch) noexcept {
    assert(points_local.size() == contacts.size());
    const ContactSearch search(map, stretch, margin);
    for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i] = search(points_local[i]);
}

} // namespace echinus
