// The program echinus-check: is a map of this mesh right about millions of points? Not installed, because its
// judge uses parts of CGAL that are under the GPL.

#include "choice.hpp"
#include "oracle/check_mesh.hpp"
#include "oracle/check_report.hpp"
#include "oracle/nasty_meshes.hpp"
#include "progress.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

using namespace echinus;

namespace {

constexpr int kFailed = 1;
constexpr int kWrongUse = 2;

enum class Rules : std::uint8_t { Nonzero, Parity, Both };

struct Arguments {
    std::filesystem::path mesh;
    std::string generate;
    bool json = false, list = false;
    Rules rules = Rules::Both;
    test::CheckOptions options;
};

std::vector<InsideRule> chosen_rules(Rules rules) {
    if (rules == Rules::Nonzero) return {InsideRule::Nonzero};
    if (rules == Rules::Parity) return {InsideRule::Parity};
    return {InsideRule::Nonzero, InsideRule::Parity};
}

void add_options(CLI::App& app, Arguments& arguments) {
    CLI::Option* mesh = app.add_option("MESH", arguments.mesh, "The mesh to check a map of");
    app.add_option("--generate", arguments.generate, "Check a generated mesh instead; --list names them")
        ->excludes(mesh);
    app.add_flag("--list", arguments.list, "Print the names of the generated meshes");
    app.add_option("--points", arguments.options.points, "How many points, a quarter of each kind")
        ->check(CLI::Range(std::size_t{16}, std::size_t{1} << 32U))
        ->capture_default_str();
    add_choice(app, "--rule", arguments.rules,
               {{"nonzero", Rules::Nonzero}, {"parity", Rules::Parity}, {"both", Rules::Both}},
               "Which places are inside");
    app.add_option("--cells", arguments.options.map.divisions, "Divisions of each octant; 0: the map chooses")
        ->check(CLI::Range(0U, ExactMapOptions::kMaxDivisions))
        ->capture_default_str();
    app.add_flag_callback(
        "--search-centre", [&] { arguments.options.map.centre = CentreChoice::Search; },
        "Let the map search for its centre");
    app.add_option("--seed", arguments.options.seed, "Of the random points")->capture_default_str();
    app.add_option("--threads", arguments.options.thread_count, "0: all cores")->capture_default_str();
    app.add_flag("--json", arguments.json, "Print one JSON object");
    app.footer("Exit status: 0 all answers hold, 1 some do not or an error, 2 wrong use.\n"
               "Example: echinus-check horse.obj --points 1000000");
}

/// The mesh and what to call it.
std::pair<std::string, TriangleMesh> mesh_of(const Arguments& arguments) {
    if (!arguments.generate.empty()) return {arguments.generate, test::make_nasty_mesh(arguments.generate)};
    if (arguments.mesh.empty()) throw CLI::RequiredError("A mesh, or --generate NAME,");
    return {arguments.mesh.stem().string(), read_mesh(arguments.mesh)};
}

test::CheckResult check(Arguments& arguments) {
    const auto [name, mesh] = mesh_of(arguments);
    ProgressBar bar(name);
    arguments.options.rules = chosen_rules(arguments.rules);
    arguments.options.report_progress = [&](double fraction) { bar(fraction); };
    return check_mesh(name, mesh, arguments.options);
}

int run(int argc, char** argv) {
    CLI::App app{"Judges an exact map by CGAL's exact predicates, particle by particle."};
    app.name("echinus-check");
    Arguments arguments;
    add_options(app, arguments);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    }
    if (arguments.list) {
        for (const std::string& name : test::nasty_mesh_names()) fmt::print("{}\n", name);
        return 0;
    }
    const test::CheckResult result = check(arguments);
    fmt::print("{}", arguments.json ? to_json(result) : to_text(result));
    return result.holds() ? 0 : kFailed;
}

int fail(const char* sentence, int status) {
    fmt::print(stderr, "echinus-check: {}\n", sentence);
    return status;
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const CLI::ParseError& error) {
        return fail((std::string(error.what()) + "; see echinus-check --help").c_str(), kWrongUse);
    } catch (const Error& error) {
        return fail(error.what(), error.code() == ErrorCode::InvalidOptions ? kWrongUse : kFailed);
    } catch (const std::exception& error) {
        return fail(error.what(), kFailed);
    }
}
