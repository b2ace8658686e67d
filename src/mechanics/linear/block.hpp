#pragma once

#include <echinus/geometry.hpp>

#include <array>
#include <cstddef>

namespace echinus {

/// Three floats and a fourth that pads them to a vector register. The vectors of GCC and Clang give the same
/// bits on every machine, since each lane is computed separately.
struct Float4 {
    using Lanes = float __attribute__((vector_size(16)));
    Lanes lanes{};

    Float4() = default;
    explicit Float4(Lanes values) : lanes(values) {}
    Float4(float x, float y, float z) : lanes{x, y, z, 0} {}
    explicit Float4(const Vec3d& v)
        : lanes{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0} {}

    float operator[](std::size_t i) const { return lanes[i]; }
    void set(std::size_t i, float value) { lanes[i] = value; }
    Vec3d to_double() const { return {double{lanes[0]}, double{lanes[1]}, double{lanes[2]}}; }

    Float4& operator+=(const Float4& b) {
        lanes += b.lanes;
        return *this;
    }
    Float4& operator-=(const Float4& b) {
        lanes -= b.lanes;
        return *this;
    }
    friend Float4 operator+(const Float4& a, const Float4& b) { return Float4(a.lanes + b.lanes); }
    friend Float4 operator-(const Float4& a, const Float4& b) { return Float4(a.lanes - b.lanes); }
    friend Float4 operator*(const Float4& a, float s) { return Float4(a.lanes * s); }
};

inline float dot(const Float4& a, const Float4& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A 3 x 3 matrix, stored by columns.
struct Block {
    std::array<Float4, 3> columns;

    float operator()(std::size_t row, std::size_t column) const { return columns[column][row]; }

    Block& operator+=(const Block& b) {
        for (std::size_t i = 0; i < 3; ++i) columns[i] += b.columns[i];
        return *this;
    }
    Block& operator-=(const Block& b) {
        for (std::size_t i = 0; i < 3; ++i) columns[i] -= b.columns[i];
        return *this;
    }
    friend Block operator*(const Block& a, float s) {
        return {{a.columns[0] * s, a.columns[1] * s, a.columns[2] * s}};
    }
    friend Float4 operator*(const Block& a, const Float4& v) {
        return a.columns[0] * v[0] + a.columns[1] * v[1] + a.columns[2] * v[2];
    }
    void add_scaled(const Block& b, float s) {
        for (std::size_t i = 0; i < 3; ++i) columns[i] += b.columns[i] * s;
    }
    /// Adds s times the identity.
    void add_identity(float s) {
        columns[0].lanes += Float4::Lanes{s, 0, 0, 0};
        columns[1].lanes += Float4::Lanes{0, s, 0, 0};
        columns[2].lanes += Float4::Lanes{0, 0, s, 0};
    }
    /// Adds a b^T.
    void add_outer(const Float4& a, const Float4& b) {
        for (std::size_t i = 0; i < 3; ++i) columns[i] += a * b[i];
    }
    float trace() const { return columns[0][0] + columns[1][1] + columns[2][2]; }
};

/// @pre the block is not singular
Block inverse(const Block& block);

} // namespace echinus
