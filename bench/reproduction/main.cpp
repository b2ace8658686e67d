// Measures the paper's map on the paper's models and fills docs/reproduction.md; scripts/reproduce runs it.

#include "depths.hpp"
#include "files/atomic_file.hpp"
#include "rivals.hpp"
#include "rivals/compare/machine.hpp"
#include "signs.hpp"
#include "simulations.hpp"
#include "sizes.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <span>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

struct Arguments {
    fs::path debian_horse;
    fs::path development_horse; ///< need not exist
    fs::path simulations;
    fs::path page_template;
    fs::path target;
    std::size_t side_count = 1000;
};

void report_progress(const std::string& what) {
    fmt::print(stderr, "   {}\n", what);
}

std::vector<Subject> read_subjects(const Arguments& arguments) {
    std::vector<Subject> subjects;
    if (fs::exists(arguments.development_horse)) {
        report_progress("judging points around horse_6k");
        subjects.emplace_back(
            "horse_6k", "a standing horse of 6000 faces, the Cyberware horse simplified; z is up",
            read_mesh(arguments.development_horse), comparison::Axis::Z, arguments.side_count);
    }
    report_progress("judging points around Debian's horse");
    subjects.emplace_back("horse", "Debian's `glmark2-data`, doubled patches dropped; y is up",
                          repair(read_mesh(arguments.debian_horse), RepairOptions::all()).mesh,
                          comparison::Axis::Y, arguments.side_count);
    report_progress("judging points around the torus");
    subjects.emplace_back("torus", "60 x 24 segments, radii 1 and 0.4, about the z axis",
                          make_torus(1, 0.4, 60, 24), comparison::Axis::Z, arguments.side_count);
    return subjects;
}

std::string table_of_subjects(std::span<const Subject> subjects) {
    std::vector<std::vector<std::string>> rows{{"model", "from", "faces", "R", "inside: U", "S", "C"}};
    for (const Subject& subject : subjects) {
        rows.push_back({subject.name, subject.origin, fmt::format("{}", subject.mesh.faces.size()),
                        fmt::format("{:.4f}", subject.radius)});
        for (const JudgedPoints& set : subject.sets) {
            const auto inside = static_cast<double>(std::ranges::count(set.inside, 1));
            rows.back().push_back(
                fmt::format("{:.1f} %", 100 * inside / static_cast<double>(set.inside.size())));
        }
    }
    return markdown_table(rows);
}

/// The same section for each subject, one after the other.
std::string sections(std::span<const Subject> subjects, const Values& values, const std::string& table) {
    std::string text;
    for (const Subject& subject : subjects)
        text += fmt::format("{}**{}**\n\n{}", text.empty() ? "" : "\n\n", subject.name,
                            values.at(subject.name + "." + table));
    return text;
}

void run(const Arguments& arguments) {
    Values values;
    values["machine"] = comparison::describe_machine();
    values["side"] = fmt::format("{0} x {0}", arguments.side_count);
    read_simulations(arguments.simulations, values);
    const std::vector<Subject> subjects = read_subjects(arguments);
    values["models"] = table_of_subjects(subjects);
    for (const Subject& subject : subjects) {
        report_progress("sizes and signs of " + subject.name);
        measure_sizes(subject, values);
        measure_signs(subject, values);
    }
    for (const char* table : {"sizes", "signs.short", "signs.all", "few"})
        values[table] = sections(subjects, values, table);
    report_progress("superquadric maps and distance fields");
    measure_rivals(subjects, values);
    report_progress("depths and shapes");
    measure_smoothing(subjects, values);
    measure_torus_shapes(values);
    measure_depths(subjects, values);

    write_file(arguments.target, fill_page(arguments.page_template, values));
}

} // namespace

int main(int argument_count, char** argument_values) {
    CLI::App app{"Measures the paper's map and writes the page of figures"};
    Arguments arguments;
    app.add_option("--debian-horse", arguments.debian_horse, "horse.3ds of glmark2-data")->required();
    app.add_option("--development-horse", arguments.development_horse, "horse_6k.obj; left out where absent");
    app.add_option("--simulations", arguments.simulations, "Folder with the reports of both scenes")
        ->required();
    app.add_option("--template", arguments.page_template, "The page with its gaps")->required();
    app.add_option("--side", arguments.side_count, "Points per set are this number squared")
        ->capture_default_str();
    app.add_option("-o,--output", arguments.target, "The page")->required();
    CLI11_PARSE(app, argument_count, argument_values);
    try {
        run(arguments);
    } catch (const Error& error) {
        fmt::print(stderr, "echinus_reproduction: {}\n", error.what());
        return 1;
    }
    return 0;
}
