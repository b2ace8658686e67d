#pragma once

#include <echinus/export.hpp>

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

ECHINUS_EXPORT_BEGIN

/// Points, spheres, poses and strided views: the value types that all other headers use.
/// Frames are right-handed. Lengths are in the caller's unit.
namespace echinus {

/// The index of a face, a particle or a collider that does not exist or is not known. All indices in arrays
/// and results are std::uint32_t.
inline constexpr std::uint32_t kNoIndex = 0xFFFFFFFF;

template <typename T>
struct Vec3 {
    T x{}, y{}, z{};

    constexpr Vec3() = default;
    constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
    /// Widening (float to double) is exact; narrowing rounds to nearest.
    template <typename U>
    constexpr explicit Vec3(const Vec3<U>& other)
        : x(static_cast<T>(other.x)), y(static_cast<T>(other.y)), z(static_cast<T>(other.z)) {}

    constexpr Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
    constexpr Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
    constexpr Vec3& operator*=(T s) { return *this = *this * s; }

    friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vec3 operator*(const Vec3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vec3 operator*(T s, const Vec3& a) { return a * s; }
    friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

// The order of the additions below is part of the guarantee of bit-identical results on every machine.
template <typename T>
constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
T length(const Vec3<T>& a) {
    return std::sqrt(dot(a, a));
}
template <typename T>
bool is_finite(const Vec3<T>& a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Converts a point in the frame of a file to one relative to the origin of a mesh or map
/// (TriangleMesh::origin). It is rounded to float only after the subtraction, so that no precision is lost
/// far from the origin of the file's frame.
inline Vec3f to_local(const Vec3d& point, const Vec3d& origin) {
    return Vec3f(point - origin);
}

/// A ball: all points within `radius` of `centre`.
struct Sphere {
    Vec3d centre;
    double radius = 0;
};

/// A rotation as a unit quaternion w + xi + yj + zk. The length is not checked: a quaternion of a different
/// length is not a rotation, and results computed with it are meaningless. normalised() corrects rounding
/// errors.
struct Rotation {
    double w = 1, x = 0, y = 0, z = 0;

    /// The rotation by `angle_rad` about `axis` (of any length except 0), counter-clockwise seen from the tip
    /// of the axis. Both must be finite. The result is bit-identical on every machine.
    static Rotation about(const Vec3d& axis, double angle_rad);

    Vec3d apply(const Vec3d& v) const;
    /// The rotation vector: it points along the axis, and its length is the angle in radians, at most pi.
    /// about(vector, length(vector)) is the same rotation. It is 0 for the identity. The result is
    /// bit-identical on every machine.
    Vec3d vector() const;
    Rotation inverse() const { return {w, -x, -y, -z}; }
    Rotation normalised() const;

    friend constexpr bool operator==(const Rotation&, const Rotation&) = default;
};
/// The rotation `b` followed by the rotation `a`.
Rotation operator*(const Rotation& a, const Rotation& b);

/// A pose: a rotation followed by a translation. The translation is in double, so that a collider may be far
/// from the origin.
/// @pre the rotation has unit length, up to rounding
struct RigidTransform {
    Rotation rotation;
    Vec3d translation;

    Vec3d to_world(const Vec3d& point_local) const { return rotation.apply(point_local) + translation; }
    Vec3d to_local(const Vec3d& point_world) const {
        return rotation.inverse().apply(point_world - translation);
    }

    friend constexpr bool operator==(const RigidTransform&, const RigidTransform&) = default;
};

/// A view of `size` values of type T that are `stride` bytes apart, for instance the positions in an array of
/// vertex structs. It owns nothing. A contiguous container of T converts to it.
template <typename T>
class StridedSpan {
    using Byte = std::conditional_t<std::is_const_v<T>, const std::byte, std::byte>;

  public:
    constexpr StridedSpan() = default;
    StridedSpan(T* first, std::size_t size, std::size_t stride = sizeof(T))
        : first_(reinterpret_cast<Byte*>(first)), size_(size), stride_(stride) {}
    template <typename Container>
    requires requires(Container& c) {
        { c.data() } -> std::convertible_to<T*>;
        c.size();
    }
    StridedSpan(Container&& container) : StridedSpan(container.data(), container.size()) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T& operator[](std::size_t i) const { return *reinterpret_cast<T*>(first_ + i * stride_); }
    /// @pre first + count <= size()
    StridedSpan subspan(std::size_t first, std::size_t count) const {
        StridedSpan result = *this;
        result.first_ = first_ + first * stride_;
        result.size_ = count;
        return result;
    }

  private:
    Byte* first_ = nullptr;
    std::size_t size_ = 0;
    std::size_t stride_ = sizeof(T);
};

} // namespace echinus

ECHINUS_EXPORT_END
