// Measures Echinus beside its rivals; scripts/bench runs it.

#include "common/machine.hpp"
#include "common/pinning.hpp"
#include "measurements.hpp"
#include "progress.hpp"

#include <echinus/error.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <map>
#include <optional>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

const std::map<std::string, Records (*)(const Setting&)> kTasks{
    {"contains", measure_contains}, {"contacts", measure_contacts}, {"bytes", measure_bytes},
    {"build", measure_build},       {"cloth", measure_cloth},
};

/// A bar for one piece of work after the other.
class Progress {
  public:
    void operator()(const std::string& what, double fraction) {
        if (what != what_) {
            what_ = what;
            bar_.reset();
            bar_.emplace(what);
        }
        (*bar_)(fraction);
    }

  private:
    std::string what_;
    std::optional<ProgressBar> bar_;
};

struct Arguments {
    std::string task;
    fs::path meshes, debian_horse, scenes, truth_cache, target;
    bool short_run = false;
};

void measure(const Arguments& arguments) {
    Progress progress;
    Setting setting{.meshes = arguments.meshes,
                    .debian_horse = arguments.debian_horse,
                    .scenes = arguments.scenes,
                    .truth_cache = arguments.truth_cache,
                    .effort = {},
                    .report_progress = std::ref(progress)};
    if (arguments.short_run)
        setting.effort = {.point_count = 40'000, .large_point_count = 20'000, .passes = 3};
    pin_to_one_core();
    kTasks.at(arguments.task)(setting).write(arguments.target, {describe_machine()});
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
    task->add_option("--meshes", arguments.meshes, "Folder of development meshes; need not exist")
        ->required();
    task->add_option("--debian-horse", arguments.debian_horse, "horse.3ds of glmark2-data")->required();
    task->add_option("--scenes", arguments.scenes, "Folder of scenes")->required();
    task->add_option("--truth", arguments.truth_cache, "Folder that keeps what the judge found")->required();
    task->add_flag("--short", arguments.short_run, "Few particles, few passes: to try the program");
    task->add_option("-o,--output", arguments.target, "CSV file")->required();
    CLI11_PARSE(app, argument_count, argument_values);
    try {
        if (*task) measure(arguments);
    } catch (const Error& error) {
        fmt::print(stderr, "echinus_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
