// One particle at a time: the reference for the kernels.

#include "rivals/dense_grid/field.hpp"
#include "simd/dispatch.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace echinus::rivals {

namespace {

struct Cell {
    std::size_t first; ///< its lowest corner's sample
    float x, y, z;     ///< within it, 0 to 1
};

bool is_in_box(const SampledField& field, const Vec3f& p) {
    return p.x >= field.low.x && p.x <= field.high.x && p.y >= field.low.y && p.y <= field.high.y &&
           p.z >= field.low.z && p.z <= field.high.z;
}

/// @pre the point lies in the box
Cell cell_of(const SampledField& field, const Vec3f& p) {
    std::array<std::size_t, 3> node;
    const auto place = [&](int axis, float offset) {
        const float coordinate = std::min(offset * field.nodes_per_unit, field.last(axis));
        const float lowest = std::min(coordinate, field.last(axis) - 1); // the last node is in the last cell
        const auto whole = static_cast<std::int32_t>(lowest);
        node[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(whole);
        return coordinate - static_cast<float>(whole);
    };
    Cell cell{};
    cell.x = place(0, p.x - field.low.x);
    cell.y = place(1, p.y - field.low.y);
    cell.z = place(2, p.z - field.low.z);
    cell.first = node[2] * static_cast<std::size_t>(field.slice()) +
                 node[1] * static_cast<std::size_t>(field.row()) + node[0];
    return cell;
}

float mix(float a, float b, float t) {
    return a + (b - a) * t;
}

float stored(const SampledField& field, std::size_t node) {
    return field.format == SampleFormat::Float32 ? field.float32[node]
                                                 : static_cast<float>(field.snorm16[node]);
}

/// Depths and normals of a block of particles, an array a component.
struct Block {
    static constexpr std::size_t kSize = 512; // in the first-level cache, with room to spare

    DenseGrid::Contacts first(std::size_t count) {
        const auto part = [&](auto& all) { return std::span<float>(all).first(count); };
        return {part(depths), part(x), part(y), part(z)};
    }

    std::array<float, kSize> depths, x, y, z;
};

} // namespace

DenseGrid::Sample DenseGrid::sample(const Vec3f& point) const noexcept {
    const SampledField& f = *field_;
    if (!is_in_box(f, point)) return {};
    const Cell c = cell_of(f, point);
    const auto row = static_cast<std::size_t>(f.row()), slice = static_cast<std::size_t>(f.slice());
    const auto s = [&](std::size_t offset) { return stored(f, c.first + offset); };
    const float s000 = s(0), s100 = s(1), s010 = s(row), s110 = s(row + 1);
    const float s001 = s(slice), s101 = s(slice + 1), s011 = s(slice + row), s111 = s(slice + row + 1);
    const float s00 = mix(s000, s100, c.x), s10 = mix(s010, s110, c.x);
    const float s01 = mix(s001, s101, c.x), s11 = mix(s011, s111, c.x);
    const float low_z = mix(s00, s10, c.y), high_z = mix(s01, s11, c.y);
    const float along_x = mix(mix(s100 - s000, s110 - s010, c.y), mix(s101 - s001, s111 - s011, c.y), c.z);
    const float along_y = mix(s10 - s00, s11 - s01, c.z);
    const float along_z = high_z - low_z;
    const float scale = f.slope_scale();
    return {mix(low_z, high_z, c.z) * f.step, {along_x * scale, along_y * scale, along_z * scale}};
}

void DenseGrid::contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const {
    assert(points.size() == inside.size());
    if (use_kernels()) return contains_kernel(*field_, points, inside);
    for (std::size_t i = 0; i < points.size(); ++i) inside[i] = sample(points[i]).distance < 0 ? 1 : 0;
}

void DenseGrid::contacts_batch(std::span<const Vec3f> points, const Contacts& contacts) const {
    assert(points.size() == contacts.depths.size());
    if (use_kernels()) return contacts_kernel(*field_, points, contacts);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto [distance, gradient] = sample(points[i]);
        const float length_sq = gradient.x * gradient.x + gradient.y * gradient.y + gradient.z * gradient.z;
        const float scale = 1 / std::sqrt(std::max(length_sq, kMinGradientSq));
        contacts.depths[i] = -distance;
        contacts.normals_x[i] = gradient.x * scale;
        contacts.normals_y[i] = gradient.y * scale;
        contacts.normals_z[i] = gradient.z * scale;
    }
}

/// Beyond the box depth and normal are 0: no contact.
void DenseGrid::contacts_batch(std::span<const Vec3f> points, float margin,
                               std::span<Contact> contacts) const {
    assert(points.size() == contacts.size());
    Block block;
    for (std::size_t begin = 0; begin < points.size(); begin += Block::kSize) {
        const auto some = points.subspan(begin, std::min(Block::kSize, points.size() - begin));
        contacts_batch(some, block.first(some.size()));
        for (std::size_t i = 0; i < some.size(); ++i)
            contacts[begin + i] =
                block.depths[i] > -margin
                    ? contact_along(some[i], block.depths[i], {block.x[i], block.y[i], block.z[i]})
                    : no_contact(some[i]);
    }
}

std::size_t DenseGrid::byte_count() const {
    return std::span(field_->float32).size_bytes() + std::span(field_->snorm16).size_bytes();
}

std::size_t DenseGrid::node_count(int axis) const {
    return static_cast<std::size_t>(field_->nodes[axis]);
}

double DenseGrid::spacing() const {
    return field_->spacing;
}

double DenseGrid::sample_error_bound() const {
    constexpr double kFloatRounding = 0x1p-22; // of the largest distance, which the box bounds
    const Vec3d size = Vec3d(field_->high) - Vec3d(field_->low);
    const double quantisation = field_->format == SampleFormat::Snorm16 ? double{field_->step} / 2 : 0;
    return quantisation + kFloatRounding * length(size);
}

double DenseGrid::value_error_bound() const {
    constexpr double kHalfDiagonal = 0.8660254037844387; // sqrt(3) / 2
    return field_->spacing * kHalfDiagonal + 2 * sample_error_bound();
}

} // namespace echinus::rivals
