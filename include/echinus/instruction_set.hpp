#pragma once

#include <echinus/export.hpp>

#include <string_view>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Which vector instructions the batch queries use. Answers do not depend on it, only speed does.
///
/// Names: "avx512", "avx2", "sse4", "neon", "wasm", and "scalar", which is the reference itself, one particle
/// after the other. Unless told, the first that the machine has is used; the environment variable
/// ECHINUS_INSTRUCTION_SET, read once, names another. A name there that this machine does not have is passed
/// over: instruction_set() tells what is in use.
namespace echinus {

/// Those that this machine has and this library was compiled for, the widest first; the last is "scalar".
std::vector<std::string_view> available_instruction_sets();

/// The one in use. Any thread.
std::string_view instruction_set() noexcept;

/// Uses another from the next query on, in the whole process. Any thread; queries that run go on as they are.
/// @throws Error InvalidOptions for a name that is not available
void use_instruction_set(std::string_view name);

} // namespace echinus

ECHINUS_EXPORT_END
