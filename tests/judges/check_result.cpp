#include "judges/check_result.hpp"

#include <algorithm>

namespace echinus::test {

namespace {

constexpr double kCertainShareLimit = 0.9;

} // namespace

const char* name_of(InsideRule rule) {
    return rule == InsideRule::Nonzero ? "nonzero" : "parity";
}

Score CheckResult::total(std::size_t rule) const {
    Score total;
    for (const SetResult& set : sets) total.merge(set.scores[rule]);
    return total;
}

double CheckResult::certain_share() const {
    if (closed) return 1;
    const Score& uniform = sets.front().scores.front();
    return static_cast<double>(uniform.certain) /
           static_cast<double>(std::max<std::size_t>(1, uniform.points));
}

bool CheckResult::right() const {
    for (std::size_t rule = 0; rule < rules.size(); ++rule)
        if (!total(rule).right(closed)) return false;
    return wrong_corners == 0 && judges_disagree == 0;
}

bool CheckResult::holds() const {
    return right() && certain_share() >= kCertainShareLimit;
}

} // namespace echinus::test
