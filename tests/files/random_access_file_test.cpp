#include "files/random_access_file.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>
#include <thread>

using namespace echinus;
namespace fs = std::filesystem;

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

TEST_F(RandomAccessFileTest, GivesPiecesOfAFileAndOfAPipe) {
    expect_pieces(RandomAccessFile(write("file", "0123456789")));
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    const std::jthread writer([&] { std::ofstream(path("pipe")) << "0123456789"; });
    expect_pieces(RandomAccessFile(path("pipe")));
}

TEST_F(RandomAccessFileTest, GivesFewerBytesOfAFileThatWasShortened) {
    const RandomAccessFile file(write("file", std::string(100'000, 'x')));
    fs::resize_file(path("file"), 50'000);
    EXPECT_EQ(piece(file, 0, 100'000).size(), 50'000U);
    EXPECT_EQ(piece(file, 60'000, 10), "");
}

TEST_F(RandomAccessFileTest, KeepsTheOldBytesWhenTheFileIsReplaced) {
    const RandomAccessFile file(write("file", "0123456789"));
    fs::rename(write("newer", "newer"), path("file"));
    expect_pieces(file);
}

TEST_F(RandomAccessFileTest, RefusesAMissingFileAndADirectoryByName) {
    for (const fs::path& refused : {path("missing"), path("")})
        test::expect_error(ErrorCode::Unreadable, refused.string(), [&] { RandomAccessFile file(refused); });
}
