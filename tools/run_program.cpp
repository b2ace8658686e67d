#include "run_program.hpp"

#include "files/system.hpp"
#include "interruption.hpp"
#include "output.hpp"

#include <echinus/error.hpp>
#include <echinus/instruction_set.hpp>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string_view>
#include <vector>

namespace {

constexpr int kFailed = 1;
constexpr int kWrongUse = 2;

/// Replaces control characters by spaces, and runs of spaces by one: the parser breaks long sentences into
/// lines, and a file name may contain any character.
std::string one_line(std::string_view text) {
    std::string line;
    for (char c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
        if (c != ' ' || (!line.empty() && line.back() != ' ')) line += c;
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

int fail(const std::string& program, std::string_view sentence, int status) {
    wait_if_interrupted();
    std::fprintf(stderr, "%s: %s\n", program.c_str(), one_line(sentence).c_str());
    return status;
}

int fail_wrong_use(const std::string& name, const std::optional<Program>& program,
                   const std::string& sentence) {
    return fail(name, sentence + "; see " + (program ? program->given_command() : name) + " --help",
                kWrongUse);
}

/// The library ignores the name of an unsupported instruction set; the program reports it.
void require_named_instruction_set() {
    const char* name = std::getenv("ECHINUS_INSTRUCTION_SET");
    if (name != nullptr && *name != '\0') echinus::use_instruction_set(name);
}

} // namespace

void warn(const std::string& sentence) {
    std::fprintf(stderr, "warning: %s\n", one_line(sentence).c_str());
}

int run_program(const std::string& name, const std::string& description,
                const std::function<void(Program&)>& set_up, int argc, char** argv) {
    const std::vector<std::string> arguments = echinus::system::begin_program(argc, argv);
    clean_up_when_interrupted();
    std::optional<Program> program;
    try {
        require_named_instruction_set();
        set_up(program.emplace(name, description));
        if (const std::optional<std::string> text = program->run(arguments)) print(*text);
        flush_standard_output();
        return 0;
    } catch (const WrongUse& error) {
        return fail_wrong_use(name, program, error.what());
    } catch (const echinus::Error& error) {
        if (error.code() == echinus::ErrorCode::InvalidOptions)
            return fail_wrong_use(name, program, error.what());
        return fail(name, error.what(), kFailed);
    } catch (const std::bad_alloc&) {
        return fail(name, "out of memory: the input or the requested result is too large for this machine",
                    kFailed);
    } catch (const std::exception& error) {
        return fail(name, error.what(), kFailed);
    }
}
