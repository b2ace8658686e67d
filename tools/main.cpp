#include "command.hpp"
#include "output.hpp"

#include <echinus/error.hpp>
#include <echinus/instruction_set.hpp>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <string_view>

namespace {

constexpr int kFailed = 1;
constexpr int kWrongUse = 2;

/// Control characters become spaces and runs of spaces one: CLI11 breaks long sentences into lines, and a
/// file name may hold anything.
std::string one_line(std::string_view text) {
    std::string line;
    for (char c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
        if (c != ' ' || (!line.empty() && line.back() != ' ')) line += c;
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

int fail(std::string_view sentence, int status) {
    std::fprintf(stderr, "echinus: %s\n", one_line(sentence).c_str());
    return status;
}

int fail_wrong_use(std::string_view sentence) {
    return fail(std::string(sentence) + "; see echinus --help", kWrongUse);
}

/// The library passes over a wish that it cannot grant; somebody at a command line wants to hear of it.
void require_wished_instruction_set() {
    const char* wish = std::getenv("ECHINUS_INSTRUCTION_SET");
    if (wish != nullptr && *wish != '\0') echinus::use_instruction_set(wish);
}

void parse_and_run(int argc, char** argv) {
    require_wished_instruction_set();
    CLI::App app{"Echinus: is a particle inside a rigid model, how deep, and which way out?"};
    app.name("echinus");
    app.set_version_flag("--version", "echinus " ECHINUS_VERSION);
    app.require_subcommand(0, 1); // none is refused below: here it would hide a misspelt one
    add_mesh_command(app);
    add_info_command(app);
    add_build_command(app);
    add_query_command(app);
    add_compare_command(app);
    add_simulate_command(app);
    add_render_command(app);
    app.footer("A file named - is standard input or standard output.\n"
               "Exit status: 0 done, 1 failed, 2 wrong use; an error is one line on standard error.\n"
               "echinus COMMAND --help shows the options of a command and an example.");
    try {
        app.parse(argc, argv);
        if (app.get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
    } catch (const CLI::Success& help_or_version) {
        std::ostringstream text;
        app.exit(help_or_version, text, text);
        print(text.str());
        if (!text.str().ends_with('\n')) print("\n"); // CLI11 forgets it in the help of nested subcommands
    }
    flush_standard_output();
}

} // namespace

int main(int argc, char** argv) {
    try {
        parse_and_run(argc, argv);
        return 0;
    } catch (const CLI::ParseError& error) {
        return fail_wrong_use(error.what());
    } catch (const echinus::Error& error) {
        if (error.code() == echinus::ErrorCode::InvalidOptions) return fail_wrong_use(error.what());
        return fail(error.what(), kFailed);
    } catch (const std::bad_alloc&) {
        return fail("out of memory: the input, or what was asked for, is too large for this machine",
                    kFailed);
    } catch (const std::exception& error) {
        return fail(error.what(), kFailed);
    }
}
