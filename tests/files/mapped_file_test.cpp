#include "files/atomic_file.hpp"
#include "files/mapped_file.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>

#include <span>
#include <string>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

using MappedFileTest = test::TemporaryFolderTest;

std::string text(const MappedFile& file) {
    return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

} // namespace

TEST_F(MappedFileTest, ShowsTheBytesOfAFile) {
    const std::string content(100'000, 'x');
    EXPECT_EQ(text(MappedFile(write("file", content))), content);
}

TEST_F(MappedFileTest, ShowsNothingForAnEmptyFile) {
    EXPECT_TRUE(MappedFile(write("file", "")).bytes().empty());
}

TEST_F(MappedFileTest, KeepsTheOldBytesWhenTheFileIsReplaced) {
    const MappedFile file(write("file", "old"));
    write_file(path("file"), "newer");
    EXPECT_EQ(text(file), "old");
}

TEST_F(MappedFileTest, ReadsWhatCannotBeMapped) {
    if (!fs::exists("/dev/null")) GTEST_SKIP() << "this system has no /dev/null";
    EXPECT_TRUE(MappedFile("/dev/null").bytes().empty());
}

TEST_F(MappedFileTest, RefusesAMissingFileAndADirectoryByName) {
    for (const fs::path& refused : {path("missing"), path("")}) {
        test::expect_error(ErrorCode::Unreadable, refused.string(), [&] { MappedFile file(refused); });
    }
    test::expect_error(ErrorCode::Unreadable, "a path that is empty: cannot", [] { MappedFile file(""); });
}
