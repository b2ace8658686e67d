#include "simulation/stretched_part.hpp"

#include <algorithm>

namespace echinus {

namespace {

constexpr float kMostStretch = 1.3F; ///< in rest lengths
constexpr int kRings = 3;            ///< of neighbours around a stretched stick
constexpr std::size_t kMostShare = 20;

} // namespace

StretchedPart::StretchedPart(const StickArrays& sticks, std::size_t particle_count)
    : is_part_(particle_count), wider_(particle_count) {
    sticks_.reserve(sticks.count() / kMostShare);
}

void StretchedPart::find(const StickArrays& sticks, const PointArrays& positions) {
    sticks_.clear();
    std::fill(is_part_.begin(), is_part_.end(), std::uint8_t{0});
    bool found = false;
    for (std::size_t i = 0; i < sticks.count(); ++i) {
        const Vec3f across = positions[sticks.b[i]] - positions[sticks.a[i]];
        const float most = kMostStretch * sticks.rest_lengths[i];
        if (!(dot(across, across) > most * most)) continue;
        is_part_[sticks.a[i]] = is_part_[sticks.b[i]] = 1;
        found = true;
    }
    if (!found) return;
    for (int ring = 0; ring < kRings; ++ring) widen(sticks);
    for (std::uint32_t i = 0; i < sticks.count(); ++i) {
        if ((is_part_[sticks.a[i]] & is_part_[sticks.b[i]]) == 0) continue;
        if (sticks_.size() == sticks.count() / kMostShare) return sticks_.clear();
        sticks_.push_back(i);
    }
}

void StretchedPart::archive(StateArchive& state, std::size_t stick_count) {
    state.indices(sticks_, stick_count, stick_count / kMostShare);
    state.array(is_part_);
}

/// By the neighbours of all particles that take part.
void StretchedPart::widen(const StickArrays& sticks) {
    wider_ = is_part_;
    for (std::size_t i = 0; i < sticks.count(); ++i)
        if ((is_part_[sticks.a[i]] | is_part_[sticks.b[i]]) != 0)
            wider_[sticks.a[i]] = wider_[sticks.b[i]] = 1;
    std::swap(is_part_, wider_);
}

} // namespace echinus
