#include "rivals/maps/maps.hpp"

#include "rivals/common/closed_mesh.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace echinus::rivals {

namespace {

/// Both kinds of maps are asked in the same words.
template <typename Map>
class MapSystem final : public System {
  public:
    MapSystem(Map map, std::string name, std::string_view counted)
        : map_(std::move(map)), name_(std::move(name)), counted_(counted) {}

    std::string name() const override { return name_; }
    std::size_t byte_count() const override { return map_.view().byte_count(); }
    std::string_view counted() const override { return counted_; }
    void contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const override {
        echinus::contains_batch(map_.view(), points, inside);
    }
    using System::contacts_batch;
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const override {
        echinus::contacts_batch(map_.view(), points, margin, contacts);
    }
    bool contains(const Vec3f& point) const override { return echinus::contains(map_.view(), point); }
    Contact contact(const Vec3f& point, float margin) const override {
        return echinus::contact(map_.view(), point, margin);
    }

  private:
    Map map_;
    std::string name_;
    std::string_view counted_;
};

std::unique_ptr<const System> behind_interface(DistanceMap map) {
    constexpr const char* kNames[] = {"distance", "octahedral distance", "cube distance",
                                      "ellipsoidal distance"};
    const char* name = kNames[static_cast<std::size_t>(map.view().grid)];
    return std::make_unique<MapSystem<DistanceMap>>(std::move(map), name,
                                                    "offsets and entries of directions");
}

/// A resolution is one number: longitudes and colatitudes, or divisions.
struct Resolutions {
    std::uint32_t least, most;
    DistanceMapOptions options;

    explicit Resolutions(const DistanceMapOptions& wanted) : options(wanted) {
        const bool by_counts = has_poles(options.grid);
        least = by_counts ? DistanceMapOptions::kMinSampleCount : DistanceMapOptions::kMinDivisions;
        most = by_counts ? DistanceMapOptions::kMaxSampleCount : DistanceMapOptions::kMaxDivisions;
    }
    DistanceMapOptions with(std::uint32_t resolution) const {
        DistanceMapOptions result = options;
        result.longitude_count = result.colatitude_count = result.divisions = resolution;
        return result;
    }
    std::size_t bytes(const TriangleMesh& mesh, std::uint32_t resolution) const {
        const DistanceMap map = DistanceMap::build(mesh, with(resolution));
        return map.view().byte_count();
    }
};

} // namespace

std::unique_ptr<const System> exact_map(const TriangleMesh& mesh, const ExactMapOptions& options) {
    require_closed(mesh, "a comparison");
    return std::make_unique<MapSystem<ExactMap>>(ExactMap::build(mesh, options), "exact",
                                                 "bands, lists of faces, vertices, faces and tree");
}

std::unique_ptr<const System> distance_map(const TriangleMesh& mesh, const DistanceMapOptions& options) {
    require_closed(mesh, "a comparison");
    return behind_interface(DistanceMap::build(mesh, options));
}

/// Bytes grow nearly as the square of the resolution, so a map of any resolution predicts the next to
/// try; bisection decides where it does not.
DistanceMapOptions finest_within(const TriangleMesh& mesh, std::size_t byte_budget,
                                 const DistanceMapOptions& options) {
    require_closed(mesh, "a comparison");
    Resolutions resolutions(options);
    std::uint32_t fits = resolutions.least, too_fine = resolutions.most + 1;
    std::size_t bytes = resolutions.bytes(mesh, fits), most_bytes = bytes;
    if (bytes > byte_budget)
        throw Error(ErrorCode::InvalidOptions, "the coarsest distance map takes " + std::to_string(bytes) +
                                                   " bytes; the budget is " + std::to_string(byte_budget));
    const auto wanted = static_cast<double>(byte_budget);
    double resolution = resolutions.least;
    for (int builds = 0; builds < 12 && too_fine - fits > 1; ++builds) {
        if (static_cast<double>(most_bytes) > 0.99 * wanted) break;
        const double predicted = resolution * std::sqrt(wanted / static_cast<double>(bytes) * 0.998);
        const double middle = (fits + 1.0 * too_fine) / 2;
        // The prediction alone in the first builds, since the middle of all resolutions is a huge map.
        const double next = builds < 6 ? predicted : std::min(predicted, middle);
        resolution = std::clamp(std::floor(next), fits + 1.0, too_fine - 1.0);
        bytes = resolutions.bytes(mesh, static_cast<std::uint32_t>(resolution));
        if (bytes > byte_budget) {
            too_fine = static_cast<std::uint32_t>(resolution);
        } else {
            fits = static_cast<std::uint32_t>(resolution);
            most_bytes = bytes;
        }
    }
    return resolutions.with(fits);
}

} // namespace echinus::rivals
