#include "compare/measuring.hpp"

#include "compare/turns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace echinus::comparison {

namespace {

template <typename Items>
auto part_of(Items& all, Part part) {
    return std::span(all).subspan(part.begin, part.size());
}

/// Memory for the answers, and the two queries.
class Interview {
  public:
    Interview(const JudgedSet& set, bool one_by_one)
        : set_(set), one_by_one_(one_by_one), inside_(set.points.size()), contacts_(set.points.size()) {}

    void ask_sides(const rivals::System& system, Part part) {
        if (!one_by_one_) return system.contains_batch(part_of(set_.points, part), part_of(inside_, part));
        for (std::size_t i = part.begin; i < part.end; ++i) inside_[i] = system.contains(set_.points[i]);
    }

    void ask_contacts(const rivals::System& system, Part part) {
        if (!one_by_one_) return system.contacts_batch(part_of(set_.points, part), part_of(contacts_, part));
        for (std::size_t i = part.begin; i < part.end; ++i) contacts_[i] = system.contact(set_.points[i]);
    }

    /// Queries once more, since another system answered last.
    Answers answers(const rivals::System& system, const std::vector<Part>& parts, const Effort& effort) {
        Answers answers;
        for (const Part& part : parts) {
            if (effort.sides) ask_sides(system, part);
            if (effort.contacts) ask_contacts(system, part);
            for (std::size_t i = part.begin; i < part.end; ++i) {
                answers.asked.push_back(static_cast<std::uint32_t>(i));
                answers.inside.push_back(effort.sides ? inside_[i] : contacts_[i].inside);
                if (!effort.contacts) continue;
                answers.depth.push_back(contacts_[i].inside ? contacts_[i].depth : 0);
                answers.normal.push_back(contacts_[i].inside ? contacts_[i].normal : Vec3f{});
            }
        }
        return answers;
    }

  private:
    const JudgedSet& set_;
    bool one_by_one_;
    std::vector<std::uint8_t> inside_;
    std::vector<Contact> contacts_;
};

/// All systems with one query.
/// @param ask  void (const rivals::System&, Part of the set)
template <typename Ask>
std::vector<Racer> racers_for(std::span<const rivals::System* const> systems, std::size_t point_count,
                              const Effort& effort, const Ask& ask) {
    std::vector<Part> calls;
    if (effort.call_size > 0)
        for (std::size_t end = effort.call_size; end <= point_count; end += effort.call_size)
            calls.push_back({end - effort.call_size, end});
    std::vector<Racer> racers;
    for (const rivals::System* system : systems) {
        const auto run = [&ask, system](Part part) { ask(*system, part); };
        racers.push_back({run, calls.empty() ? parts_for(run, point_count, effort.patience_seconds) : calls});
    }
    return racers;
}

std::vector<Pace> paces_of(const std::vector<Racer>& racers, const Effort& effort,
                           const std::function<void(double)>& report_progress) {
    TurnOptions turns;
    turns.passes = effort.passes;
    turns.enough_seconds = effort.enough_seconds;
    turns.report_progress = report_progress;
    return take_turns(racers, turns);
}

} // namespace

TimedBuild build_timed(const Builder& builder) {
    constexpr double kEnough = 0.1; // seconds
    constexpr std::size_t kMaxBuilds = 9;
    Built system;
    std::vector<double> times;
    for (double sum = 0; times.empty() || (sum < kEnough && times.size() < kMaxBuilds); sum += times.back()) {
        system.reset();
        const double start = process_seconds();
        system = builder.build();
        times.push_back(process_seconds() - start);
    }
    return {std::move(system), 1e3 * (median_of(times) + builder.shared_seconds)};
}

std::vector<SetFigures> measure(std::span<const rivals::System* const> systems, const JudgedSet& set,
                                double radius, const Effort& effort,
                                const std::function<void(double fraction)>& report_progress) {
    const std::size_t count = set.points.size();
    Interview interview(set, effort.one_by_one);
    const auto ask_sides = [&](const rivals::System& s, Part part) { interview.ask_sides(s, part); };
    const auto ask_contacts = [&](const rivals::System& s, Part part) { interview.ask_contacts(s, part); };
    std::vector<SetFigures> figures(systems.size());
    std::vector<Racer> racers;
    std::vector<Pace> sides(systems.size()), contacts(systems.size());
    const double share = effort.sides && effort.contacts ? 0.5 : 1;
    if (effort.sides) {
        racers = racers_for(systems, count, effort, ask_sides);
        sides = paces_of(racers, effort, [&](double f) { report_progress(share * f); });
    }
    if (effort.contacts) {
        racers = racers_for(systems, count, effort, ask_contacts);
        contacts = paces_of(racers, effort, [&](double f) { report_progress(1 - share * (1 - f)); });
    }
    for (std::size_t k = 0; k < systems.size(); ++k) {
        figures[k] = {set.name, std::move(sides[k]), std::move(contacts[k]), {}};
        if (set.truth.inside.empty()) continue;
        const Answers answers = interview.answers(*systems[k], racers[k].parts, effort);
        figures[k].errors = errors_of(set.truth, radius, answers, effort.undecided);
    }
    return figures;
}

namespace {

/// R. Floats have steps of 6e-8 R there: below half a degree of this.
constexpr double kFarEnoughForAWay = 1e-5;

Spread spread_of(std::vector<double> errors) {
    if (errors.empty()) return {};
    std::ranges::sort(errors);
    const auto count = static_cast<double>(errors.size());
    Spread spread{errors.size(), 0, errors[static_cast<std::size_t>(0.99 * (count - 1))], errors.back()};
    for (const double error : errors) spread.mean += error / count;
    return spread;
}

/// Between two directions of about unit length, in degrees. By both products, since the arc cosine alone does
/// not resolve angles below a thousandth of a degree.
double angle_between(const Vec3f& a, const Vec3f& b) {
    if (length(a) == 0) return 90;
    const double angle = std::atan2(length(cross(Vec3d(a), Vec3d(b))), dot(Vec3d(a), Vec3d(b)));
    return angle * 180 / std::numbers::pi;
}

} // namespace

ErrorSummary errors_of(const Truth& truth, double radius, const Answers& answers, double undecided) {
    ErrorSummary summary;
    summary.asked_count = answers.asked.size();
    std::size_t wrong_count = 0;
    std::vector<double> depth_errors, angles;
    for (std::size_t i = 0; i < answers.asked.size(); ++i) {
        const std::uint32_t particle = answers.asked[i];
        const bool is_inside = truth.inside[particle] != 0, said_inside = answers.inside[i] != 0;
        const double distance = double{truth.distance[particle]} / radius;
        if (said_inside != is_inside && distance >= undecided) {
            ++wrong_count;
            summary.farthest_wrong = std::max(summary.farthest_wrong, distance);
        }
        if (!is_inside || answers.depth.empty()) continue;
        const double depth = said_inside ? double{answers.depth[i]} / radius : 0;
        depth_errors.push_back(std::fabs(depth - distance));
        if (said_inside && !truth.way_out.empty() && distance >= kFarEnoughForAWay)
            angles.push_back(angle_between(answers.normal[i], truth.way_out[particle]));
    }
    if (summary.asked_count > 0)
        summary.wrong_share = static_cast<double>(wrong_count) / static_cast<double>(summary.asked_count);
    summary.depth = spread_of(std::move(depth_errors));
    summary.normal = spread_of(std::move(angles));
    return summary;
}

} // namespace echinus::comparison
