#pragma once

#include <CLI/CLI.hpp>

/// One function per subcommand, in a file of the same name. Each adds its options, a help text with an
/// example, and a callback that does the work and throws echinus::Error when it cannot.
void add_mesh_command(CLI::App& app);
void add_info_command(CLI::App& app);
void add_build_command(CLI::App& app);
void add_query_command(CLI::App& app);
void add_simulate_command(CLI::App& app);
void add_render_command(CLI::App& app);
