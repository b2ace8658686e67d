#include "compare/columns.hpp"
#include "compare/comparison_report.hpp"
#include "console/machine.hpp"

#include <fmt/format.h>

#include <algorithm>

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
