// The program echinus-check: is a map of this mesh right at millions of points, and does a recorded cloth
// meet anything? Not installed, because its judge uses parts of CGAL that are under the GPL.

#include "console/options.hpp"
#include "console/progress.hpp"
#include "judges/check_cloth.hpp"
#include "judges/check_mesh.hpp"
#include "judges/nasty_meshes.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

using namespace echinus;

namespace {

constexpr int kFailed = 1;
constexpr int kWrongUse = 2;

enum class Rules : std::uint8_t { Nonzero, Parity, Both };

struct Arguments {
    std::filesystem::path mesh, cloth;
    std::string generate;
    bool json = false, list = false, search_centre = false;
    Rules rules = Rules::Both;
    test::CheckOptions options;
    test::ClothCheckOptions cloth_options;
};

std::vector<InsideRule> chosen_rules(Rules rules) {
    if (rules == Rules::Nonzero) return {InsideRule::Nonzero};
    if (rules == Rules::Parity) return {InsideRule::Parity};
    return {InsideRule::Nonzero, InsideRule::Parity};
}

void add_options(Command command, Arguments& arguments) {
    command.add("MESH", &arguments.mesh, "The mesh to check a map of");
    command.add("--generate", &arguments.generate, "Check a generated mesh instead; --list names them")
        .excludes("MESH");
    command.add_flag("--list", arguments.list, "Print the names of the generated meshes");
    command
        .add("--cloth", &arguments.cloth,
             "Check the recording that echinus simulate wrote to this folder instead: which faces of the "
             "cloth "
             "intersect the model or each other")
        .excludes("MESH")
        .excludes("--generate")
        .type_name("DIR");
    command.add("--every", &arguments.cloth_options.stride, "Of a recording, judge every so many frames")
        .range(1, 1'000'000'000)
        .show_default();
    command.add("--points", &arguments.options.points, "How many points, a quarter of each kind")
        .range(16, std::uint64_t{1} << 32U)
        .show_default();
    add_choice(command, "--rule", arguments.rules,
               {{"nonzero", Rules::Nonzero}, {"parity", Rules::Parity}, {"both", Rules::Both}},
               "Which places are inside");
    command.add("--cells", &arguments.options.map.divisions, "Divisions of each octant; 0: the map chooses")
        .range(0, ExactMapOptions::kMaxDivisions)
        .show_default();
    command.add_flag("--search-centre", arguments.search_centre, "Let the map search for its centre");
    command.add("--seed", &arguments.options.seed, "Of the random points").show_default();
    command.add("--threads", &arguments.options.thread_count, "0: all cores").show_default();
    command.add_flag("--json", arguments.json, "Print one JSON object");
    command.footer("Exit status: 0 all holds, 1 something does not or an error, 2 usage error.\n"
                   "Examples:\n  echinus-check horse.obj --points 1000000\n"
                   "  echinus-check --cloth out/horse --every 10");
}

/// The mesh and its name.
std::pair<std::string, TriangleMesh> mesh_of(const Arguments& arguments) {
    if (!arguments.generate.empty()) return {arguments.generate, test::make_nasty_mesh(arguments.generate)};
    if (arguments.mesh.empty()) throw WrongUse("A mesh, or --generate NAME, is required");
    return {arguments.mesh.stem().string(), read_mesh(arguments.mesh)};
}

test::CheckResult check(Arguments& arguments) {
    const auto [name, mesh] = mesh_of(arguments);
    ProgressBar bar(name);
    arguments.options.rules = chosen_rules(arguments.rules);
    if (arguments.search_centre) arguments.options.map.centre = CentreChoice::Search;
    arguments.options.report_progress = [&](double fraction) { bar(fraction); };
    return check_mesh(name, mesh, arguments.options);
}

test::ClothCheckResult check_recording(Arguments& arguments) {
    ProgressBar bar(arguments.cloth.filename().string());
    arguments.cloth_options.report_progress = [&](double fraction) { bar(fraction); };
    return check_cloth(arguments.cloth, arguments.cloth_options);
}

template <typename Result>
int report(const Result& result, bool json) {
    fmt::print("{}", json ? to_json(result) : to_text(result));
    return result.holds() ? 0 : kFailed;
}

int run(const std::vector<std::string>& words) {
    Program program("echinus-check", "Judges exact maps and recorded cloth by CGAL's exact predicates.");
    Arguments arguments;
    add_options(program.command(), arguments);
    if (const std::optional<std::string> help = program.run(words)) {
        fmt::print("{}", *help);
        return 0;
    }
    if (arguments.list) {
        for (const std::string& name : test::nasty_mesh_names()) fmt::print("{}\n", name);
        return 0;
    }
    return arguments.cloth.empty() ? report(check(arguments), arguments.json)
                                   : report(check_recording(arguments), arguments.json);
}

int fail(const char* sentence, int status) {
    fmt::print(stderr, "echinus-check: {}\n", sentence);
    return status;
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run({argv + 1, argv + argc});
    } catch (const WrongUse& error) {
        return fail((std::string(error.what()) + "; see echinus-check --help").c_str(), kWrongUse);
    } catch (const Error& error) {
        return fail(error.what(), error.code() == ErrorCode::InvalidOptions ? kWrongUse : kFailed);
    } catch (const std::exception& error) {
        return fail(error.what(), kFailed);
    }
}
