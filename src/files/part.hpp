#pragma once

#include <echinus/export.hpp>

#include <filesystem>

ECHINUS_EXPORT_BEGIN

namespace echinus {

// A *part* is a result that is not finished: a file or folder called .echinus.part and a number, in the
// folder where the result will be. Whoever writes it holds a lock (flock) on it, which goes with the process
// however that ends, so that others can tell the parts that were abandoned. File systems without locks are
// taken as holding all of them.

/// The path of a part in this folder, which no other thread or process of ours uses.
std::filesystem::path new_part(const std::filesystem::path& folder);

/// Locks an open part until all copies of the descriptor are closed.
/// @returns false where another process holds the lock, or the file system has no locks
bool lock_part(int descriptor) noexcept;

/// Removes the unlocked parts in this folder. Parts that cannot be removed stay.
void remove_abandoned_parts(const std::filesystem::path& folder) noexcept;

} // namespace echinus

ECHINUS_EXPORT_END
