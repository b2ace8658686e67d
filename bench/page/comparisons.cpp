#include "page/page_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

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
            rows.back().push_back(fmt::format("{:.1g} / {:.1g} / {:.1g}", number(*sets[1], "depth_mean"),
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

/// The first way of each system that was asked in calls of three sizes.
std::string calls(const Results& results) {
    constexpr const char* kSuffixes[] = {" 10k", " 100k", ""};
    Rows rows{{"task, system", "10 000", "100 000", "1 000 000"}};
    for (const Records* records : {&results.contains, &results.contacts}) {
        const std::string mesh = records->all().front().at("mesh");
        const std::vector<Records::Record> asked = records->where({{"mesh", mesh}, {"set", "U 100k"}});
        for (const std::string& system : distinct(asked, "system")) {
            rows.push_back({asked.front().at("task") + ", " + system});
            for (const std::string suffix : kSuffixes) {
                std::vector<std::string> cells;
                for (const std::string set : {"U", "S", "C"})
                    cells.push_back(shown(number(
                        records->where({{"mesh", mesh}, {"set", set + suffix}, {"system", system}}).front(),
                        "ns")));
                rows.back().push_back(fmt::format("{}", fmt::join(cells, " / ")));
            }
        }
    }
    return rows.size() == 1 ? "Not measured." : markdown_table(rows);
}

/// What nobody can go below, and how far above it we are.
std::string floors(const Records& contains) {
    const std::string mesh = contains.all().front().at("mesh");
    Rows rows{{"set", "stream, ns", "one gather, ns", "exact map, ns", "of one gather", "distance map, ns",
               "of one gather"}};
    for (const char* set : {"U", "S", "C"}) {
        const std::vector<Records::Record> all = contains.where({{"mesh", mesh}, {"set", set}});
        const auto ns = [&](const char* system, const char* way) {
            return number(*find(all, system, way), "ns");
        };
        const double gather = ns("floor", "one gather"), exact = ns("exact map", ""),
                     distance = ns("distance map", "");
        rows.push_back({set, shown(ns("floor", "stream")), shown(gather), shown(exact), shown(exact / gather),
                        shown(distance), shown(distance / gather)});
    }
    return markdown_table(rows);
}

/// How far a number may be trusted: the spread of the passes, in words.
std::string spread(const Results& results) {
    std::vector<double> spreads;
    for (const Records* records : {&results.contains, &results.contacts})
        for (const Records::Record& record : records->all()) spreads.push_back(number(record, "spread"));
    std::erase_if(spreads, [](double one_pass) { return std::isnan(one_pass); });
    std::ranges::sort(spreads);
    const auto percent_at = [&](double share) {
        return 100 * spreads[static_cast<std::size_t>(share * static_cast<double>(spreads.size() - 1))];
    };
    return fmt::format("{:.1f} % in the median, {:.1f} % for the worst tenth", percent_at(0.5),
                       percent_at(0.9));
}

} // namespace

void add_comparisons(const Results& results, Values& values) {
    values["floors"] = floors(results.contains);
    values["spread"] = spread(results);
    values["contains"] = tables(results.contains, "", false);
    values["contacts"] = tables(results.contacts, "", true);
    values["calls"] = calls(results);
    values["contains_10k"] = tables(results.contains, " 10k", false);
    values["contacts_10k"] = tables(results.contacts, " 10k", true);
}
