#include "compare/comparison_report.hpp"

#include "compare/columns.hpp"
#include "compare/plot.hpp"
#include "console/machine.hpp"
#include "encoding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

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

namespace {

constexpr std::string_view kStyle = R"(
:root { --paper: #faf9f6; --ink: #23262b; --quiet: #686d76; --line: #e1ded6; --accent: #2f6f8f; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #16181c; --ink: #e6e4df; --quiet: #9a9fa8; --line: #33373e; --accent: #7cb9d4; }
  img, svg { filter: brightness(0.88); }
}
body { margin: 0; background: var(--paper); color: var(--ink); font: 1rem/1.55 system-ui, "Liberation Sans", sans-serif; }
main { max-width: 66rem; margin: 0 auto; padding: clamp(1.5rem, 5vw, 4rem) clamp(1rem, 4vw, 2rem); }
h1 { margin: 0; font-size: 2.2rem; letter-spacing: -0.02em; overflow-wrap: anywhere; }
h2 { margin: 3rem 0 0.5rem; font-size: 1.4rem; }
p, li { max-width: 46rem; }
header img { float: right; width: min(24rem, 45%); margin: 0 0 1rem 1.5rem; border-radius: 8px; }
.wide { clear: both; overflow-x: auto; margin: 1.2rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 0.94rem; }
th, td { padding: 0.35rem 0.7rem; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
thead th:first-child { text-align: left; }
thead th { color: var(--quiet); font-weight: 600; }
tbody th { text-align: left; font-weight: 500; }
.group { text-align: center; border-left: 1px solid var(--line); }
.first { border-left: 1px solid var(--line); }
.ours th, .ours td { color: var(--accent); font-weight: 600; }
svg { width: 100%; height: auto; margin: 1rem 0; border-radius: 8px; }
.quiet { color: var(--quiet); }
)";

bool starts_group(const std::vector<Column>& columns, std::size_t k) {
    return k == 0 || columns[k].group != columns[k - 1].group;
}

std::string head_of(const std::vector<Column>& columns) {
    std::string groups = "<tr><th></th>", heads = "<tr><th scope=\"col\">system</th>";
    for (std::size_t first = 0, last = 0; first < columns.size(); first = last) {
        while (last < columns.size() && columns[last].group == columns[first].group) ++last;
        groups += fmt::format("<th class=\"group\" colspan=\"{}\">{}</th>", last - first,
                              escaped(columns[first].group));
    }
    for (std::size_t k = 0; k < columns.size(); ++k)
        heads += fmt::format("<th scope=\"col\"{}>{}</th>",
                             starts_group(columns, k) ? " class=\"first\"" : "", escaped(columns[k].head));
    return "<thead>" + groups + "</tr>\n" + heads + "</tr></thead>\n";
}

std::string html_table(const std::vector<Column>& columns, const Comparison& comparison) {
    std::string html = "<div class=\"wide\"><table>\n" + head_of(columns) + "<tbody>\n";
    for (const Figures& figures : comparison.systems) {
        html += fmt::format("<tr{}><th scope=\"row\">{}</th>",
                            line_style_of(*figures.system).dashed ? "" : " class=\"ours\"",
                            escaped(figures.system->title));
        for (std::size_t k = 0; k < columns.size(); ++k)
            html += fmt::format("<td{}>{}</td>", starts_group(columns, k) ? " class=\"first\"" : "",
                                escaped(columns[k].cell(figures)));
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

std::string list_of(const std::vector<std::string>& items) {
    if (items.empty()) return {};
    std::string html = "<ul>\n";
    for (const std::string& item : items) html += "<li>" + escaped(item) + "</li>\n";
    return html + "</ul>\n";
}

std::string plots_of(const Comparison& comparison) {
    std::string html;
    for (const Plot& plot : curve_plots(comparison)) html += svg(plot);
    return html;
}

std::string bytes_of_each(const Comparison& comparison) {
    std::vector<std::string> lines;
    for (const Figures& figures : comparison.systems)
        lines.push_back(std::string(figures.system->title) + ": " + figures.counted + ".");
    return list_of(lines);
}

} // namespace

std::string to_html(const Comparison& comparison, const CompareOptions& options, const std::string& mesh_name,
                    const Image& picture) {
    const std::string name = escaped(mesh_name);
    std::string html = fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{0}: systems compared</title>\n"
        "<style>{1}</style></head>\n<body><main>\n<header><img alt=\"The model {0}\" "
        "src=\"data:image/png;base64,{2}\">\n<h1>{0}</h1>\n"
        "<p>{3} faces, bounding radius R = {4:.4g}. Each system has at most {5} bytes and is asked about the "
        "same particles, {6} in each set: U everywhere in the bounding sphere, S near the surface (moved off "
        "it by a normal distribution of 1 % of R), C like a cloth that lies over the model.</p></header>\n",
        name, kStyle, base64(encode_png(picture)), comparison.face_count, comparison.radius,
        options.byte_budget, options.point_count);
    html += "<h2>How long, how many bytes</h2>\n" + html_table(time_columns(comparison), comparison);
    html += "<h2>How wrong</h2>\n" + html_table(error_columns(comparison), comparison);
    html += list_of(remarks_on(comparison));
    if (!comparison.curves.empty())
        html +=
            "<h2>Over sizes, near the surface</h2>\n<p>Down and to the left is better. Dashed: not a map of "
            "Echinus.</p>\n" +
            plots_of(comparison);
    html += fmt::format(
        "<h2>How it was measured</h2>\n"
        "<p>Times are processor times: of builds on one thread (OpenVDB's: summed over its threads), of "
        "queries "
        "per particle, one call for a whole set on one thread, the systems taking turns, medians. {}.</p>\n"
        "<p>The judge is an exact map, so its own errors are 0 here by definition; Echinus proves it "
        "against CGAL's exact arithmetic elsewhere. It is exact on a lattice with a step of 1.9e-6 R; "
        "particles nearer to the surface than 2e-6 R count as right. The depth error of a particle inside is "
        "how far the "
        "answered "
        "depth is from the distance to the surface, 0 being answered where the particle was missed. The "
        "normal "
        "error is the angle to the way to the nearest point. Maps that push along rays from a centre "
        "(distance "
        "and superquadric maps) answer that depth, which is longer.</p>\n<p>What the bytes are:</p>\n{}",
        escaped(describe_machine()), bytes_of_each(comparison));
    return html + "</main></body></html>\n";
}
