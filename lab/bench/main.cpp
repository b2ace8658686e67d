// Measures Echinus beside its rivals; scripts/bench runs it and lists the tasks.

#include "compare/turns.hpp"
#include "console/machine.hpp"
#include "console/progress.hpp"
#include "task.hpp"

#include <echinus/error.hpp>
#include <echinus/instruction_set.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <map>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

const std::map<std::string, Records (*)(const Setting&)> kTasks{
    {"contains", measure_contains},   {"contacts", measure_contacts}, {"bytes", measure_bytes},
    {"build", measure_build},         {"calls", measure_calls},       {"cloth", measure_cloth},
    {"figures", measure_figures},     {"record", measure_ratios},     {"reproduction", measure_reproduction},
    {"mechanics", measure_mechanics}, {"solvers", measure_solvers},   {"surfaces", measure_surfaces},
    {"triangles", measure_triangles},
};

struct Arguments {
    std::string task, instruction_set, commit;
    Setting setting;
    fs::path target, recorded;
    bool resumes = false;
};

/// The machine and the commit; of records that were resumed, those that the earlier ones are from, too.
std::vector<std::string> comments_of(const Arguments& arguments) {
    const std::string machine = describe_machine();
    if (!arguments.setting.earlier) return {machine, arguments.commit};
    std::vector<std::string> comments = arguments.setting.earlier->comments();
    const auto add = [](std::string& to, const std::string& text) {
        if (to.find(text) == std::string::npos) to += "; " + text;
    };
    add(comments.at(0), machine);
    add(comments.at(1), arguments.commit);
    return comments;
}

int run(Arguments& arguments) {
    Setting& setting = arguments.setting;
    StageBars progress;
    setting.report_progress = std::ref(progress);
    if (setting.is_short) {
        setting.point_count = 40'000;
        setting.effort = {.passes = 1, .enough_seconds = 0.3, .patience_seconds = 0.5};
    }
    if (!arguments.instruction_set.empty()) use_instruction_set(arguments.instruction_set);
    comparison::pin_to_one_core();
    if (arguments.task == "guard") return guard(setting, arguments.recorded);
    if (arguments.resumes && fs::exists(arguments.target)) setting.earlier = Records::read(arguments.target);
    const std::vector<std::string> comments = comments_of(arguments);
    setting.store = [&](const Records& records) { records.write(arguments.target, comments); };
    setting.store(kTasks.at(arguments.task)(setting));
    return 0;
}

} // namespace

int main(int argument_count, char** argument_values) {
    CLI::App app{"Measures Echinus beside its rivals"};
    Arguments arguments;
    Setting& setting = arguments.setting;
    std::vector<std::string> names{"guard"};
    for (const auto& [name, function] : kTasks) names.push_back(name);
    app.add_option("TASK", arguments.task)->required()->check(CLI::IsMember(names));
    app.add_option("--meshes", setting.meshes, "Folder of development meshes; need not exist")->required();
    app.add_option("--debian-horse", setting.debian_horse, "horse.3ds of glmark2-data")->required();
    app.add_option("--scenes", setting.scenes, "Folder of scenes")->required();
    app.add_option("--truth", setting.truth_cache, "Folder that keeps what the judge found")->required();
    app.add_flag("--short", setting.is_short, "Few particles, few passes: to see that all works");
    app.add_option("--instruction-set", arguments.instruction_set, "For ours, instead of the widest vectors");
    app.add_option("--recorded", arguments.recorded, "CSV file that the guard compares with");
    app.add_option("--commit", arguments.commit, "That is measured, and when: a comment of the CSV file");
    app.add_option("-o,--output", arguments.target, "CSV file");
    app.add_flag("--resume", arguments.resumes, "Task surfaces: keep the falls that the CSV file has");
    CLI11_PARSE(app, argument_count, argument_values);
    try {
        return run(arguments);
    } catch (const Error& error) {
        fmt::print(stderr, "echinus_bench: {}\n", error.what());
        return 1;
    }
}
