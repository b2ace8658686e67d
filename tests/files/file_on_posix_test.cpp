// Files as on POSIX alone: links, pipes, devices, permissions, limits and processes that are killed.

#include "files/atomic_file.hpp"
#include "files/read_file.hpp"
#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <thread>
#include <vector>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

class FileOnPosix : public test::TemporaryFolderTest {
  protected:
    static std::string content(const fs::path& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::ptrdiff_t files_in_folder() const {
        return std::distance(fs::directory_iterator(path("")), fs::directory_iterator());
    }
    static std::string text(std::span<const std::byte> bytes) {
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
};

/// A limit of the process, for the life of this object.
class LowerLimit {
  public:
    LowerLimit(decltype(RLIMIT_NOFILE) resource, rlim_t limit) : resource_(resource) {
        getrlimit(resource, &before_);
        const rlimit lower{limit, before_.rlim_max};
        EXPECT_EQ(setrlimit(resource, &lower), 0);
    }
    LowerLimit(const LowerLimit&) = delete;
    LowerLimit& operator=(const LowerLimit&) = delete;
    ~LowerLimit() { setrlimit(resource_, &before_); }

  private:
    decltype(RLIMIT_NOFILE) resource_;
    rlimit before_{};
};

/// Leaves the process so many descriptors that it may open.
class FewDescriptors {
  public:
    explicit FewDescriptors(std::size_t count) : limit_(RLIMIT_NOFILE, 64) {
        for (int descriptor; (descriptor = open("/dev/null", O_RDONLY | O_CLOEXEC)) >= 0;)
            held_.push_back(descriptor);
        for (; count > 0; --count) {
            close(held_.back());
            held_.pop_back();
        }
    }
    ~FewDescriptors() {
        for (const int descriptor : held_) close(descriptor);
    }

  private:
    LowerLimit limit_;
    std::vector<int> held_;
};

/// A folder that nobody may write to; root, for the life of this object, is not above the folder's rights.
class ReadOnlyFolder {
  public:
    explicit ReadOnlyFolder(const fs::path& folder) : folder_(folder), user_(geteuid()) {
        fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                                     fs::perms::others_exec);
        constexpr uid_t kNobody = 65534;
        if (user_ == 0) EXPECT_EQ(seteuid(kNobody), 0);
    }
    ReadOnlyFolder(const ReadOnlyFolder&) = delete;
    ReadOnlyFolder& operator=(const ReadOnlyFolder&) = delete;
    ~ReadOnlyFolder() {
        EXPECT_EQ(seteuid(user_), 0);
        fs::permissions(folder_, fs::perms::owner_all);
    }

  private:
    fs::path folder_;
    uid_t user_;
};

} // namespace

TEST_F(FileOnPosix, IsNoPartWhereItIsALink) {
    write("mine", "mine");
    fs::create_symlink(path("mine"), path(".echinus.part2"));
    remove_abandoned_parts(path(""));
    EXPECT_TRUE(fs::is_symlink(path(".echinus.part2")));
    EXPECT_TRUE(fs::exists(path("mine")));
}

TEST_F(FileOnPosix, WritesThroughALinkAndKeepsIt) {
    write_file(path("real.txt"), "old");
    fs::create_symlink("real.txt", path("link.txt"));
    write_file(path("link.txt"), "new");
    EXPECT_TRUE(fs::is_symlink(path("link.txt")));
    EXPECT_EQ(content(path("real.txt")), "new");
}

TEST_F(FileOnPosix, LeavesNothingWhenTheProcessIsKilled) {
    const fs::path target = path("out.txt");
    const pid_t child = fork();
    if (child == 0) {
        AtomicFile file(target);
        file.write(std::string(1 << 20, 'x'));
        raise(SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status));
    remove_abandoned_parts(path("")); // of file systems that have no files without names
    EXPECT_EQ(files_in_folder(), 0);
}

TEST_F(FileOnPosix, KeepsThePermissionsThatNewFilesGet) {
    const mode_t mask = umask(027);
    write_file(path("out.txt"), "x");
    umask(mask);
    using fs::perms;
    EXPECT_EQ(fs::status(path("out.txt")).permissions(),
              perms::owner_read | perms::owner_write | perms::group_read);
}

TEST_F(FileOnPosix, ReportsAFullDisk) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
    test::expect_error(ErrorCode::Unwritable, "/dev/full", [] { write_file("/dev/full", "x"); });
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(FileOnPosix, KeepsTheOldFileWhenTheDiskIsFull) {
    const fs::path target = path("out.txt");
    write_file(target, "old");
    const auto handler = std::signal(SIGXFSZ, SIG_IGN); // then the limit is an error, as a full disk is
    {
        const LowerLimit full(RLIMIT_FSIZE, 4096);
        test::expect_error(ErrorCode::Unwritable, "out.txt: cannot write the file",
                           [&] { write_file(target, std::string(1 << 16, 'x')); });
    }
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(content(target), "old");
    EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(FileOnPosix, IsWrittenOrRefusedHoweverFewDescriptorsAreLeft) {
    int written = 0;
    for (std::size_t count = 0; count < 4; ++count) {
        const fs::path target = path(std::to_string(count));
        bool is_refused = false;
        try {
            const FewDescriptors left(count);
            write_file(target, "whole");
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::Unwritable) << error.what();
            is_refused = true;
        }
        EXPECT_EQ(fs::exists(target), !is_refused) << count;
        if (is_refused) continue;
        EXPECT_EQ(content(target), "whole") << count;
        ++written;
    }
    EXPECT_EQ(written, 3); // one descriptor is enough
    EXPECT_EQ(files_in_folder(), written);
}

