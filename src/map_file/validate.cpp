#include "map_file/validate.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>

namespace echinus {

namespace {

class Checker {
  public:
    explicit Checker(const std::string& name) : name_(name) {}

    [[noreturn]] void fail(const std::string& finding) const {
        throw Error(ErrorCode::Damaged, name_ + ": the map is damaged: " + finding + kBuildAgain);
    }

    void check_sample_count(std::string_view field, std::uint32_t count) const {
        constexpr std::uint32_t kMin = DistanceMapOptions::kMinSampleCount;
        constexpr std::uint32_t kMax = DistanceMapOptions::kMaxSampleCount;
        if (count >= kMin && count <= kMax) return;
        fail(std::string(field) + " is " + std::to_string(count) + " and not within " + std::to_string(kMin) +
             " to " + std::to_string(kMax));
    }

    template <typename Enum>
    void check_enumerator(std::string_view field, Enum value, Enum last) const {
        if (value > last) fail(std::string(field) + " has the unknown value " + std::to_string(int(value)));
    }

    void check_size(std::string_view array, std::size_t size, std::size_t expected) const {
        if (size == expected) return;
        fail(std::string(array) + " has " + std::to_string(size) + " elements and not " +
             std::to_string(expected));
    }

    void check_scalars(const DistanceMapView& map) const {
        if (!is_finite(map.centre)) fail("centre is not finite");
        if (!std::isfinite(map.radius) || !(map.radius > 0)) fail("radius is not a positive finite number");
        check_sample_count("longitude_count", map.longitude_count);
        check_sample_count("colatitude_count", map.colatitude_count);
        check_enumerator("pole_axis", map.pole_axis, PoleAxis::Z);
        check_enumerator("entry_format", map.entry_format, EntryFormat::Unorm16);
        check_enumerator("vertex_correction", map.correction, VertexCorrection::Signed);
    }

    void check_offsets(std::span<const std::uint32_t> offsets, std::size_t direction_count) const {
        check_size("entry_offsets", offsets.size(), direction_count + 1);
        if (offsets.front() != 0) fail("entry_offsets[0] is not 0");
        const auto descent = std::adjacent_find(offsets.begin(), offsets.end(), std::greater<>());
        if (descent == offsets.end()) return;
        fail("entry_offsets[" + std::to_string(descent - offsets.begin() + 1) +
             "] is smaller than the one before it");
    }

    /// The entries of a direction ascend within [0, max]. NaN does not.
    template <typename T>
    void check_entries(std::string_view array, std::span<const std::uint32_t> offsets,
                       std::span<const T> entries, T max) const {
        for (std::size_t direction = 0; direction + 1 < offsets.size(); ++direction) {
            T least = 0;
            for (std::size_t i = offsets[direction]; i < offsets[direction + 1]; ++i) {
                if (!(entries[i] >= least && entries[i] <= max)) {
                    fail(std::string(array) + "[" + std::to_string(i) + "] is " + std::to_string(entries[i]) +
                         " and not within " + std::to_string(least) + " to " + std::to_string(max));
                }
                least = entries[i];
            }
        }
    }

    void check_entries(const DistanceMapView& map) const {
        check_size("entries_float32", map.entries_float32.size(), is_float(map) ? map.entry_count() : 0);
        check_size("entries_unorm16", map.entries_unorm16.size(), is_float(map) ? 0 : map.entry_count());
        if (is_float(map)) {
            check_entries("entries_float32", map.entry_offsets, map.entries_float32, map.radius);
        } else {
            check_entries("entries_unorm16", map.entry_offsets, map.entries_unorm16, kMaxUnorm16);
        }
    }

    void check_statistics(const DistanceMapView& map, const DistanceMapStatistics& statistics) const {
        std::uint32_t max_entries = 0;
        for (std::size_t i = 0; i + 1 < map.entry_offsets.size(); ++i) {
            max_entries = std::max(max_entries, map.entry_offsets[i + 1] - map.entry_offsets[i]);
        }
        if (statistics.max_entries != max_entries) {
            fail("max_entries is " + std::to_string(statistics.max_entries) + " and not " +
                 std::to_string(max_entries));
        }
        if (!(statistics.wrong_parity_share >= 0 && statistics.wrong_parity_share <= 1)) {
            fail("wrong_parity_share is not within 0 to 1");
        }
    }

  private:
    static constexpr std::uint16_t kMaxUnorm16 = 65535;

    static bool is_float(const DistanceMapView& map) { return map.entry_format == EntryFormat::Float32; }

    const std::string& name_;
};

} // namespace

void validate(const DistanceMapView& map, const DistanceMapStatistics& statistics, const std::string& name) {
    const Checker checker(name);
    checker.check_scalars(map);
    checker.check_offsets(map.entry_offsets, map.direction_count());
    checker.check_entries(map);
    checker.check_statistics(map, statistics);
}

} // namespace echinus
