#include "simd/dispatch.hpp"

#include <echinus/error.hpp>
#include <echinus/instruction_set.hpp>

#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace echinus {

namespace {

constexpr std::int64_t kScalar = 0; // the reference; not a Highway target

struct InstructionSet {
    std::string_view name;
    std::int64_t target;
};

/// Ordered from the widest to the narrowest.
constexpr std::array kInstructionSets {
#if HWY_ARCH_X86
    InstructionSet{"avx512", HWY_AVX3}, InstructionSet{"avx2", HWY_AVX2}, InstructionSet{"sse4", HWY_SSE4},
#elif HWY_ARCH_ARM
    InstructionSet{"neon", HWY_NEON},
#elif HWY_ARCH_WASM
    InstructionSet{"wasm", HWY_WASM},
#endif
        InstructionSet{"scalar", kScalar},
};

bool is_available(const InstructionSet& set) {
    return set.target == kScalar || (HWY_SUPPORTED_TARGETS & HWY_TARGETS & set.target) != 0;
}

const InstructionSet* find(std::string_view name) {
    const auto* found = std::find_if(kInstructionSets.begin(), kInstructionSets.end(),
                                     [&](const InstructionSet& set) { return set.name == name; });
    return found != kInstructionSets.end() && is_available(*found) ? found : nullptr;
}

const InstructionSet* initial_choice() {
    const char* wish = std::getenv("ECHINUS_INSTRUCTION_SET");
    if (const InstructionSet* wished = wish != nullptr ? find(wish) : nullptr) return wished;
    return std::find_if(kInstructionSets.begin(), kInstructionSets.end(), is_available);
}

/// The instruction set in use, in our representation and in Highway's.
class Choice {
  public:
    Choice() { set(initial_choice()); }

    void set(const InstructionSet* instruction_set) {
        target_.Update(instruction_set->target);
        set_.store(instruction_set);
    }
    const InstructionSet& get() const { return *set_.load(std::memory_order_relaxed); }
    hwy::ChosenTarget& target() { return target_; }

  private:
    std::atomic<const InstructionSet*> set_;
    hwy::ChosenTarget target_;
};

Choice& choice() {
    static Choice the_choice;
    return the_choice;
}

} // namespace

std::vector<std::string_view> available_instruction_sets() {
    std::vector<std::string_view> names;
    for (const InstructionSet& set : kInstructionSets)
        if (is_available(set)) names.push_back(set.name);
    return names;
}

std::string_view instruction_set() noexcept {
    return choice().get().name;
}

void use_instruction_set(std::string_view name) {
    const InstructionSet* set = find(name);
    if (set == nullptr) {
        std::string names;
        for (const std::string_view available : available_instruction_sets())
            names += (names.empty() ? "" : ", ") + std::string(available);
        throw Error(ErrorCode::InvalidOptions,
                    "no instruction set '" + std::string(name) + "' on this machine; there are: " + names);
    }
    choice().set(set);
}

hwy::ChosenTarget& chosen_target() noexcept {
    return choice().target();
}

bool use_kernels() noexcept {
    return choice().get().target != kScalar;
}

} // namespace echinus
