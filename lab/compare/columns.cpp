#include "compare/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

namespace echinus::comparison {

namespace {

/// Three digits, for easy comparison, without exponents.
std::string digits(double value) {
    if (value > 0 && value < 0.00005) return "<0.0001";
    const int places = value >= 100 ? 0 : value >= 10 ? 1 : value >= 1 ? 2 : value >= 0.1 ? 3 : 4;
    return value == 0 ? "0" : fmt::format("{:.{}f}", value, places);
}

/// A figure of a set; a dash where the system was not measured on it.
template <typename Value>
Column of_set(const char* group, const std::string& set, Value value) {
    return {group, set, [set, value](const Figures& figures) -> std::string {
                const auto found = std::ranges::find(figures.sets, set, &SetFigures::set);
                return found == figures.sets.end() ? "-" : value(*found);
            }};
}

} // namespace

std::vector<Column> time_columns(const Comparison& comparison) {
    std::vector<Column> columns{
        {"size", "MB",
         [](const Figures& f) { return fmt::format("{:.3f}", 1e-6 * static_cast<double>(f.byte_count)); }},
        {"build", "ms", [](const Figures& f) { return digits(f.build_ms); }}};
    for (const std::string& set : comparison.set_names)
        columns.push_back(
            of_set("inside?, ns", set, [](const SetFigures& f) { return digits(f.contains.ns); }));
    for (const std::string& set : comparison.set_names)
        columns.push_back(
            of_set("contact, ns", set, [](const SetFigures& f) { return digits(f.contacts.ns); }));
    return columns;
}

std::vector<Column> error_columns(const Comparison& comparison) {
    std::vector<Column> columns;
    for (const std::string& set : comparison.set_names)
        columns.push_back(of_set("wrong side, %", set,
                                 [](const SetFigures& f) { return digits(100 * f.errors.wrong_share); }));
    using Statistic = std::pair<const char*, double Spread::*>;
    const Statistic mean{"mean", &Spread::mean}, most{"99 %", &Spread::most}, worst{"worst", &Spread::worst};
    const auto add = [&](const char* group, double unit, Spread ErrorSummary::*error,
                         std::initializer_list<Statistic> parts) {
        for (const auto& [head, part] : parts) {
            columns.push_back(
                of_set(group, "S", [unit, error, part = part](const SetFigures& f) -> std::string {
                    const Spread& spread = f.errors.*error;
                    return spread.count == 0 ? "-" : digits(unit * spread.*part);
                }));
            columns.back().head = head;
        }
    };
    add("depth error on S, % of R", 100, &ErrorSummary::depth, {mean, most, worst});
    // The worst angle is always that of a particle with two ways out.
    add("normal error on S, degrees", 1, &ErrorSummary::normal, {mean, most});
    return columns;
}

std::vector<std::string> remarks_on(const Comparison& comparison) {
    std::vector<std::string> remarks;
    for (const Figures& figures : comparison.systems)
        if (!figures.excess.empty())
            remarks.push_back(
                fmt::format("{}: more bytes than it may take; {}.", figures.system->title, figures.excess));
    for (const Refusal& refusal : comparison.refusals)
        remarks.push_back(fmt::format("{}: left out; {}.", refusal.system->title, refusal.reason));
    if (comparison.parts_overlap)
        remarks.push_back(
            "Parts of the mesh overlap or lie in each other: to the judge, the exact map and the "
            "fields their union is inside; Embree, Bullet and the distance maps count crossings, "
            "so that what they have wrong is partly another meaning of inside.");
    return remarks;
}

} // namespace echinus::comparison
