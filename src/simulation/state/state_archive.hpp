#pragma once

#include "simulation/particles.hpp"

#include <echinus/error.hpp>
#include <echinus/geometry.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace echinus {

/// Types without padding, of which every bit pattern is a value.
template <typename T>
inline constexpr bool kIsPlain = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;
template <typename T>
inline constexpr bool kIsPlain<Vec3<T>> = kIsPlain<T> && sizeof(Vec3<T>) == 3 * sizeof(T);
template <typename T, std::size_t n>
inline constexpr bool kIsPlain<std::array<T, n>> = kIsPlain<T>;

/// Writes the state of a simulation, or reads it. Each class has one function, archive(), that goes through
/// its part of the state in both cases, so that reading and writing cannot differ.
///
/// The bytes that are read may be anything: a function that reads checks everything that could lead to an
/// access outside an array. NaN and, in some cases, infinity are rejected.
class StateArchive {
  public:
    /// An archive that writes.
    StateArchive() = default;
    /// An archive that reads. @param name  of the source; begins the errors
    StateArchive(std::span<const std::byte> bytes, std::string name)
        : reads_(true), left_(bytes), name_(std::move(name)) {}

    bool reads() const { return reads_; }
    std::vector<std::byte>& written() { return written_; }

    /// @throws Error Damaged
    void require(bool holds) const {
        if (holds || !reads_) return;
        throw Error(ErrorCode::Damaged, name_ + " contradicts itself; save the simulation again");
    }
    /// To be called after the last value was read.
    void finish() const { require(left_.empty()); }

    template <typename T>
    void value(T& v) {
        static_assert(kIsPlain<T>);
        transfer(&v, 1);
        require(is_number(v));
    }
    void flag(bool& v) {
        auto as_byte = static_cast<std::uint8_t>(v);
        choice(as_byte, std::uint8_t{1});
        v = as_byte != 0;
    }
    /// An enumerator, or a number. @param last  the largest that is allowed
    template <typename T>
    void choice(T& v, T last) {
        auto number = static_cast<std::uint32_t>(v);
        value(number);
        require(number <= static_cast<std::uint32_t>(last));
        v = static_cast<T>(number);
    }
    void index(std::uint32_t& v, std::size_t limit) {
        value(v);
        require(v < limit);
    }
    void pose(RigidTransform& v);

    /// An array whose size the simulation determines.
    template <typename T>
    void array(std::vector<T>& values) {
        static_assert(kIsPlain<T>);
        std::uint64_t count = values.size();
        value(count);
        require(count == values.size());
        transfer(values.data(), values.size());
        for (const T& v : values) require(is_number(v));
    }
    /// The same for finite points.
    void points(PointArrays& values);
    /// An array of any size.
    template <typename T>
    void list(std::vector<T>& values) {
        static_assert(kIsPlain<T>);
        values.resize(count(values.size(), sizeof(T)));
        transfer(values.data(), values.size());
        for (const T& v : values) require(is_number(v));
    }
    /// Indices below a limit, at most this many.
    void indices(std::vector<std::uint32_t>& values, std::size_t limit, std::size_t most);
    /// An array of any size. It grows as bytes are read, because the count alone does not tell how many bytes
    /// an item takes. @param each  archives an item
    template <typename Item, typename Each>
    void items(std::vector<Item>& values, const Each& each) {
        const std::size_t item_count = count(values.size(), 1);
        if (reads_) values.clear();
        for (std::size_t i = 0; i < item_count; ++i) {
            if (reads_) values.emplace_back();
            each(values[i]);
        }
    }
    template <typename T, typename Each>
    void optional(std::optional<T>& v, const Each& each) {
        bool has_value = v.has_value();
        flag(has_value);
        if (reads_) v.reset();
        if (!has_value) return;
        if (reads_) v.emplace();
        each(*v);
    }

  private:
    /// @param least_bytes  the least size of an item, so that no count makes the reader allocate more memory
    /// than there are bytes
    std::size_t count(std::size_t present, std::size_t least_bytes);

    void read(void* to, std::size_t byte_count);
    void write(const void* from, std::size_t byte_count);
    template <typename T>
    void transfer(T* values, std::size_t count) {
        if (count == 0) return;
        if (reads_)
            read(values, count * sizeof(T));
        else
            write(values, count * sizeof(T));
    }

    template <typename T>
    static bool is_number(const T& v) {
        if constexpr (std::is_floating_point_v<T>)
            return !std::isnan(v);
        else if constexpr (std::is_arithmetic_v<T>)
            return true;
        else
            return all_numbers(v);
    }
    template <typename T>
    static bool all_numbers(const Vec3<T>& v) {
        return is_number(v.x) && is_number(v.y) && is_number(v.z);
    }
    template <typename T, std::size_t n>
    static bool all_numbers(const std::array<T, n>& v) {
        for (const T& part : v)
            if (!is_number(part)) return false;
        return true;
    }

    bool reads_ = false;
    std::vector<std::byte> written_;
    std::span<const std::byte> left_;
    std::string name_;
};

} // namespace echinus
