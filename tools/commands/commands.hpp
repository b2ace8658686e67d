#pragma once

#include "console/options.hpp"

/// One function per subcommand, in a file of the same name. Each adds its options, a footer with an example,
/// and an action that does the work. The action throws echinus::Error if it fails (exit status 1) and
/// WrongUse if the arguments make no sense (exit status 2); run_program() prints either as one line.
void add_mesh_command(Command program);
void add_info_command(Command program);
void add_check_command(Command program);
void add_part_command(Command program);
void add_build_command(Command program);
void add_query_command(Command program);
void add_simulate_command(Command program);
void add_render_command(Command program);
void add_tetrahedralize_command(Command program);
