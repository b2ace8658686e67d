#pragma once

#include <cstddef>
#include <vector>

namespace echinus::test {

/// Under sanitizers a test takes every eighth of its samples: these find how an answer is computed, and the
/// optimised build judges all answers.
#ifdef __SANITIZE_ADDRESS__
inline constexpr std::size_t kSampleStride = 8;
#else
inline constexpr std::size_t kSampleStride = 1;
#endif

template <typename T>
std::vector<T> sampled(const std::vector<T>& all) {
    std::vector<T> some;
    for (std::size_t i = 0; i < all.size(); i += kSampleStride) some.push_back(all[i]);
    return some;
}

} // namespace echinus::test
