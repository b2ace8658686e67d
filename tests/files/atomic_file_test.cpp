#include "files/atomic_file.hpp"
#include "files/system.hpp"
#include "files/text.hpp"
#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"
#include "support/wine.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <span>
#include <string>

using namespace echinus;
namespace fs = std::filesystem;

using Part = test::TemporaryFolderTest;

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
    const int descriptor = system::hold_folder(folder);
    ASSERT_GE(descriptor, 0);
    remove_abandoned_parts(path(""));
    EXPECT_TRUE(fs::exists(folder));
    const int copy = dup(descriptor);
    system::close(descriptor);
    remove_abandoned_parts(path(""));
    EXPECT_TRUE(fs::exists(folder)) << "the copy still holds it";
    system::close(copy);
    remove_abandoned_parts(path(""));
    EXPECT_FALSE(fs::exists(folder));
}

TEST_F(Part, IsNothingElseOfASimilarName) {
    for (const char* name : {".echinus.part", ".echinus.part1a", "echinus.part1", "map.ech.part1"})
        write(name, "mine");
    remove_abandoned_parts(path(""));
    for (const char* name : {".echinus.part", ".echinus.part1a", "echinus.part1", "map.ech.part1"})
        EXPECT_TRUE(fs::exists(path(name))) << name;
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

TEST_F(AtomicFileTest, IsNotRemovedAsAbandonedWhileItIsWritten) {
    AtomicFile file(folder_ / "out.txt");
    file.write("hello");
    remove_abandoned_parts(folder_);
    file.commit();
    EXPECT_EQ(content(folder_ / "out.txt"), "hello");
}

TEST_F(AtomicFileTest, ReplacesAFileThatIsBeingRead) {
    if (test::is_wine()) GTEST_SKIP() << test::kWineReplacesNoOpenFile;
    const fs::path target = folder_ / "out.txt";
    write_file(target, "old");
    const int reader = system::open_to_read(target);
    ASSERT_GE(reader, 0);
    write_file(target, "newer");
    std::string old(5, '?');
    EXPECT_EQ(system::read_at(reader, 0, std::as_writable_bytes(std::span(old))), 3U);
    system::close(reader);
    EXPECT_EQ(old, "old??");
    EXPECT_EQ(content(target), "newer");
    EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(AtomicFileTest, HasANameOfAnyLetters) {
    const fs::path target = folder_ / std::u8string(u8"Kr\u00e4hen\u00fcberzug \u65e5\u672c \U0001f994.txt");
    write_file(target, "hello");
    EXPECT_EQ(content(target), "hello");
    EXPECT_EQ(fs::directory_iterator(folder_)->path(), target);
    EXPECT_EQ(utf8_path(target.string()), target);
    test::expect_error(ErrorCode::Unwritable, "\U0001f994.txt", [&] { write_file(target / "x", "x"); });
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
