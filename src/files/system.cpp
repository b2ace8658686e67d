#include "files/system.hpp"

#ifdef _WIN32
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#include <windows.h>
#else
#include <fcntl.h>
#include <pthread.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#define ECHINUS_HAS_MMAP
#endif
#endif

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <new>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace echinus::system {

namespace fs = std::filesystem;

#ifdef _WIN32

namespace {

constexpr DWORD kShared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

int errno_of(DWORD error) {
    switch (error) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
    case ERROR_INVALID_NAME:
    case ERROR_BAD_NETPATH:
        return ENOENT;
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION:
    case ERROR_LOCK_VIOLATION:
    case ERROR_WRITE_PROTECT:
        return EACCES;
    case ERROR_FILE_EXISTS:
    case ERROR_ALREADY_EXISTS:
        return EEXIST;
    case ERROR_DISK_FULL:
    case ERROR_HANDLE_DISK_FULL:
        return ENOSPC;
    case ERROR_TOO_MANY_OPEN_FILES:
        return EMFILE;
    case ERROR_NOT_ENOUGH_MEMORY:
    case ERROR_OUTOFMEMORY:
        return ENOMEM;
    default:
        return EIO;
    }
}

bool fail_with_errno() {
    errno = errno_of(GetLastError());
    return false;
}

HANDLE handle_of(int descriptor) {
    return reinterpret_cast<HANDLE>(_get_osfhandle(descriptor));
}

/// @param mode  flags of the C library: _O_RDONLY or _O_WRONLY
int open(const fs::path& path, DWORD access, DWORD disposition, int mode) {
    const HANDLE handle =
        CreateFileW(path.c_str(), access, kShared, nullptr, disposition, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
    if (handle == INVALID_HANDLE_VALUE) {
        fail_with_errno();
        return -1;
    }
    const int descriptor =
        _open_osfhandle(reinterpret_cast<std::intptr_t>(handle), mode | _O_BINARY | _O_NOINHERIT);
    if (descriptor < 0) CloseHandle(handle);
    return descriptor;
}

} // namespace

int open_to_read(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) { // a directory could be opened but not read
        errno = EISDIR;
        return -1;
    }
    return open(path, GENERIC_READ, OPEN_EXISTING, _O_RDONLY);
}

int open_to_write(const fs::path& path) {
    return open(path, GENERIC_WRITE, OPEN_EXISTING, _O_WRONLY);
}

int create(const fs::path& path) {
    return open(path, GENERIC_WRITE, CREATE_NEW, _O_WRONLY);
}

int create_unnamed(const fs::path&) {
    errno = ENOTSUP;
    return -1;
}

bool give_name(std::FILE*, const fs::path&) {
    errno = ENOTSUP;
    return false;
}

void close(int descriptor) noexcept {
    _close(descriptor);
}

std::FILE* stream_of(int descriptor, const char* mode) {
    return _fdopen(descriptor, mode);
}

bool sync(std::FILE* file) {
    return _commit(_fileno(file)) == 0 || errno == EINVAL;
}

void sync_names(const fs::path&) {} // replace() has already waited

namespace {

/// FILE_RENAME_INFO with flags, which is missing from MinGW's headers of version 10.
struct RenameInfo {
    DWORD flags;
    HANDLE root;
    DWORD name_bytes;
    WCHAR name[1];
};

/// Replaces the target even if somebody reads it, as on POSIX. Works from Windows 10 on, but not on all file
/// systems.
bool replace_open_file(const fs::path& target, const fs::path& file) {
    constexpr auto kFileRenameInfoEx = static_cast<FILE_INFO_BY_HANDLE_CLASS>(22);
    constexpr DWORD kReplaceIfExists = 1, kPosixSemantics = 2;
    std::error_code error;
    const std::wstring name = fs::absolute(target, error).native();
    if (error) return false;
    const HANDLE handle =
        CreateFileW(file.c_str(), DELETE | SYNCHRONIZE, kShared, nullptr, OPEN_EXISTING, 0, nullptr);
    if (handle == INVALID_HANDLE_VALUE) return false;
    const std::size_t name_bytes = name.size() * sizeof(wchar_t);
    std::vector<std::byte> bytes(sizeof(RenameInfo) + name_bytes);
    auto& info = *new (bytes.data()) RenameInfo{};
    info.flags = kReplaceIfExists | kPosixSemantics;
    info.name_bytes = static_cast<DWORD>(name_bytes);
    std::copy(name.begin(), name.end(), info.name);
    const bool renamed =
        SetFileInformationByHandle(handle, kFileRenameInfoEx, &info, static_cast<DWORD>(bytes.size())) != 0;
    CloseHandle(handle);
    return renamed;
}

} // namespace

bool replace(const fs::path& target, const fs::path& file) {
    return replace_open_file(target, file) ||
           MoveFileExW(file.c_str(), target.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) !=
               0 ||
           fail_with_errno();
}

std::optional<std::uint64_t> size_of(int descriptor) {
    const HANDLE handle = handle_of(descriptor);
    LARGE_INTEGER size;
    if (GetFileType(handle) != FILE_TYPE_DISK || GetFileSizeEx(handle, &size) == 0) return std::nullopt;
    return static_cast<std::uint64_t>(size.QuadPart);
}

