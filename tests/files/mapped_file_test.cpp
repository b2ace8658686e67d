#include "files/atomic_file.hpp"
#include "files/mapped_file.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <string>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

class MappedFileTest : public testing::Test {
  protected:
    void TearDown() override { fs::remove(path_); }

    static std::string text(const MappedFile& file) {
        return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
    }

    fs::path path_ =
        fs::temp_directory_path() /
        (std::string("echinus_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

} // namespace

TEST_F(MappedFileTest, ShowsTheBytesOfAFile) {
    const std::string content(100'000, 'x');
    write_file(path_, content);
    EXPECT_EQ(text(MappedFile(path_)), content);
}

TEST_F(MappedFileTest, ShowsNothingForAnEmptyFile) {
    write_file(path_, "");
    EXPECT_TRUE(MappedFile(path_).bytes().empty());
}

TEST_F(MappedFileTest, KeepsTheOldBytesWhenTheFileIsReplaced) {
    write_file(path_, "old");
    const MappedFile file(path_);
    write_file(path_, "newer");
    EXPECT_EQ(text(file), "old");
}

TEST_F(MappedFileTest, ReadsWhatCannotBeMapped) {
    if (!fs::exists("/dev/null")) GTEST_SKIP() << "this system has no /dev/null";
    EXPECT_TRUE(MappedFile("/dev/null").bytes().empty());
}

TEST_F(MappedFileTest, RefusesAMissingFileAndADirectoryByName) {
    for (const fs::path& path : {path_, fs::temp_directory_path()}) {
        try {
            MappedFile file(path);
            FAIL() << "it opened";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::Unreadable);
            EXPECT_TRUE(std::string(error.what()).starts_with(path.string()));
        }
    }
}
