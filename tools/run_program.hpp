#pragma once

#include "console/options.hpp"

#include <functional>
#include <string>

/// The body of main() in every program of the command line: parses the arguments, runs the actions that they
/// name, and writes one line to standard error if it fails.
/// @param set_up  adds the program's commands and options; may throw what actions throw
/// @returns the exit status: 0 success, 1 failure, 2 usage error
/// @pre the program has no other threads yet
int run_program(const std::string& name, const std::string& description,
                const std::function<void(Program&)>& set_up, int argc, char** argv);

/// Prints a sentence on standard error; the program continues.
void warn(const std::string& sentence);
