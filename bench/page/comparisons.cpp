#include "page/page_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace {

using Rows = std::vector<std::vector<std::string>>;

/// The values of a column in the order in which they first appear.
std::vector<std::string> distinct(const std::vector<Records::Record>& records, const std::string& column) {
    std::vector<std::string> values;
    for (const Records::Record& record : records)
        if (std::ranges::find(values, record.at(column)) == values.end()) values.push_back(record.at(column));
    return values;
}

/// "a / b / c" over the sets U, S and C, each as `show` gives it.
template <typename Show>
std::string over_sets(const std::vector<const Records::Record*>& sets, Show show) {
    std::vector<std::string> cells;
    for (const Records::Record* record : sets) cells.push_back(show(*record));
    return fmt::format("{}", fmt::join(cells, " / "));
}

std::string megabytes(const Records::Record& record) {
    const double bytes = number(record, "bytes");
    return bytes == 0 ? "" : fmt::format("{:.2f}", bytes / 1e6);
}

std::string percent(double share) {
    return share == 0     ? "0"
           : share < 1e-5 ? fmt::format("{:.4f}", 100 * share)
                          : fmt::format("{:.3f}", 100 * share);
}

std::string label(const Records::Record& record) {
    const std::string name = record.at("system") + ", " + record.at("way");
    return record.at("role") == "ours"    ? "**" + name + "**"
           : record.at("role") == "floor" ? '*' + name + '*'
                                          : name;
}

/// A table of one mesh: a row for each system and way.
std::string table(const Records& all, const std::string& mesh, const std::string& suffix, bool has_depth) {
    Rows rows{{"system", "MB", "build, ms", "ns, U / S / C", "wrong, %, U / S / C", "farthest wrong, R"}};
    if (has_depth) rows.front().push_back("depth error on S, R: mean / 99 % / worst");
    for (const Records::Record& first : all.where({{"mesh", mesh}, {"set", "U" + suffix}})) {
        std::vector<Records::Record> found;
        for (const char* set : {"U", "S", "C"})
            for (Records::Record& record : all.where({{"mesh", mesh},
                                                      {"set", set + suffix},
                                                      {"system", first.at("system")},
                                                      {"way", first.at("way")}}))
                found.push_back(std::move(record));
        std::vector<const Records::Record*> sets;
        double farthest = 0;
        for (const Records::Record& record : found) {
            sets.push_back(&record);
            farthest = std::max(farthest, number(record, "farthest_wrong"));
        }
        const bool answers = first.at("role") != "floor";
        rows.push_back(
            {label(first), megabytes(first), answers ? shown(number(first, "build_ms")) : "",
             over_sets(sets, [](const auto& r) { return shown(number(r, "ns")); }),
             answers ? over_sets(sets, [](const auto& r) { return percent(number(r, "wrong_share")); }) : "",
             !answers        ? ""
             : farthest == 0 ? "none"
                             : fmt::format("{:.0e}", farthest)});
        if (has_depth && sets.size() > 1)
            rows.back().push_back(fmt::format("{:.0e} / {:.0e} / {:.0e}", number(*sets[1], "depth_mean"),
                                              number(*sets[1], "depth_99"), number(*sets[1], "depth_worst")));
    }
    return markdown_table(rows);
}

std::string tables(const Records& all, const char* suffix, bool has_depth) {
    std::string text;
    for (const std::string& mesh : distinct(all.all(), "mesh")) {
        const std::vector<Records::Record> of_mesh =
            all.where({{"mesh", mesh}, {"set", std::string("U") + suffix}});
        if (of_mesh.empty()) continue;
        text += fmt::format("{}`{}`, {} faces, {} particles in each set:\n\n{}\n", text.empty() ? "" : "\n",
                            mesh, of_mesh.front().at("faces"), of_mesh.front().at("particles"),
                            table(all, mesh, suffix, has_depth));
    }
    text.pop_back();
    return text;
}

} // namespace

void add_comparisons(const Results& results, Values& values) {
    values["contains"] = tables(results.contains, "", false);
    values["contacts"] = tables(results.contacts, "", true);
    values["contains_10k"] = tables(results.contains, " 10k", false);
    values["contacts_10k"] = tables(results.contacts, " 10k", true);
}