TEST_F(FileOnPosix, LeavesNoDescriptorToChildrenAndNoneOpen) {
    const auto lowest_free = [] {
        const int descriptor = open("/dev/null", O_RDONLY | O_CLOEXEC);
        close(descriptor);
        return descriptor;
    };
    const int before = lowest_free();
    {
        AtomicFile file(path("out.txt"));
        for (int descriptor = before; descriptor < lowest_free(); ++descriptor)
            EXPECT_NE(fcntl(descriptor, F_GETFD) & FD_CLOEXEC, 0) << descriptor;
        EXPECT_GT(lowest_free(), before);
        file.commit();
    }
    EXPECT_EQ(lowest_free(), before);
}

TEST_F(FileOnPosix, IsRefusedWhereItsFolderHasGone) {
    const fs::path folder = path("folder");
    fs::create_directory(folder);
    AtomicFile file(folder / "out.txt");
    file.write("x");
    fs::remove_all(folder);
    test::expect_error(ErrorCode::Unwritable, "out.txt: cannot", [&] { file.commit(); });
    EXPECT_FALSE(fs::exists(folder));
}

TEST_F(FileOnPosix, IsRefusedInAFolderThatIsReadOnly) {
    write_file(path("out.txt"), "old");
    {
        const ReadOnlyFolder read_only(path(""));
        test::expect_error(ErrorCode::Unwritable, "out.txt: cannot open the file: Permission denied",
                           [&] { write_file(path("out.txt"), "new"); });
    }
    EXPECT_EQ(content(path("out.txt")), "old");
    EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(FileOnPosix, WritesToAPipe) {
    const fs::path pipe = path("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    write_file(pipe, "hello");
    char bytes[8] = {};
    EXPECT_EQ(read(reader, bytes, sizeof bytes), 5);
    EXPECT_EQ(std::string(bytes), "hello");
    close(reader);
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(FileOnPosix, ReadsPipesAndDevices) {
    if (fs::exists("/dev/null")) EXPECT_TRUE(text(read_file("/dev/null")).empty());
    const fs::path pipe = path("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const std::string content(200'000, 'x');
    const std::jthread writer([&] { std::ofstream(pipe, std::ios::binary) << content; });
    EXPECT_EQ(text(read_file(pipe)), content);
}

TEST_F(FileOnPosix, ReadsNoMoreOfAnEndlessDeviceThanTheLimit) {
    if (!fs::exists("/dev/zero")) GTEST_SKIP() << "this system has no /dev/zero";
    test::expect_error(ErrorCode::Unreadable, "/dev/zero: has more than 1000000 bytes",
                       [] { read_file("/dev/zero", nullptr, 1'000'000); });
}

TEST_F(FileOnPosix, ReadsNoMoreOfAnEndlessDeviceThanTheCheckNeedsToRefuseIt) {
    if (!fs::exists("/dev/zero")) GTEST_SKIP() << "this system has no /dev/zero";
    std::size_t seen = 0;
    test::expect_error(ErrorCode::WrongFormat, "zeros", [&] {
        read_file("/dev/zero", [&](std::span<const std::byte> beginning) {
            seen = beginning.size();
            throw Error(ErrorCode::WrongFormat, "zeros");
        });
    });
    EXPECT_EQ(seen, 65'536U);
}

TEST_F(FileOnPosix, IsReadWhereItSaysThatItHasNoBytes) {
    if (!fs::exists("/proc/self/status")) GTEST_SKIP() << "this system has no /proc";
    EXPECT_FALSE(read_file("/proc/self/status").empty());
}

TEST_F(FileOnPosix, IsReadInPiecesFromAPipe) {
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    const std::jthread writer([&] { std::ofstream(path("pipe")) << "0123456789"; });
    const RandomAccessFile file(path("pipe"));
    EXPECT_EQ(file.size(), 10U);
    std::string piece(5, '?');
    EXPECT_EQ(file.read(7, std::as_writable_bytes(std::span(piece))), 3U);
    EXPECT_EQ(piece, "789??");
}

TEST_F(FileOnPosix, ReadsWhatCannotBeMapped) {
    if (!fs::exists("/dev/null")) GTEST_SKIP() << "this system has no /dev/null";
    EXPECT_TRUE(MappedFile("/dev/null").bytes().empty());
}
