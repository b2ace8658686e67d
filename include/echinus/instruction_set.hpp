#pragma once

#include <echinus/export.hpp>

#include <string_view>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// The vector instructions of the queries. They affect speed only, never the answers.
///
/// Names: "avx512", "avx2", "sse4", "neon", "wasm", and "scalar", which is the reference itself, one particle
/// after the other. The default is the first that the machine has; the environment variable
/// ECHINUS_INSTRUCTION_SET, read once, overrides it. A name that this machine does not have is ignored:
/// instruction_set() returns the one in use.
namespace echinus {

/// The sets that this machine has and this library was compiled for, the widest first; the last is "scalar".
std::vector<std::string_view> available_instruction_sets();

/// The set in use. Any thread.
std::string_view instruction_set() noexcept;

/// Selects another set for the whole process, from the next query on. Any thread; running queries are not
/// affected.
/// @throws Error InvalidOptions for a name that is not available
void use_instruction_set(std::string_view name);

} // namespace echinus

ECHINUS_EXPORT_END
