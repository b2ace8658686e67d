// In place of Highway's targets.cc: the instruction sets of an x86-64 processor, as Highway groups them.
#include <hwy/targets.h>

namespace hwy {

namespace {

std::int64_t detected_targets() {
    std::int64_t targets = HWY_SCALAR;
    // GCC's functions ask the operating system, too, whether it saves the wider registers.
    const bool sse4 = __builtin_cpu_supports("ssse3") && __builtin_cpu_supports("sse4.1") &&
                      __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("pclmul") &&
                      __builtin_cpu_supports("aes");
    const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("lzcnt") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                      __builtin_cpu_supports("fma") && __builtin_cpu_supports("f16c");
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    if (sse4) targets |= HWY_SSE4;
    if (avx2) targets |= HWY_AVX2;
    if (avx512) targets |= HWY_AVX3;
    return targets;
}

} // namespace

std::int64_t SupportedTargets() {
    static const std::int64_t targets = detected_targets();
    return targets;
}

ChosenTarget& GetChosenTarget() {
    static ChosenTarget chosen;
    return chosen;
}

} // namespace hwy
