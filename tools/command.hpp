#pragma once

#include "output.hpp"

#include <CLI/CLI.hpp>

/// One function per subcommand, in a file of the same name. Each adds its options, a footer with an example,
/// and a callback that does the work. The callback throws echinus::Error when it cannot (exit status 1) and
/// CLI::ValidationError when it was asked for something that makes no sense (exit status 2); main() prints
/// either as one line.
void add_mesh_command(CLI::App& app);
void add_info_command(CLI::App& app);
void add_build_command(CLI::App& app);
void add_query_command(CLI::App& app);
void add_compare_command(CLI::App& app);
void add_simulate_command(CLI::App& app);
void add_render_command(CLI::App& app);

/// Refuses a result that would take the place of what it is made of.
inline void require_another_file(const std::filesystem::path& source, const std::filesystem::path& target) {
    std::error_code not_there;
    if (std::filesystem::equivalent(source, target, not_there))
        throw CLI::ValidationError(target.string(), "this file is read; give the result another name");
}

/// Refuses --json together with a result that goes to standard output itself.
inline void require_one_result(const std::filesystem::path& target, bool json) {
    if (json && target == kStandardStream) {
        throw CLI::ValidationError(
            "--json", "cannot be used where the result goes to standard output (-), both print there");
    }
}
