// The same cloth on each system: runs a scene with every system of rivals/systems/ as the collider and writes
// the tables of docs/cloth_on_each.md; or draws how the runs ended.
//
//   echinus_cloth_on_each run scenes/horse.json models/horse.3ds -o out/cloth_on_each
//   echinus_cloth_on_each draw scenes/horse.json models/horse.3ds out/cloth_on_each -o sheet.png

#include "contestants.hpp"
#include "page.hpp"
#include "race.hpp"
#include "rivals/compare/clock.hpp"
#include "rivals/compare/machine.hpp"
#include "sheet.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <fstream>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

struct Arguments {
    fs::path scene, model, target, runs;
    RaceOptions race;
    SheetOptions sheet;
};

struct Subject {
    Scene scene;
    TriangleMesh mesh;
};

Subject read_subject(const Arguments& arguments) {
    Subject subject{read_scene(arguments.scene), {}};
    subject.mesh = repair(read_mesh(arguments.model), subject.scene.repair).mesh;
    return subject;
}

std::string in_radii(double depth) {
    return depth == 0 ? "0" : fmt::format("{:.5f}", depth);
}

std::string in_percent(std::uint64_t part, std::uint64_t whole) {
    return whole == 0
               ? "none"
               : fmt::format("{:.2f} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string end_of(const Contestant& contestant, const Outcome& outcome) {
    if (outcome.rested) return fmt::format("{}", outcome.frames);
    return contestant.only_timed ? fmt::format("stopped at {}", outcome.frames) : "not yet";
}

std::string table_of_runs(const std::vector<Contestant>& contestants, const std::vector<Outcome>& outcomes) {
    std::vector<std::vector<std::string>> rows{{"collider", "MB", "frame, ms", "frames to rest",
                                                "inside at the end", "deepest at the end, R",
                                                "deepest ever, R"}};
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        const Contestant& contestant = contestants[i];
        const Outcome& outcome = outcomes[i];
        rows.push_back({fmt::format("{}: {}", contestant.label, contestant.setting),
                        fmt::format("{:.2f}", static_cast<double>(contestant.bytes) / 1e6),
                        fmt::format("{:.1f}", outcome.frame_ms), end_of(contestant, outcome),
                        fmt::format("{}", outcome.inside_at_end), in_radii(outcome.deepest_at_end),
                        in_radii(outcome.deepest)});
    }
    return markdown_table(rows);
}

std::string table_of_pushes(const std::vector<Contestant>& contestants,
                            const std::vector<Outcome>& outcomes) {
    std::vector<std::vector<std::string>> rows{
        {"collider", "found inside", "pushed by more than twice the depth", "no way out"}};
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        const PushCounts& pushes = outcomes[i].pushes;
        rows.push_back({contestants[i].label, fmt::format("{}", pushes.inside),
                        in_percent(pushes.too_far, pushes.inside),
                        in_percent(pushes.no_way_out, pushes.inside)});
    }
    return markdown_table(rows);
}

void write_text(const fs::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    if (!file.flush()) throw Error(ErrorCode::Unwritable, path.string() + ": cannot be written");
}

/// So that a picture can be drawn anew without minutes of simulation: a mesh for each that ran to its end,
/// and what they are.
void write_runs(const fs::path& folder, const std::vector<Triangle>& faces,
                const std::vector<Contestant>& contestants, const std::vector<Outcome>& outcomes) {
    std::string list;
    std::size_t count = 0;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        if (contestants[i].only_timed) continue;
        const Outcome& outcome = outcomes[i];
        write_mesh(folder / fmt::format("{}.ply", count++), {outcome.positions, faces});
        list +=
            fmt::format("{}\n{} {}, {} inside\n", contestants[i].label,
                        outcome.rested ? "rest in frame" : "frame", outcome.frames, outcome.inside_at_end);
    }
    write_text(folder / "runs.txt", list);
}

void run(Arguments& arguments) {
    const Subject subject = read_subject(arguments);
    fs::create_directories(arguments.target);
    const std::vector<Contestant> contestants =
        build_contestants(subject.mesh, subject.scene.simulation.thickness);
    const std::vector<Triangle> faces = make_cloth(subject.scene.cloth).faces;
    arguments.race.report = [&](const std::vector<Outcome>& outcomes) {
        fmt::print(stderr, "frame {}\n", outcomes.front().frames);
        write_runs(arguments.target, faces, contestants, outcomes);
        write_text(arguments.target / "table.md", table_of_runs(contestants, outcomes) + '\n');
        write_text(arguments.target / "pushes.md", table_of_pushes(contestants, outcomes) + '\n');
    };
    race(subject.scene, subject.mesh, contestants, arguments.race);
    write_text(arguments.target / "machine.md", comparison::describe_machine() + '\n');
}

void draw(const Arguments& arguments) {
    const Subject subject = read_subject(arguments);
    std::ifstream list(arguments.runs / "runs.txt");
    if (!list) throw Error(ErrorCode::Unreadable, arguments.runs.string() + "/runs.txt: cannot be read");
    std::vector<FinalCloth> cloths;
    for (FinalCloth cloth; std::getline(list, cloth.label) && std::getline(list, cloth.caption);) {
        cloth.mesh = read_mesh(arguments.runs / fmt::format("{}.ply", cloths.size()));
        cloths.push_back(cloth);
    }
    const Vec3d& gravity = subject.scene.simulation.gravity;
    SheetOptions options = arguments.sheet;
    options.view.up = gravity * -1.0;
    write_png(arguments.target, draw_sheet(subject.mesh, cloths, options));
}

} // namespace

int main(int argument_count, char** argument_values) {
    CLI::App app{"The same cloth on each system"};
    app.require_subcommand(1);
    Arguments arguments;
    CLI::App& runs = *app.add_subcommand("run", "Runs the scene with each system, and judges");
    CLI::App& draws = *app.add_subcommand("draw", "Draws how the runs ended");
    for (CLI::App* command : {&runs, &draws}) {
        command->add_option("SCENE", arguments.scene)->required();
        command->add_option("MODEL", arguments.model, "Mesh file of the scene's model")->required();
        command->add_option("-o,--output", arguments.target, "Folder, or picture")->required();
    }
    runs.add_option("--frames", arguments.race.frame_limit, "Runs end here at the latest")
        ->capture_default_str();
    runs.add_option("--judged-step", arguments.race.judged_step,
                    "Pushes are judged in every so manieth frame")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    draws.add_option("RUNS", arguments.runs, "Folder that run wrote")->required();
    draws.add_option("--azimuth", arguments.sheet.view.azimuth_deg)->capture_default_str();
    draws.add_option("--elevation", arguments.sheet.view.elevation_deg)->capture_default_str();
    draws.add_option("--columns", arguments.sheet.column_count)->capture_default_str();
    draws.add_option("--samples", arguments.sheet.samples)->capture_default_str();
    CLI11_PARSE(app, argument_count, argument_values);
    try {
        if (runs.parsed())
            run(arguments);
        else
            draw(arguments);
    } catch (const Error& error) {
        fmt::print(stderr, "echinus_cloth_on_each: {}\n", error.what());
        return 1;
    }
    return 0;
}
