// Compares all systems on six meshes at equal bytes and fills docs/choosing.md; scripts/choosing runs it.

#include "common/page.hpp"
#include "files/atomic_file.hpp"
#include "models.hpp"
#include "progress.hpp"
#include "rivals/compare/curve_plots.hpp"
#include "rivals/compare/machine.hpp"
#include "tables.hpp"
#include "verdict.hpp"

#include <echinus/error.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

using namespace echinus;
using namespace echinus::comparison;
namespace fs = std::filesystem;

namespace {

struct Arguments {
    fs::path meshes, page_template, images, target;
    std::size_t point_count = 100'000;
};

constexpr const char* kPlotFiles[] = {"choosing_sides_bytes.svg", "choosing_depths_bytes.svg",
                                      "choosing_sides_time.svg", "choosing_contacts_time.svg"};

void compare_all(std::vector<Model>& models, const Arguments& arguments) {
    StageBars bars;
    for (Model& model : models) {
        CompareOptions options;
        options.point_count = arguments.point_count;
        options.up = model.up;
        if (&model == &models.front()) options.curve_length = 8;
        options.report_progress = [&](const std::string& what, double fraction) {
            bars(model.name + ", " + what, fraction);
        };
        model.result = compare(model.mesh, options);
    }
}

void run(const Arguments& arguments) {
    std::vector<Model> models = read_models(arguments.meshes);
    compare_all(models, arguments);
    const std::size_t budget = CompareOptions{}.byte_budget;
    write_file(arguments.images / "equal_bytes.svg", verdict_figure(models, budget));
    const std::vector<Plot> plots = curve_plots(models.front().result);
    for (std::size_t k = 0; k < plots.size(); ++k)
        write_file(arguments.images / kPlotFiles[k], svg(plots[k]));
    write_file(arguments.target,
               fill_page(arguments.page_template, {{"machine", describe_machine()},
                                                   {"points", fmt::format("{}", arguments.point_count)},
                                                   {"tables", tables_of(models)}}));
}

} // namespace

int main(int argument_count, char** argument_values) {
    CLI::App app{"Compares all systems on six meshes and writes the page on which to choose"};
    Arguments arguments;
    app.add_option("--meshes", arguments.meshes, "Folder of development meshes")->required();
    app.add_option("--points", arguments.point_count, "Particles in a set")->capture_default_str();
    app.add_option("--template", arguments.page_template, "The page with its gaps")->required();
    app.add_option("--images", arguments.images, "Folder for the figures")->required();
    app.add_option("-o,--output", arguments.target, "The page")->required();
    CLI11_PARSE(app, argument_count, argument_values);
    try {
        run(arguments);
    } catch (const Error& error) {
        fmt::print(stderr, "echinus_choosing: {}\n", error.what());
        return 1;
    }
    return 0;
}
