#include "compare/columns.hpp"
#include "compare/comparison_report.hpp"
#include "compare/curve_plots.hpp"
#include "compare/markup.hpp"
#include "console/machine.hpp"
#include "encoding.hpp"

#include <fmt/format.h>

#include <string_view>

using namespace echinus;
using namespace echinus::comparison;

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

std::string table_of(const std::vector<Column>& columns, const Comparison& comparison) {
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
    html += "<h2>How long, how many bytes</h2>\n" + table_of(time_columns(comparison), comparison);
    html += "<h2>How wrong</h2>\n" + table_of(error_columns(comparison), comparison);
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