std::optional<std::size_t> read_at(int descriptor, std::uint64_t offset, std::span<std::byte> bytes) {
    constexpr std::size_t kMost = std::size_t{1} << 30; // the limit of one call
    std::size_t count = 0;
    while (count < bytes.size()) {
        const std::uint64_t at = offset + count;
        OVERLAPPED place{};
        place.Offset = static_cast<DWORD>(at);
        place.OffsetHigh = static_cast<DWORD>(at >> 32);
        DWORD read = 0;
        const DWORD wanted = static_cast<DWORD>(std::min(bytes.size() - count, kMost));
        if (ReadFile(handle_of(descriptor), bytes.data() + count, wanted, &read, &place) == 0) {
            if (GetLastError() == ERROR_HANDLE_EOF) break;
            fail_with_errno();
            return std::nullopt;
        }
        if (read == 0) break;
        count += read;
    }
    return count;
}

/// Maps nothing, since Windows does not replace mapped files.
std::span<const std::byte> map(int, std::size_t) {
    return {};
}

void unmap(std::span<const std::byte>) noexcept {}

bool make_private_folder(const fs::path& path) {
    // A folder within the user's own folder inherits its access rights.
    return CreateDirectoryW(path.c_str(), nullptr) != 0 || GetLastError() == ERROR_ALREADY_EXISTS ||
           fail_with_errno();
}

int hold_folder(const fs::path& path) {
    return open(path, GENERIC_READ, OPEN_EXISTING, _O_RDONLY);
}

void remove_unless_held(const fs::path& path) noexcept {
    // A process that holds it has it open, so that it cannot be opened exclusively.
    const DWORD kind = FILE_FLAG_BACKUP_SEMANTICS | FILE_FLAG_OPEN_REPARSE_POINT;
    const HANDLE handle =
        CreateFileW(path.c_str(), GENERIC_READ | DELETE, 0, nullptr, OPEN_EXISTING, kind, nullptr);
    if (handle == INVALID_HANDLE_VALUE) return;
    CloseHandle(handle);
    std::error_code ignored;
    fs::remove_all(path, ignored);
}

std::vector<std::string> begin_program(int argc, char** argv) {
    for (const int stream : {0, 1}) _setmode(stream, _O_BINARY);
    SetConsoleOutputCP(CP_UTF8);
    const HANDLE terminal = GetStdHandle(STD_ERROR_HANDLE);
    DWORD mode = 0;
    if (GetConsoleMode(terminal, &mode) != 0)
        SetConsoleMode(terminal, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);

    // The arguments of main() are in the system's old code page, which cannot represent every name.
    int count = 0;
    wchar_t** const wide = CommandLineToArgvW(GetCommandLineW(), &count);
    if (wide == nullptr) return {argv + std::min(argc, 1), argv + argc};
    std::vector<std::string> arguments;
    for (int i = 1; i < count; ++i) {
        const int size = WideCharToMultiByte(CP_UTF8, 0, wide[i], -1, nullptr, 0, nullptr, nullptr);
        std::string argument(static_cast<std::size_t>(std::max(size, 1)), '\0');
        WideCharToMultiByte(CP_UTF8, 0, wide[i], -1, argument.data(), size, nullptr, nullptr);
        argument.pop_back(); // the terminating zero
        arguments.push_back(std::move(argument));
    }
    LocalFree(wide);
    return arguments;
}

fs::path program_path() {
    std::wstring name(std::size_t{1} << 15, L'\0'); // the maximum length of a path
    name.resize(GetModuleFileNameW(nullptr, name.data(), static_cast<DWORD>(name.size())));
    return name;
}

bool has_terminal() {
    return _isatty(2) != 0;
}

namespace {

class ThreadEnd {
  public:
    explicit ThreadEnd(void (*end)(void*)) : index_(FlsAlloc(end)) {}
    ThreadEnd(const ThreadEnd&) = delete;
    ThreadEnd& operator=(const ThreadEnd&) = delete;
    ~ThreadEnd() { FlsFree(index_); }

    bool set(void* value) const { return FlsSetValue(index_, value) != 0; }

  private:
    DWORD index_;
};

/// Never destroyed, since threads of the system may run it until the process ends.
std::function<void()>& clean_up_function() {
    static auto& instance = *new std::function<void()>;
    return instance;
}

BOOL WINAPI on_control(DWORD) {
    static std::atomic<bool> is_running = false;
    if (!is_running.exchange(true)) clean_up_function()();
    return FALSE; // the system ends the process
}

} // namespace

void when_interrupted(std::function<void()> clean_up) {
    clean_up_function() = std::move(clean_up);
    SetConsoleCtrlHandler(on_control, TRUE);
}

void wait_for_end() {
    for (;;) Sleep(INFINITE);
}

#else

