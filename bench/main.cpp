// Measures Echinus beside its rivals; scripts/bench runs it.

#include "common/pinning.hpp"
#include "files/atomic_file.hpp"
#include "guard/guard.hpp"
#include "measurements.hpp"
#include "page/page_parts.hpp"
#include "progress.hpp"
#include "rivals/compare/machine.hpp"

#include <echinus/error.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <map>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

const std::map<std::string, Records (*)(const Setting&)> kTasks{
    {"contains", measure_contains}, {"contacts", measure_contacts}, {"bytes", measure_bytes},
    {"build", measure_build},       {"cloth", measure_cloth},       {"threads", measure_threads},
};

struct Arguments {
    std::string task;
    fs::path meshes, debian_horse, scenes, truth_cache, target;
    bool short_run = false;
    fs::path results, page_template, optimisations, images;
    fs::path recorded;
    bool record = false;
};

Setting setting_of(const Arguments& arguments, StageBars& progress) {
    return {.meshes = arguments.meshes,
            .debian_horse = arguments.debian_horse,
            .scenes = arguments.scenes,
            .truth_cache = arguments.truth_cache,
            .effort = {},
            .report_progress = std::ref(progress)};
}

void measure(const Arguments& arguments) {
    StageBars progress;
    Setting setting = setting_of(arguments, progress);
    if (arguments.short_run)
        setting.effort = {.point_count = 40'000,
                          .large_point_count = 0,
                          .passes = 3,
                          .patience_seconds = 0.05,
                          .enough_seconds = 0.3};
    if (arguments.task != "threads") pin_to_one_core();
    kTasks.at(arguments.task)(setting).write(
        arguments.target, {comparison::describe_machine(), fmt::format("{} passes", setting.effort.passes)});
}

std::string read_text(const fs::path& path) {
    Values none;
    return fill_page(path, none);
}

void write_page(const Arguments& arguments) {
    const Results results = read_results(arguments.results);
    Values values;
    values["machine"] = results.contains.comments().front();
    values["passes"] = results.contains.comments().at(1);
    values["optimisations"] = read_text(arguments.optimisations);
    add_comparisons(results, values);
    add_goals(results, values);
    add_builds(results, values);
    add_cloth(results, values);
    add_losses(results, values);
    write_plots(results, arguments.images);
    write_file(arguments.target, fill_page(arguments.page_template, values));
}

void print_all(const char* head, const std::vector<std::string>& sentences) {
    if (!sentences.empty()) fmt::print("{}\n", head);
    for (const std::string& sentence : sentences) fmt::print("  {}\n", sentence);
}

Records measure_guard(const Arguments& arguments) {
    StageBars progress;
    Setting setting = setting_of(arguments, progress);
    pin_to_one_core();
    return measure_ratios(setting);
}

/// What both runs found: one alone may have met a bad moment of the machine.
std::vector<std::string> slower_again(const GuardVerdict& first, const GuardVerdict& second) {
    std::vector<std::string> both;
    for (const std::string& sentence : second.slower)
        for (const std::string& other : first.slower)
            if (other.substr(0, other.find(':')) == sentence.substr(0, sentence.find(':')))
                both.push_back(sentence);
    return both;
}

/// @returns the exit status
int guard(const Arguments& arguments) {
    Records measured = measure_guard(arguments);
    if (arguments.record) {
        measured.write(arguments.recorded, {comparison::describe_machine()});
        fmt::print("Recorded in {}.\n", arguments.recorded.string());
        return 0;
    }
    const Records recorded = Records::read(arguments.recorded);
    if (recorded.comments().front() != comparison::describe_machine())
        fmt::print(
            "Recorded on another machine: {}. Ratios depend on the processor; record anew to be sure.\n",
            recorded.comments().front());
    GuardVerdict verdict = compare_ratios(recorded, measured);
    if (!verdict.slower.empty()) {
        fmt::print("Something seems slower; measuring again.\n");
        verdict.slower = slower_again(verdict, compare_ratios(recorded, measure_guard(arguments)));
    }
    print_all("Not compared:", verdict.unknown);
    print_all("Faster than recorded:", verdict.faster);
    print_all("SLOWER than recorded:", verdict.slower);
    if (verdict.slower.empty()) fmt::print("Nothing got slower.\n");
    return verdict.slower.empty() ? 0 : 1;
}

void add_inputs(CLI::App& command, Arguments& arguments) {
    command.add_option("--meshes", arguments.meshes, "Folder of development meshes; need not exist")
        ->required();
    command.add_option("--debian-horse", arguments.debian_horse, "horse.3ds of glmark2-data")->required();
}

} // namespace

int main(int argument_count, char** argument_values) {
    CLI::App app{"Measures Echinus beside its rivals"};
    app.require_subcommand(1);
    Arguments arguments;
    CLI::App* const task = app.add_subcommand("measure", "Measures one task and writes its records");
    std::vector<std::string> names;
    for (const auto& [name, function] : kTasks) names.push_back(name);
    task->add_option("task", arguments.task)->required()->check(CLI::IsMember(names));
    add_inputs(*task, arguments);
    task->add_option("--scenes", arguments.scenes, "Folder of scenes")->required();
    task->add_option("--truth", arguments.truth_cache, "Folder that keeps what the judge found")->required();
    task->add_flag("--short", arguments.short_run, "Few particles, few passes: to try the program");
    task->add_option("-o,--output", arguments.target, "CSV file")->required();

    CLI::App* const page = app.add_subcommand("page", "Writes the page and its plots from the records");
    page->add_option("--results", arguments.results, "Folder of the CSV files")->required();
    page->add_option("--template", arguments.page_template, "The page with its gaps")->required();
    page->add_option("--optimisations", arguments.optimisations,
                     "The part of the page that is written by hand")
        ->required();
    page->add_option("--images", arguments.images, "Folder for the plots")->required();
    page->add_option("-o,--output", arguments.target, "The page")->required();

    CLI::App* const quick = app.add_subcommand("guard", "Tells what got slower since it was recorded");
    add_inputs(*quick, arguments);
    quick->add_option("--recorded", arguments.recorded, "CSV file")->required();
    quick->add_flag("--record", arguments.record, "Write that file instead of comparing with it");
    CLI11_PARSE(app, argument_count, argument_values);
    try {
        if (*task) measure(arguments);
        if (*page) write_page(arguments);
        if (*quick) return guard(arguments);
    } catch (const Error& error) {
        fmt::print(stderr, "echinus_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
