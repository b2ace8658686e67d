#include "commands/commands.hpp"
#include "run_program.hpp"

#include <string_view>

namespace {

void add_commands(Program& program) {
    program.add_version("echinus " ECHINUS_VERSION);
    const Command command = program.command();
    command.require_command("A command");
    add_mesh_command(command);
    add_info_command(command);
    add_check_command(command);
    add_part_command(command);
    add_build_command(command);
    add_query_command(command);
    add_simulate_command(command);
#ifdef ECHINUS_WITH_RENDER
    add_render_command(command);
#endif
    add_tetrahedralize_command(command);
    command.footer(
        "A file named - is standard input or standard output, except a scene.\n"
        "Exit status: 0 success, 1 failure, 2 usage error; an error is one line on standard error.\n"
        "echinus COMMAND --help shows the options of a command and an example.");
}

/// To be removed after one version.
void tell_where_compare_went(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == "compare")
        throw WrongUse("'compare' is now a separate program, echinus-compare, which is built from source: "
                       "cmake --preset bench && cmake --build --preset bench --target echinus-compare");
}

} // namespace

int main(int argc, char** argv) {
    return run_program(
        "echinus", "Echinus: exact collision of cloth, soft bodies and points with triangle meshes",
        [&](Program& program) {
            tell_where_compare_went(argc, argv);
            add_commands(program);
        },
        argc, argv);
}
