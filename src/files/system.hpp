#pragma once

#include <echinus/export.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// All that is asked of the operating system beyond the standard library, so that one source knows POSIX and
/// Windows. A function that gives a descriptor gives -1 where it fails, one that says whether it succeeded
/// gives false, and errno has the reason.
namespace echinus::system {

// ---- Files. Others may read, rename and replace a file that is open here. ----

/// Any file, to read; a pipe is waited for.
int open_to_read(const std::filesystem::path& path);
/// A device or a pipe, to write to.
int open_to_write(const std::filesystem::path& path);
/// A new file, to write to, which is held.
int create(const std::filesystem::path& path);
/// A file without a name, to write to, which is held; -1 where the system or the file system has none.
int create_unnamed(const std::filesystem::path& folder);
/// Gives it a name that no file has.
bool give_name(std::FILE* file, const std::filesystem::path& path);
void close(int descriptor) noexcept;

/// The stream takes the descriptor along.
std::FILE* stream_of(int descriptor, const char* mode);
/// Waits until the disk has what was written; true also where the file system cannot say when that is.
bool sync(std::FILE* file);
/// So that a new name in the folder outlasts a power cut. Nothing fails here: there are folders that may be
/// written to and not be opened.
void sync_names(const std::filesystem::path& folder);
/// Gives a file another's name, in one step: all see the old file or the new one.
bool replace(const std::filesystem::path& target, const std::filesystem::path& file);

/// Of a regular file; nothing for others. Files in /proc say 0.
std::optional<std::uint64_t> size_of(int descriptor);
/// Fills `bytes` with those that begin at the offset.
/// @returns how many there are, fewer only where the file ends; nothing where it fails
std::optional<std::size_t> read_at(int descriptor, std::uint64_t offset, std::span<std::byte> bytes);

/// The bytes of an open file in memory; none where they have to be read.
std::span<const std::byte> map(int descriptor, std::size_t byte_count);
void unmap(std::span<const std::byte> bytes) noexcept;

// ---- Held files and folders: open ones that others can tell from one whose owner has ended ----

/// Makes a folder that others cannot read, if it is not there yet.
bool make_private_folder(const std::filesystem::path& path);
/// Holds a folder until all copies of the descriptor are closed; -1 also where another process holds it, or
/// the file system has no locks.
int hold_folder(const std::filesystem::path& path);
/// Removes the file or folder unless somebody holds it. A file that cannot be removed stays.
void remove_unless_held(const std::filesystem::path& path) noexcept;

// ---- Threads ----

/// Gives a value to `end` when the calling thread ends, unless it is the one that ends the program. The last
/// value of a thread counts. (A thread_local object of GCC for Windows is gone before its destructor runs.)
/// @pre the value is not null, and `end` is always the same
/// @throws std::bad_alloc
void give_at_thread_end(void (*end)(void*), void* value);

// ---- The program ----

/// The arguments behind the program's name, in UTF-8. Also prepares standard streams for bytes, and the
/// terminal for UTF-8 and for escape sequences.
std::vector<std::string> begin_program(int argc, char** argv);
/// The file of the running program, or an empty path.
std::filesystem::path program_path();
/// Does standard error go to a terminal?
bool has_terminal();

/// From now on whatever asks the program to end (SIGINT, SIGTERM and SIGHUP; on Windows Ctrl+C, Ctrl+Break
/// and the end of the terminal or the session) first runs `clean_up`, in a thread of its own, and then ends
/// the program as it would have done. A second time it ends at once. Signals that are ignored, as under
/// nohup, stay so.
/// @pre the program has no other threads yet; called once
void when_interrupted(std::function<void()> clean_up);
/// Never returns.
[[noreturn]] void wait_for_end();

} // namespace echinus::system

ECHINUS_EXPORT_END