namespace {

class ThreadEnd {
  public:
    explicit ThreadEnd(void (*end)(void*)) : exists_(pthread_key_create(&key_, end) == 0) {}
    ThreadEnd(const ThreadEnd&) = delete;
    ThreadEnd& operator=(const ThreadEnd&) = delete;
    ~ThreadEnd() { // after a library is unloaded, threads may continue
        if (exists_) pthread_key_delete(key_);
    }

    bool set(void* value) const { return exists_ && pthread_setspecific(key_, value) == 0; }

  private:
    pthread_key_t key_{};
    bool exists_;
};

/// The path at which Linux provides the file of an open descriptor.
std::string path_of_descriptor(int descriptor) {
    return "/proc/self/fd/" + std::to_string(descriptor);
}

/// Holds the lock until all copies of the descriptor are closed.
bool lock(int descriptor) {
    return flock(descriptor, LOCK_EX | LOCK_NB) == 0;
}

} // namespace

int open_to_read(const fs::path& path) {
    return ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
}

int open_to_write(const fs::path& path) {
    return ::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
}

int create(const fs::path& path) {
    const int descriptor = ::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor >= 0) lock(descriptor);
    return descriptor;
}

int create_unnamed([[maybe_unused]] const fs::path& folder) {
#ifdef O_TMPFILE
    const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor < 0) return descriptor;
    lock(descriptor);
    if (access(path_of_descriptor(descriptor).c_str(), F_OK) == 0) return descriptor;
    ::close(descriptor); // the file could not be given a name
#endif
    return -1;
}

bool give_name(std::FILE* file, const fs::path& path) {
    return linkat(AT_FDCWD, path_of_descriptor(fileno(file)).c_str(), AT_FDCWD, path.c_str(),
                  AT_SYMLINK_FOLLOW) == 0;
}

void close(int descriptor) noexcept {
    ::close(descriptor);
}

std::FILE* stream_of(int descriptor, const char* mode) {
    return fdopen(descriptor, mode);
}

bool sync(std::FILE* file) {
    return fsync(fileno(file)) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS;
}

void sync_names(const fs::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    fsync(descriptor);
    ::close(descriptor);
}

bool replace(const fs::path& target, const fs::path& file) {
    return std::rename(file.c_str(), target.c_str()) == 0;
}

std::optional<std::uint64_t> size_of(int descriptor) {
    struct stat status {};
    if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return static_cast<std::uint64_t>(status.st_size);
}

std::optional<std::size_t> read_at(int descriptor, std::uint64_t offset, std::span<std::byte> bytes) {
    std::size_t count = 0;
    while (count < bytes.size()) {
        const ssize_t read =
            pread(descriptor, bytes.data() + count, bytes.size() - count, static_cast<off_t>(offset + count));
        if (read == 0) break;
        if (read < 0 && errno != EINTR) return std::nullopt;
        count += static_cast<std::size_t>(std::max<ssize_t>(read, 0));
    }
    return count;
}

std::span<const std::byte> map([[maybe_unused]] int descriptor, [[maybe_unused]] std::size_t byte_count) {
#ifdef ECHINUS_HAS_MMAP
    void* first = mmap(nullptr, byte_count, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (first != MAP_FAILED) return {static_cast<const std::byte*>(first), byte_count};
#endif
    return {};
}

void unmap([[maybe_unused]] std::span<const std::byte> bytes) noexcept {
#ifdef ECHINUS_HAS_MMAP
    munmap(const_cast<std::byte*>(bytes.data()), bytes.size());
#endif
}

bool make_private_folder(const fs::path& path) {
    return mkdir(path.c_str(), S_IRWXU) == 0 || errno == EEXIST;
}

int hold_folder(const fs::path& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0 || lock(descriptor)) return descriptor;
    ::close(descriptor);
    return -1;
}

void remove_unless_held(const fs::path& path) noexcept {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return;
    std::error_code ignored;
    if (lock(descriptor)) fs::remove_all(path, ignored);
    ::close(descriptor);
}

std::vector<std::string> begin_program(int argc, char** argv) {
    return {argv + std::min(argc, 1), argv + argc};
}

fs::path program_path() {
    std::error_code ignored;
    return fs::read_symlink("/proc/self/exe", ignored);
}

bool has_terminal() {
    return isatty(STDERR_FILENO) == 1;
}

namespace {

[[noreturn]] void clean_up_and_end(const std::function<void()>& clean_up, int signal,
                                   const sigset_t& signals) {
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr); // from here on, a second signal ends the program
    clean_up();
    raise(signal);
    _exit(128 + signal);
}

bool is_ignored(int signal) {
    struct sigaction action {};
    return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

} // namespace

void when_interrupted(std::function<void()> clean_up) {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (!is_ignored(signal)) sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr); // threads that are started later inherit the mask
    std::thread([clean_up = std::move(clean_up), signals] {
        int signal = 0;
        if (sigwait(&signals, &signal) == 0) clean_up_and_end(clean_up, signal, signals);
    }).detach();
}

void wait_for_end() {
    for (;;) pause();
}

#endif

void give_at_thread_end(void (*end)(void*), void* value) {
    static const ThreadEnd thread_end(end);
    if (!thread_end.set(value)) throw std::bad_alloc();
}

} // namespace echinus::system
