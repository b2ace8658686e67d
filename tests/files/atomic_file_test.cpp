#include "files/atomic_file.hpp"
#include "files/part.hpp"
#include "support/expect_error.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

class AtomicFileTest : public testing::Test {
  protected:
    void SetUp() override {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() / (std::string("echinus_") + test->name());
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
    try {
        write_file("/dev/full", "x");
        FAIL() << "a full disk was not noticed";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::Unwritable);
        EXPECT_NE(std::string(error.what()).find("/dev/full"), std::string::npos);
    }
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
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
