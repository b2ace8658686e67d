// Measures the exact map beside Embree and fills docs/exact_map_options.md; scripts/measure runs it.

#include "files/atomic_file.hpp"
#include "measurements.hpp"
#include "rivals/compare/machine.hpp"

#include <echinus/error.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

struct Section {
    const char* name;
    void (*measure)(const Setting&, Values&);
};

constexpr Section kSections[] = {
    {"divisions", measure_divisions}, {"centres", measure_centres},   {"faces", measure_face_counts},
    {"chords", measure_chords},       {"rebuilds", measure_rebuilds}, {"open", measure_open_surfaces},
};

struct Arguments {
    fs::path debian_horse;
    fs::path models; ///< need not exist
    fs::path page_template;
    fs::path target;
    fs::path images;
    std::string only;
    bool quick = false;
};

void run(const Arguments& arguments) {
    const Setting setting{.models = read_models(arguments.models, arguments.debian_horse),
                          .images = arguments.images,
                          .point_count = arguments.quick ? 20'000U : 1'000'000U,
                          .repetitions = arguments.quick ? 2 : 5,
                          .most_faces = arguments.quick ? 64'000U : 4'100'000U};
    Values values;
    values["machine"] = comparison::describe_machine();
    values["few_points"] = fmt::format("{}", setting.few_points());
    values["repetitions"] = fmt::format("{}", setting.repetitions);
    for (const Section& section : kSections) {
        if (!arguments.only.empty() && arguments.only != section.name) continue;
        fmt::print(stderr, "   {}\n", section.name);
        section.measure(setting, values);
    }
    if (arguments.only.empty()) {
        write_file(arguments.target, fill_page(arguments.page_template, values));
        return;
    }
    for (const auto& [name, value] : values) fmt::print("{}:\n{}\n\n", name, value);
}

} // namespace

int main(int argument_count, char** argument_values) {
    CLI::App app{"Measures the exact map and writes the page of figures"};
    Arguments arguments;
    app.add_option("--debian-horse", arguments.debian_horse, "horse.3ds of glmark2-data")->required();
    app.add_option("--models", arguments.models, "Folder of meshes; left out where absent");
    app.add_option("--template", arguments.page_template, "The page with its gaps")->required();
    app.add_option("--images", arguments.images, "Folder for the plots")->required();
    app.add_option("--only", arguments.only, "One section, to standard output, instead of the page")
        ->check(CLI::IsMember([] {
            std::vector<std::string> names;
            for (const Section& section : kSections) names.emplace_back(section.name);
            return names;
        }()));
    app.add_flag("--quick", arguments.quick, "Few points, few repetitions, small meshes");
    app.add_option("-o,--output", arguments.target, "The page")->required();
    CLI11_PARSE(app, argument_count, argument_values);
    try {
        run(arguments);
    } catch (const Error& error) {
        fmt::print(stderr, "echinus_bench_exact: {}\n", error.what());
        return 1;
    }
    return 0;
}
