#include "compare/comparison_report.hpp"

#include "console/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>
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
                fmt::format("{}: exceeds the size limit; {}.", figures.system->title, figures.excess));
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

using namespace echinus;
using namespace echinus::comparison;

namespace {

// ---- JSON ----

/// Null without answers to judge.
Json to_json(const Spread& spread) {
    if (spread.count == 0) return nullptr;
    return {{"mean", spread.mean}, {"percentile_99", spread.most}, {"worst", spread.worst}};
}

Json to_json(const SetFigures& figures) {
    return {{"contains_ns", figures.contains.ns},
            {"contains_spread", figures.contains.spread},
            {"contacts_ns", figures.contacts.ns},
            {"contacts_spread", figures.contacts.spread},
            {"wrong_share", figures.errors.wrong_share},
            {"farthest_wrong_radii", figures.errors.farthest_wrong},
            {"depth_error_radii", to_json(figures.errors.depth)},
            {"normal_error_degrees", to_json(figures.errors.normal)}};
}

Json to_json(const Figures& figures) {
    Json sets = Json::object();
    for (const SetFigures& set : figures.sets) sets.add(set.set, to_json(set));
    return {{"name", figures.system->name},
            {"title", figures.system->title},
            {"bytes", figures.byte_count},
            {"bytes_are", figures.counted},
            {"over_budget", !figures.excess.empty()},
            {"build_ms", figures.build_ms},
            {"sets", std::move(sets)}};
}

Json curves_to_json(const Comparison& comparison) {
    Json curves = Json::array();
    for (const std::vector<Figures>& sizes : comparison.curves) {
        if (sizes.empty()) continue;
        Json points = Json::array();
        for (const Figures& figures : sizes) points.push_back(to_json(figures));
        curves.push_back({{"name", sizes.front().system->name}, {"sizes", std::move(points)}});
    }
    return curves;
}

// ---- Text ----

std::string centred(const std::string& text, std::size_t width) {
    return fmt::format("{:^{}}", text, width);
}

/// Columns of one group stand together under its name, each as wide as its widest cell.
std::string table_of(const std::vector<Column>& columns, const Comparison& comparison) {
    constexpr std::size_t kGap = 2, kGroupGap = 3;
    std::string groups, heads;
    std::vector<std::string> rows(comparison.systems.size());
    std::size_t name_width = 0;
    for (const Figures& figures : comparison.systems)
        name_width = std::max(name_width, figures.system->title.size());
    const auto begin = [&](std::string& line, std::string_view name) {
        line = fmt::format("{:<{}}", name, name_width);
    };
    begin(groups, "");
    begin(heads, "");
    for (std::size_t i = 0; i < rows.size(); ++i) begin(rows[i], comparison.systems[i].system->title);

    for (std::size_t first = 0, last = 0; first < columns.size(); first = last) {
        while (last < columns.size() && columns[last].group == columns[first].group) ++last;
        std::string group_heads;
        std::vector<std::string> group_rows(rows.size());
        for (std::size_t k = first; k < last; ++k) {
            std::vector<std::string> cells;
            std::size_t width = columns[k].head.size();
            for (const Figures& figures : comparison.systems) {
                cells.push_back(columns[k].cell(figures));
                width = std::max(width, cells.back().size());
            }
            width += k == first ? 0 : kGap;
            group_heads += fmt::format("{:>{}}", columns[k].head, width);
            for (std::size_t i = 0; i < rows.size(); ++i)
                group_rows[i] += fmt::format("{:>{}}", cells[i], width);
        }
        const std::size_t width = std::max(group_heads.size(), columns[first].group.size());
        const std::string gap(kGroupGap, ' ');
        groups += gap + centred(columns[first].group, width);
        heads += gap + fmt::format("{:>{}}", group_heads, width);
        for (std::size_t i = 0; i < rows.size(); ++i)
            rows[i] += gap + fmt::format("{:>{}}", group_rows[i], width);
    }
    std::string text;
    for (const std::string* line : {&groups, &heads})
        text += line->substr(0, line->find_last_not_of(' ') + 1) + "\n";
    for (const std::string& row : rows) text += row + "\n";
    return text;
}

} // namespace

Json to_json(const Comparison& comparison, const CompareOptions& options, const std::string& mesh_name) {
    Json systems = Json::array(), refusals = Json::array();
    for (const Figures& figures : comparison.systems) systems.push_back(to_json(figures));
    for (const Refusal& refusal : comparison.refusals)
        refusals.push_back({{"name", refusal.system->name}, {"reason", refusal.reason}});
    Json result{{"mesh", mesh_name},
                {"faces", comparison.face_count},
                {"radius", comparison.radius},
                {"machine", describe_machine()},
                {"byte_budget", options.byte_budget},
                {"particles", options.point_count},
                {"parts_overlap", comparison.parts_overlap},
                {"systems", std::move(systems)},
                {"left_out", std::move(refusals)}};
    if (!comparison.curves.empty()) result.add("curves", curves_to_json(comparison));
    return result;
}

std::string to_text(const Comparison& comparison, const CompareOptions& options,
                    const std::string& mesh_name) {
    std::string text = fmt::format(
        "{}: {} faces, R = {:.4g}; each system in at most {} bytes; {} particles in each of\n"
        "U (everywhere in the bounding sphere), S (near the surface) and C (like a cloth)\n\n",
        mesh_name, comparison.face_count, comparison.radius, options.byte_budget, options.point_count);
    text += table_of(time_columns(comparison), comparison) + "\n";
    text += table_of(error_columns(comparison), comparison);
    const std::vector<std::string> remarks = remarks_on(comparison);
    if (!remarks.empty()) text += "\n";
    for (const std::string& remark : remarks) text += remark + "\n";
    return text + "\nTimes are processor times on one thread, one call for a whole set. The judge is an "
                  "exact map.\n";
}
