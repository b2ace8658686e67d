// The program echinus-shapes: checks shapes of a range of seeds and keeps what it found in a report, from
// which it goes on when it is started again. scripts/bench shapes runs it. Not installed.

#include "console/machine.hpp"
#include "property/shape_checks.hpp"
#include "property/shape_parts.hpp"
#include "records.hpp"

#include <echinus/error.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

using namespace echinus;
using namespace echinus::test;
namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kPortion = 500; ///< seeds of one line of a report, at most
constexpr std::size_t kMostSeeds = 50;  ///< of failures, in a line of a merged report

const std::map<std::string, ShapeCheck> kChecks{
    {"sides", check_sides}, {"queries", check_queries}, {"tetrahedra", check_tetrahedra}};

struct Arguments {
    std::string checks = "sides", commit;
    std::uint64_t first = 1, count = 10'000;
    fs::path report;
    std::vector<fs::path> merged;
    std::uint64_t shown = 0;
    bool shows = false;
};

Records empty_report() {
    return Records({"checks", "first seed", "shapes", "faces", "left out", "wrong", "unreadable", "answers",
                    "wrong answers", "worst distance", "worst volume", "failing seeds"});
}

Records::Record record_of(const std::string& checks, std::uint64_t first, const ShapeFindings& findings) {
    std::string seeds;
    for (std::size_t i = 0; i < std::min(findings.failures.size(), kMostSeeds); ++i)
        seeds += (i == 0 ? "" : " ") + std::to_string(findings.failures[i].seed);
    return {{"checks", checks},
            {"first seed", std::to_string(first)},
            {"shapes", std::to_string(findings.shapes)},
            {"faces", std::to_string(findings.faces)},
            {"left out", std::to_string(findings.left_out)},
            {"wrong", std::to_string(findings.wrong)},
            {"unreadable", std::to_string(findings.unreadable)},
            {"answers", std::to_string(findings.answers)},
            {"wrong answers", std::to_string(findings.wrong_answers)},
            {"worst distance", fmt::format("{:.3g}", findings.worst_distance)},
            {"worst volume", fmt::format("{:.3g}", findings.worst_volume)},
            {"failing seeds", seeds}};
}

ShapeFindings findings_of(const Records::Record& record) {
    const auto count = [&](const char* column) { return static_cast<std::size_t>(number(record, column)); };
    ShapeFindings findings;
    findings.shapes = count("shapes");
    findings.faces = count("faces");
    findings.left_out = count("left out");
    findings.wrong = count("wrong");
    findings.unreadable = count("unreadable");
    findings.answers = count("answers");
    findings.wrong_answers = count("wrong answers");
    findings.worst_distance = number(record, "worst distance");
    findings.worst_volume = number(record, "worst volume");
    std::istringstream seeds(record.at("failing seeds"));
    for (std::uint64_t seed = 0; seeds >> seed;) findings.failures.push_back({seed, {}, {}});
    return findings;
}

std::uint64_t first_seed(const Records::Record& record) {
    return std::stoull(record.at("first seed"));
}

/// The findings of an earlier run with the same commit; those of another one would not be true of this one.
Records earlier_report(const Arguments& arguments, const std::vector<std::string>& comments) {
    if (!fs::exists(arguments.report)) return empty_report();
    Records report = Records::read(arguments.report);
    if (report.comments() != comments)
        throw Error(ErrorCode::InvalidOptions,
                    arguments.report.string() +
                        ": was written by another commit or on another machine; remove it, or "
                        "name another --report");
    return report;
}

