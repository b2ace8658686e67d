#include "files/atomic_file.hpp"
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
#include <string>
#include <vector>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

using Part = test::TemporaryFolderTest;

int open_folder(const fs::path& folder) {
    return open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

} // namespace

TEST_F(Part, IsRemovedWhenNobodyHoldsIt) {
    const fs::path folder = new_part(path(""));
    fs::create_directories(folder / "frames");
    const fs::path file = write(new_part(path("")).filename().string(), "half");
    remove_abandoned_parts(path(""));
    EXPECT_FALSE(fs::exists(folder));
    EXPECT_FALSE(fs::exists(file));
}

TEST_F(Part, StaysWhileItIsHeld) {
    const fs::path folder = new_part(path(""));
    fs::create_directories(folder);
    const int descriptor = open_folder(folder);
    ASSERT_TRUE(lock_part(descriptor));
    remove_abandoned_parts(path(""));
    EXPECT_TRUE(fs::exists(folder));
    const int copy = dup(descriptor);
    close(descriptor);
    remove_abandoned_parts(path(""));
    EXPECT_TRUE(fs::exists(folder)) << "the copy still holds it";
    close(copy);
    remove_abandoned_parts(path(""));
    EXPECT_FALSE(fs::exists(folder));
}

TEST_F(Part, IsNothingElseOfASimilarName) {
    for (const char* name : {".echinus.part", ".echinus.part1a", "echinus.part1", "map.ech.part1"})
        write(name, "mine");
    fs::create_symlink(path("map.ech.part1"), path(".echinus.part2"));
    remove_abandoned_parts(path(""));
    for (const char* name : {".echinus.part", ".echinus.part1a", "echinus.part1", "map.ech.part1"})
        EXPECT_TRUE(fs::exists(path(name))) << name;
    EXPECT_TRUE(fs::is_symlink(path(".echinus.part2")));
}

TEST_F(Part, OfAMissingFolderIsNoError) {
    remove_abandoned_parts(path("missing"));
}

namespace {

class AtomicFileTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = test::folder_of_test();
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    static std::string content(const fs::path& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::ptrdiff_t files_in_folder() const {
        return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
    }

    fs::path folder_;
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

TEST_F(AtomicFileTest, AppearsOnlyWithCommit) {
    const fs::path target = folder_ / "out.txt";
    {
        AtomicFile file(target);
        file.write("hello");
        EXPECT_FALSE(fs::exists(target));
        file.commit();
        EXPECT_EQ(content(target), "hello");
    }
    EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(AtomicFileTest, OverwritesWhatWasWrittenAndGoesOnAtTheEnd) {
    const fs::path target = folder_ / "out.txt";
    AtomicFile file(target);
    file.write("count ?, ");
    file.write("body");
    file.overwrite(6, "7", 1);
    file.write(", tail");
    file.commit();
    EXPECT_EQ(content(target), "count 7, body, tail");
}

TEST_F(AtomicFileTest, LeavesTheOldFileWholeWithoutCommit) {
    const fs::path target = folder_ / "out.txt";
    write_file(target, "old");
    {
        AtomicFile file(target);
        file.write("new");
    }
    EXPECT_EQ(content(target), "old");
    EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(AtomicFileTest, WritesThroughALinkAndKeepsIt) {
    write_file(folder_ / "real.txt", "old");
    fs::create_symlink("real.txt", folder_ / "link.txt");
    write_file(folder_ / "link.txt", "new");
    EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
    EXPECT_EQ(content(folder_ / "real.txt"), "new");
}

TEST_F(AtomicFileTest, LeavesNothingWhenTheProcessIsKilled) {
    const fs::path target = folder_ / "out.txt";
    const pid_t child = fork();
    if (child == 0) {
        AtomicFile file(target);
        file.write(std::string(1 << 20, 'x'));
        raise(SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status));
    remove_abandoned_parts(folder_); // of file systems that have no files without names
    EXPECT_EQ(files_in_folder(), 0);
}

TEST_F(AtomicFileTest, KeepsThePermissionsThatNewFilesGet) {
    const mode_t mask = umask(027);
    write_file(folder_ / "out.txt", "x");
    umask(mask);
    using fs::perms;
    EXPECT_EQ(fs::status(folder_ / "out.txt").permissions(),
              perms::owner_read | perms::owner_write | perms::group_read);
}

TEST_F(AtomicFileTest, ReportsAFullDisk) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
    test::expect_error(ErrorCode::Unwritable, "/dev/full", [] { write_file("/dev/full", "x"); });
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(AtomicFileTest, KeepsTheOldFileWhenTheDiskIsFull) {
    const fs::path target = folder_ / "out.txt";
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

TEST_F(AtomicFileTest, IsWrittenOrRefusedHoweverFewDescriptorsAreLeft) {
    int written = 0;
    for (std::size_t count = 0; count < 4; ++count) {
        const fs::path target = folder_ / std::to_string(count);
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

TEST_F(AtomicFileTest, LeavesNoDescriptorToChildrenAndNoneOpen) {
    const auto lowest_free = [] {
        const int descriptor = open("/dev/null", O_RDONLY | O_CLOEXEC);
        close(descriptor);
        return descriptor;
    };
    const int before = lowest_free();
    {
        AtomicFile file(folder_ / "out.txt");
        for (int descriptor = before; descriptor < lowest_free(); ++descriptor)
            EXPECT_NE(fcntl(descriptor, F_GETFD) & FD_CLOEXEC, 0) << descriptor;
        EXPECT_GT(lowest_free(), before);
        file.commit();
    }
    EXPECT_EQ(lowest_free(), before);
}

TEST_F(AtomicFileTest, IsRefusedWhereItsFolderHasGone) {
    const fs::path folder = folder_ / "folder";
    fs::create_directory(folder);
    AtomicFile file(folder / "out.txt");
    file.write("x");
    fs::remove_all(folder);
    test::expect_error(ErrorCode::Unwritable, "out.txt: cannot", [&] { file.commit(); });
    EXPECT_FALSE(fs::exists(folder));
}

TEST_F(AtomicFileTest, IsRefusedInAFolderThatIsReadOnly) {
    write_file(folder_ / "out.txt", "old");
    {
        const ReadOnlyFolder read_only(folder_);
        test::expect_error(ErrorCode::Unwritable, "out.txt: cannot open the file: Permission denied",
                           [&] { write_file(folder_ / "out.txt", "new"); });
    }
    EXPECT_EQ(content(folder_ / "out.txt"), "old");
    EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(AtomicFileTest, WritesToAPipe) {
    const fs::path pipe = folder_ / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    write_file(pipe, "hello");
    char bytes[8] = {};
    EXPECT_EQ(read(reader, bytes, sizeof bytes), 5);
    EXPECT_EQ(std::string(bytes), "hello");
    close(reader);
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(AtomicFileTest, RefusesADirectoryAndAMissingFolder) {
    EXPECT_THROW(AtomicFile{folder_}, Error);
    EXPECT_THROW(AtomicFile{folder_ / "missing" / "out.txt"}, Error);
    test::expect_error(ErrorCode::Unwritable, "a path that is empty: cannot", [] {
        AtomicFile file("");
        file.commit();
    });
    EXPECT_EQ(files_in_folder(), 0);
}
