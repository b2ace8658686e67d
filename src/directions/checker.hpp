#pragma once

#include <echinus/error.hpp>
#include <echinus/version.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace echinus {

/// The remedy with which every message about an invalid map file ends.
inline constexpr const char* kBuildAgain = "; build the map again with echinus build";

/// Checks of a map's numbers that every kind of map needs. Both the reader of files and the end of a build
/// use them: a map that could not be read back is never returned. A failure throws an Error Damaged whose
/// message names the field, or the array and the index.
class Checker {
  public:
    /// For a map from untrusted bytes. @param name  the name of the file, with which messages begin
    explicit Checker(const std::string& name) : name_(&name) {}
    explicit Checker(std::string&&) = delete;
    /// For a map that was just built, in which a fault is the library's own.
    static Checker of_build() { return {}; }

    [[noreturn]] void fail(const std::string& finding) const {
        if (name_ == nullptr)
            throw Error(ErrorCode::Damaged,
                        "a map was built that contradicts itself: " + finding +
                            "; this is a bug in Echinus " + version() +
                            " and not a fault of the mesh: please report it with the mesh and the options");
        throw Error(ErrorCode::Damaged, *name_ + ": the map is damaged: " + finding + kBuildAgain);
    }

    [[noreturn]] void fail(std::string_view array, std::size_t index, const std::string& finding) const {
        fail(std::string(array) + "[" + std::to_string(index) + "] " + finding);
    }

    /// Checks that min <= value <= max; NaN fails.
    template <typename T>
    void check_range(std::string_view field, T value, T min, T max) const {
        if (value >= min && value <= max) return;
        fail(std::string(field) + " is " + std::to_string(value) + " and not within " + std::to_string(min) +
             " to " + std::to_string(max));
    }

    void check_equal(std::string_view field, std::size_t value, std::size_t expected) const {
        if (value == expected) return;
        fail(std::string(field) + " is " + std::to_string(value) + " and not " + std::to_string(expected));
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

    /// Checks the offsets at which the pieces of an array begin: [piece_count + 1] numbers that start at 0
    /// and do not descend.
    void check_offsets(std::string_view array, std::span<const std::uint32_t> offsets,
                       std::size_t piece_count) const {
        check_size(array, offsets.size(), piece_count + 1);
        if (offsets.front() != 0) fail(array, 0, "is not 0");
        const auto descent = std::adjacent_find(offsets.begin(), offsets.end(), std::greater<>());
        if (descent == offsets.end()) return;
        fail(array, static_cast<std::size_t>(descent - offsets.begin()) + 1,
             "is smaller than the one before it");
    }

  private:
    Checker() = default;

    const std::string* name_ = nullptr;
};

} // namespace echinus
