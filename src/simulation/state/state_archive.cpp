#include "simulation/state/state_archive.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

namespace echinus {

namespace {

/// The most that drift may change the squared length of a quaternion.
constexpr double kUnitTolerance = 1e-3;

} // namespace

void StateArchive::pose(RigidTransform& v) {
    Rotation& r = v.rotation;
    for (double* number : {&r.w, &r.x, &r.y, &r.z}) value(*number);
    value(v.translation);
    const double size_sq = r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z;
    require(std::abs(size_sq - 1) <= kUnitTolerance && is_finite(v.translation));
}

void StateArchive::points(PointArrays& values) {
    for (std::vector<float>* c : {&values.x, &values.y, &values.z}) {
        array(*c);
        require(std::all_of(c->begin(), c->end(), [](float number) { return std::isfinite(number); }));
    }
}

void StateArchive::indices(std::vector<std::uint32_t>& values, std::size_t limit, std::size_t most) {
    list(values);
    require(values.size() <= most);
    for (const std::uint32_t i : values) require(i < limit);
}

void StateArchive::read(void* to, std::size_t byte_count) {
    require(byte_count <= left_.size());
    std::memcpy(to, left_.data(), byte_count);
    left_ = left_.subspan(byte_count);
}

void StateArchive::write(const void* from, std::size_t byte_count) {
    const std::size_t before = written_.size();
    written_.resize(before + byte_count);
    std::memcpy(written_.data() + before, from, byte_count);
}

std::size_t StateArchive::count(std::size_t present, std::size_t least_bytes) {
    std::uint64_t count = present;
    value(count);
    if (reads_) require(count <= left_.size() / least_bytes);
    return static_cast<std::size_t>(count);
}

} // namespace echinus
