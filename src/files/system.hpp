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

/// Everything that Echinus requires of the operating system beyond the standard library, so that only one
/// source file distinguishes POSIX and Windows. If a function fails, it returns -1 instead of a descriptor or
/// false instead of true, and errno has the reason.
namespace echinus::system {

// ---- Files. While they are open here, other processes may read, rename and replace them. ----

/// Opens any file for reading; waits for the writer of a pipe.
int open_to_read(const std::filesystem::path& path);
/// Opens a device or a pipe for writing.
int open_to_write(const std::filesystem::path& path);
/// Creates a new file for writing and holds it.
int create(const std::filesystem::path& path);
/// Creates a file without a name for writing and holds it; returns -1 if the system or the file system does
/// not support that.
int create_unnamed(const std::filesystem::path& folder);
/// Gives the file a name that no file has yet.
bool give_name(std::FILE* file, const std::filesystem::path& path);
void close(int descriptor) noexcept;

/// The stream takes ownership of the descriptor.
std::FILE* stream_of(int descriptor, const char* mode);
/// Waits until the written bytes are on the disk; also returns true if the file system cannot tell.
bool sync(std::FILE* file);
/// Makes a new name in the folder survive a power cut. Does not report failures, since some folders may be
/// written to but not opened.
void sync_names(const std::filesystem::path& folder);
/// Renames a file to the name of another and replaces that in one step: everyone sees either the old file or
/// the new one.
bool replace(const std::filesystem::path& target, const std::filesystem::path& file);

/// The size of a regular file; nothing for other files. The size of files in /proc is 0.
std::optional<std::uint64_t> size_of(int descriptor);
/// Fills `bytes` with the bytes of the file from the offset on.
/// @returns  the number of bytes read, fewer than requested only at the end of the file; nothing on failure
std::optional<std::size_t> read_at(int descriptor, std::uint64_t offset, std::span<std::byte> bytes);

/// Maps the bytes of an open file into memory; returns nothing if they have to be read.
std::span<const std::byte> map(int descriptor, std::size_t byte_count);
void unmap(std::span<const std::byte> bytes) noexcept;

// ---- Held files and folders: open ones, which others can distinguish from those whose owner has ended ----

/// Creates a folder that others cannot read, unless it exists already.
bool make_private_folder(const std::filesystem::path& path);
/// Holds a folder until all copies of the descriptor are closed. Also returns -1 if another process holds it
/// or the file system has no locks.
int hold_folder(const std::filesystem::path& path);
/// Removes the file or folder unless a process holds it. A file that cannot be removed stays.
void remove_unless_held(const std::filesystem::path& path) noexcept;

// ---- Threads ----

/// Passes a value to `end` when the calling thread ends, unless it is the thread that ends the program. Only
/// the last value of a thread counts. (With GCC for Windows, the memory of a thread_local object is freed
/// before its destructor runs.)
/// @pre the value is not null, and `end` is the same in all calls
/// @throws std::bad_alloc
void give_at_thread_end(void (*end)(void*), void* value);

// ---- The program ----

/// The arguments after the program's name, in UTF-8. Also prepares the standard streams for binary data, and
/// the terminal for UTF-8 and escape sequences.
std::vector<std::string> begin_program(int argc, char** argv);
/// The path of the running program, or an empty path if it is unknown.
std::filesystem::path program_path();
/// Is standard error connected to a terminal?
bool has_terminal();

/// After this call, a request to end the program (SIGINT, SIGTERM or SIGHUP; on Windows Ctrl+C, Ctrl+Break
/// and the end of the terminal or the session) first runs `clean_up` in a separate thread, and then ends the
/// program as it would have done otherwise. A second request ends the program at once. Signals that are
/// ignored, as under nohup, remain ignored.
/// @pre the program has no other threads yet, and this function was not called before
void when_interrupted(std::function<void()> clean_up);
/// Never returns.
[[noreturn]] void wait_for_end();

} // namespace echinus::system

ECHINUS_EXPORT_END
