// The goals that were set for one core and horse_6k, as ratios within one run.

#include "page/page_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::array kSets{"U", "S", "C"};

std::vector<Records::Record> of(const Records& records, const std::string& mesh, const char* set) {
    return records.where({{"mesh", mesh}, {"set", set}});
}

double ns_of(const std::vector<Records::Record>& records, const std::string& system) {
    const Records::Record* found = find(records, system); // the first way is the widest vectors
    return found == nullptr ? std::nan("") : number(*found, "ns");
}

/// The best of all ways of a system.
double best_ns(const std::vector<Records::Record>& records, const std::string& system) {
    double best = std::numeric_limits<double>::infinity();
    for (const Records::Record& record : records)
        if (record.at("system") == system) best = std::min(best, number(record, "ns"));
    return best;
}

std::string with_verdict(const std::string& measured, bool met) {
    return measured + (met ? ", met" : ", **missed**");
}

/// "4.7 of 20, missed"
std::string with_goal(double measured, double goal, bool met) {
    return with_verdict(fmt::format("{} of {}", shown(measured), goal), met);
}

/// How many times faster ours is than another, which should be at least `goal`.
std::string faster(double ours, double other, double goal) {
    return with_goal(other / ours, goal, other / ours >= goal);
}

/// How many times as long ours takes as another, which should be at most `goal`.
std::string slower(double ours, double other, double goal) {
    if (std::isnan(other)) return "not measured";
    return with_goal(ours / other, goal, ours / other <= goal);
}

std::string first_mesh(const Records& records) {
    return records.all().front().at("mesh");
}

/// A row: one text for each set.
template <typename Cell>
void add_row(Rows& rows, const std::string& what, Cell cell) {
    rows.push_back({what});
    for (std::size_t i = 0; i < kSets.size(); ++i) rows.back().push_back(cell(i));
}

void add_ratios(const Results& results, Rows& rows) {
    const std::string mesh = first_mesh(results.contains);
    const auto contains = [&](std::size_t i) { return of(results.contains, mesh, kSets[i]); };
    const auto contacts = [&](std::size_t i) { return of(results.contacts, mesh, kSets[i]); };
    constexpr std::array kSign{20.0, 15.0, 15.0}, kContact{5.0, 8.0, 8.0}, kGrid{1.0, 4.5, 1.0};
    add_row(rows, "`ExactMap::contains_batch`: times faster than Embree's best sign", [&](std::size_t i) {
        return faster(ns_of(contains(i), "exact map"), best_ns(contains(i), "Embree"), kSign[i]);
    });
    add_row(rows, "the same: times as long as the dense grid of 0.63 MB", [&](std::size_t i) {
        return slower(ns_of(contains(i), "exact map"), ns_of(contains(i), "dense grid 0.63 MB"), kGrid[i]);
    });
    add_row(rows, "the same: times as long as the classified grid of equal bytes", [&](std::size_t i) {
        return slower(ns_of(contains(i), "exact map"), ns_of(contains(i), "classified grid"), 1);
    });
    add_row(rows, "`ExactMap::contacts_batch`: times faster than Embree's full contact", [&](std::size_t i) {
        return faster(ns_of(contacts(i), "exact map"), best_ns(contacts(i), "Embree"), kContact[i]);
    });
    add_row(rows, "the same: times as long as the classified grid of equal bytes", [&](std::size_t i) {
        return slower(ns_of(contacts(i), "exact map"), ns_of(contacts(i), "classified grid"), 1);
    });
    for (const char* map : {"distance map", "octahedral distance map"})
        add_row(rows,
                fmt::format("`DistanceMap::contacts_batch`, {}: times as long as a dense grid of equal bytes",
                            map),
                [&](std::size_t i) {
                    return slower(ns_of(contacts(i), map),
                                  ns_of(contacts(i), "dense grid as many bytes as the distance map"), 2.5);
                });
}

double build_ms(const Records& build, const std::string& mesh, const char* way, int threads,
                const char* clock, const char* system = "exact map") {
    for (const Records::Record& record : build.where({{"mesh", mesh},
                                                      {"system", system},
                                                      {"way", way},
                                                      {"threads", fmt::format("{}", threads)},
                                                      {"clock", clock}}))
        return number(record, "ms");
    return std::nan("");
}

void add_goal(Rows& rows, const std::string& what, const std::string& goal, double measured, double limit,
              bool at_most = true) {
    if (std::isnan(measured)) {
        rows.push_back({what, goal, "not measured"});
        return;
    }
    rows.push_back(
        {what, goal, with_verdict(shown(measured), at_most ? measured <= limit : measured >= limit)});
}

void add_cloth_goal(const Results& results, Rows& rows, const char* particles, double limit) {
    for (const Records::Record& record : results.cloth.where({{"map", "exact"}, {"particles", particles}}))
        add_goal(rows, fmt::format("cloth of {} particles, exact map, ms a frame", particles),
                 fmt::format("at most {}", limit), number(record, "ms"), limit);
}

} // namespace

void add_goals(const Results& results, Values& values) {
    Rows ratios{{"what", "U", "S", "C"}};
    add_ratios(results, ratios);
    values["ratio_goals"] = markdown_table(ratios);

    const std::string horse = first_mesh(results.contains);
    Rows rows{{"what", "goal", "measured"}};
    const std::vector<Records::Record> on_horse = of(results.contains, horse, "U");
    add_goal(rows, horse + ": bytes of the exact map, MB", "at most 0.30",
             number(*find(on_horse, "exact map"), "bytes") / 1e6, 0.30);
    add_goal(rows, horse + ": build, ms", "at most 3",
             build_ms(results.build, horse, "build", 1, "processor"), 3);
    const std::pair<const char*, double> larger[] = {{"armadillo_52k", 30}, {"torus_1M", 700}};
    for (const auto& [mesh, limit] : larger)
        add_goal(rows, std::string(mesh) + ": build, ms", fmt::format("at most {}", limit),
                 build_ms(results.build, mesh, "build", 1, "processor"), limit);
    for (const std::string& mesh : {horse, std::string("armadillo_52k"), std::string("torus_1M")})
        add_goal(rows, mesh + ": build / rebuild", "at least 1.5",
                 build_ms(results.build, mesh, "build", 1, "processor") /
                     build_ms(results.build, mesh, "rebuild", 1, "processor"),
                 1.5, false);
    for (const char* mesh : {"armadillo_52k", "torus_1M"}) {
        const auto gain = [&](const char* way, const char* system) {
            return build_ms(results.threads, mesh, way, 1, "wall", system) /
                   build_ms(results.threads, mesh, way, 2, "wall", system);
        };
        for (const char* way : {"build", "contains_batch on S", "contacts_batch on S"})
            add_goal(rows, fmt::format("{}: {}, one thread / two", mesh, way), "at least 1.7",
                     gain(way, "exact map"), 1.7, false);
        rows.push_back({"beside it, what the machine had to offer a second thread", "",
                        shown(gain("arithmetic alone", "the machine"))});
    }
    add_cloth_goal(results, rows, "10000", 3);
    add_cloth_goal(results, rows, "99856", 40);
    values["goals"] = markdown_table(rows);
}
