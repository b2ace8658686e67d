#pragma once

#include <echinus/export.hpp>

#include <string_view>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// The vector instructions that queries use. They affect the speed, not the answers.
///
/// The names are "avx512", "avx2", "sse4", "neon", "wasm", and "scalar", the reference implementation, which
/// processes one particle after the other. The default is the first one that the machine supports; the
/// environment variable ECHINUS_INSTRUCTION_SET, which is read once, overrides it. A name that this machine
/// does not support is ignored: instruction_set() returns the set in use.
namespace echinus {

/// The sets that this machine supports and for which this library was compiled, the widest first; the last is
/// "scalar".
std::vector<std::string_view> available_instruction_sets();

/// The set in use. Any thread may call this.
std::string_view instruction_set() noexcept;

/// Selects a different set for the whole process, from the next query on. Any thread may call this; running
/// queries are not affected.
/// @throws Error InvalidOptions for a name that is not available
void use_instruction_set(std::string_view name);

} // namespace echinus

ECHINUS_EXPORT_END
