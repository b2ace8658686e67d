#include "commands/commands.hpp"
#include "interruption.hpp"
#include "output.hpp"

#include <echinus/error.hpp>
#include <echinus/instruction_set.hpp>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>

namespace {

constexpr int kFailed = 1;
constexpr int kWrongUse = 2;

/// Control characters become spaces and runs of spaces one: the parser breaks long sentences into lines, and
/// a file name may hold anything.
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
    wait_if_interrupted();
    std::fprintf(stderr, "echinus: %s\n", one_line(sentence).c_str());
    return status;
}

int fail_wrong_use(std::string_view sentence) {
    return fail(std::string(sentence) + "; see echinus --help", kWrongUse);
}

/// The library ignores the name of an instruction set that it does not have; a user of the command line wants
/// to know.
void require_named_instruction_set() {
    const char* name = std::getenv("ECHINUS_INSTRUCTION_SET");
    if (name != nullptr && *name != '\0') echinus::use_instruction_set(name);
}

void parse_and_run(int argc, char** argv) {
    require_named_instruction_set();
    Program program("echinus",
                    "Echinus: exact collision of cloth, soft bodies and points with triangle meshes");
    program.add_version("echinus " ECHINUS_VERSION);
    const Command command = program.command();
    command.require_command("A subcommand");
    add_mesh_command(command);
    add_info_command(command);
    add_build_command(command);
    add_query_command(command);
#ifdef ECHINUS_WITH_RIVALS
    add_compare_command(command);
#endif
    add_simulate_command(command);
    add_render_command(command);
    add_tetrahedralize_command(command);
    command.footer("A file named - is standard input or standard output, except a scene.\n"
                   "Exit status: 0 done, 1 failed, 2 wrong use; an error is one line on standard error.\n"
                   "echinus COMMAND --help shows the options of a command and an example.");
    if (const std::optional<std::string> text = program.run(argc, argv)) print(*text);
    flush_standard_output();
}

} // namespace

int main(int argc, char** argv) {
    clean_up_when_interrupted();
    try {
        parse_and_run(argc, argv);
        return 0;
    } catch (const WrongUse& error) {
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