int check(const Arguments& arguments) {
    const std::vector<std::string> comments{describe_machine(), arguments.commit};
    Records report = earlier_report(arguments, comments);
    std::set<std::uint64_t> finished;
    for (const Records::Record& record : report.all())
        if (record.at("checks") == arguments.checks) finished.insert(first_seed(record));
    const std::uint64_t end = arguments.first + arguments.count;
    std::size_t failure_count = 0;
    for (std::uint64_t first = arguments.first; first < end; first += kPortion) {
        if (finished.contains(first)) continue;
        ShapeFindings findings;
        for (std::uint64_t seed = first; seed < std::min(first + kPortion, end); ++seed)
            kChecks.at(arguments.checks)(make_shape(seed).mesh, seed, findings);
        for (const ShapeFindings::Failure& failure : findings.failures)
            fmt::print("seed {}: {}\n", failure.seed, failure.what);
        std::fflush(stdout);
        failure_count += findings.failures.size();
        report.add(record_of(arguments.checks, first, findings));
        report.write(arguments.report, comments);
    }
    return failure_count == 0 ? 0 : 1;
}

/// One line for each kind of check; portions that two reports have count once.
void merge(const Arguments& arguments) {
    std::set<std::pair<std::string, std::uint64_t>> merged;
    std::map<std::string, std::pair<std::uint64_t, ShapeFindings>> totals;
    std::vector<std::string> comments;
    for (const fs::path& path : arguments.merged) {
        const Records report = Records::read(path);
        for (const std::string& comment : report.comments())
            if (std::ranges::find(comments, comment) == comments.end()) comments.push_back(comment);
        for (const Records::Record& record : report.all()) {
            const std::uint64_t first = first_seed(record);
            if (!merged.emplace(record.at("checks"), first).second) continue;
            const auto place = totals.try_emplace(record.at("checks"), first, ShapeFindings{}).first;
            place->second.first = std::min(place->second.first, first);
            place->second.second.add(findings_of(record));
        }
    }
    Records report = empty_report();
    for (const auto& [checks, total] : totals) report.add(record_of(checks, total.first, total.second));
    report.write(arguments.report, comments);
}

/// A shape, what is wrong with it, and a smaller one that fails as well.
void show(const Arguments& arguments) {
    const ShapeCheck check = kChecks.at(arguments.checks);
    const Shape shape = make_shape(arguments.shown);
    ShapeFindings findings;
    check(shape.mesh, shape.seed, findings);
    fmt::print("# {}\n", shape.recipe);
    if (!findings.failures.empty())
        fmt::print("# {}: {}\n# shrunk:\n{}", arguments.checks, findings.failures.front().what,
                   obj_text(shrunk(shape.mesh, findings.failures.front(), check)));
    else
        fmt::print("# {}: nothing is wrong\n{}", arguments.checks, obj_text(shape.mesh));
}

int run(const Arguments& arguments) {
    if (arguments.shows) {
        show(arguments);
        return 0;
    }
    if (arguments.merged.empty()) return check(arguments);
    merge(arguments);
    return 0;
}

} // namespace

int main(int argument_count, char** argument_values) {
    CLI::App app{"Checks maps of shapes that designers make by brute force. Exit status: 1 if one is wrong"};
    Arguments arguments;
    std::vector<std::string> names;
    for (const auto& [name, function] : kChecks) names.push_back(name);
    app.add_option("--checks", arguments.checks, "sides, queries or tetrahedra")->check(CLI::IsMember(names));
    app.add_option("--first", arguments.first, "First seed");
    app.add_option("--count", arguments.count, "How many shapes");
    app.add_option("--commit", arguments.commit, "That is checked: a comment of the report");
    const auto* report = app.add_option(
        "--report", arguments.report,
        "CSV file; a run that was stopped goes on from it. Runs at the same time take one each");
    app.add_option("--merge", arguments.merged, "Write the sums of these reports to --report instead")
        ->needs("--report");
    const auto* show_option = app.add_option(
        "--show", arguments.shown, "Print the shape of this seed instead, and what is wrong with it");
    CLI11_PARSE(app, argument_count, argument_values);
    arguments.shows = show_option->count() > 0;
    try {
        if (!arguments.shows && report->count() == 0)
            throw Error(ErrorCode::InvalidOptions, "--report or --show is needed");
        return run(arguments);
    } catch (const Error& error) {
        fmt::print(stderr, "echinus-shapes: {}\n", error.what());
        return 2;
    }
}
