#include "files/atomic_file.hpp"
#include "files/read_file.hpp"
#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"
#include "support/wine.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>

#include <span>
#include <string>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

using ReadFile = test::TemporaryFolderTest;

std::string text(const fs::path& path, const CheckBeginning& check = nullptr) {
    const std::vector<std::byte> bytes = read_file(path, check);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

} // namespace

TEST_F(ReadFile, GivesTheBytesOfAFile) {
    for (const std::size_t size : {0, 1, 65'535, 65'536, 65'537, 131'072, 200'000}) {
        std::string content(size, 'x');
        for (std::size_t i = 0; i < size; ++i) content[i] = static_cast<char>(i * 7 / 5);
        EXPECT_EQ(text(write("file", content)), content);
    }
}

TEST_F(ReadFile, GivesWhatIsThereOfAFileThatIsShortenedBetweenOpeningAndReading) {
    const fs::path file = write("file", std::string(1'000'000, 'x'));
    const auto shorten = [&](auto) { fs::resize_file(file, 100'000); };
    EXPECT_EQ(text(file, shorten), std::string(100'000, 'x'));
    const fs::path emptied = write("emptied", std::string(1'000'000, 'x'));
    EXPECT_EQ(text(emptied, [&](auto) { fs::resize_file(emptied, 0); }), std::string(65'536, 'x'));
}

TEST_F(ReadFile, GivesNoMoreOfAFileThatGrowsThanItHadAtFirst) {
    const fs::path file = write("file", std::string(100'000, 'x'));
    EXPECT_EQ(text(file, [&](auto) { fs::resize_file(file, 1'000'000); }), std::string(100'000, 'x'));
}

TEST_F(ReadFile, RefusesAMissingFileAndADirectoryByName) {
    for (const fs::path& refused : {path("missing"), path("")})
        test::expect_error(ErrorCode::Unreadable, refused.string(), [&] { read_file(refused); });
    test::expect_error(ErrorCode::Unreadable, "a path that is empty: cannot", [] { read_file(""); });
}

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

TEST_F(MappedFileTest, RefusesAMissingFileAndADirectoryByName) {
    for (const fs::path& refused : {path("missing"), path("")}) {
        test::expect_error(ErrorCode::Unreadable, refused.string(), [&] { MappedFile file(refused); });
    }
    test::expect_error(ErrorCode::Unreadable, "a path that is empty: cannot", [] { MappedFile file(""); });
}

namespace {

using RandomAccessFileTest = test::TemporaryFolderTest;

std::string piece(const RandomAccessFile& file, std::uint64_t offset, std::size_t byte_count) {
    std::string text(byte_count, '?');
    text.resize(file.read(offset, std::as_writable_bytes(std::span(text))));
    return text;
}

void expect_pieces(const RandomAccessFile& file) {
    EXPECT_EQ(file.size(), 10U);
    EXPECT_EQ(piece(file, 0, 3), "012");
    EXPECT_EQ(piece(file, 7, 3), "789");
    EXPECT_EQ(piece(file, 8, 5), "89");
    EXPECT_EQ(piece(file, 11, 5), "");
    EXPECT_EQ(piece(file, 5, 0), "");
}

} // namespace

TEST_F(RandomAccessFileTest, GivesPiecesOfAFile) {
    expect_pieces(RandomAccessFile(write("file", "0123456789")));
}

TEST_F(RandomAccessFileTest, GivesFewerBytesOfAFileThatWasShortened) {
    const RandomAccessFile file(write("file", std::string(100'000, 'x')));
    fs::resize_file(path("file"), 50'000);
    EXPECT_EQ(piece(file, 0, 100'000).size(), 50'000U);
    EXPECT_EQ(piece(file, 60'000, 10), "");
}

TEST_F(RandomAccessFileTest, KeepsTheOldBytesWhenTheFileIsReplaced) {
    if (test::is_wine()) GTEST_SKIP() << test::kWineReplacesNoOpenFile;
    const RandomAccessFile file(write("file", "0123456789"));
    write_file(path("file"), "newer");
    expect_pieces(file);
}

TEST_F(RandomAccessFileTest, RefusesAMissingFileAndADirectoryByName) {
    for (const fs::path& refused : {path("missing"), path("")})
        test::expect_error(ErrorCode::Unreadable, refused.string(), [&] { RandomAccessFile file(refused); });
}
