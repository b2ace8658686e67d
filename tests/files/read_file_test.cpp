#include "files/read_file.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <span>
#include <string>
#include <thread>

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
    EXPECT_FALSE(text("/proc/self/status").empty()); // a regular file that says that it has no bytes
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

TEST_F(ReadFile, ReadsPipesAndDevices) {
    if (fs::exists("/dev/null")) EXPECT_TRUE(text("/dev/null").empty());
    const fs::path pipe = path("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const std::string content(200'000, 'x');
    const std::jthread writer([&] { std::ofstream(pipe, std::ios::binary) << content; });
    EXPECT_EQ(text(pipe), content);
}

TEST_F(ReadFile, ReadsNoMoreOfAnEndlessDeviceThanTheLimit) {
    if (!fs::exists("/dev/zero")) GTEST_SKIP() << "this system has no /dev/zero";
    test::expect_error(ErrorCode::Unreadable, "/dev/zero: has more than 1000000 bytes",
                       [] { read_file("/dev/zero", nullptr, 1'000'000); });
}

TEST_F(ReadFile, ReadsNoMoreOfAnEndlessDeviceThanTheCheckNeedsToRefuseIt) {
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

TEST_F(ReadFile, RefusesAMissingFileAndADirectoryByName) {
    for (const fs::path& refused : {path("missing"), path("")})
        test::expect_error(ErrorCode::Unreadable, refused.string(), [&] { read_file(refused); });
    test::expect_error(ErrorCode::Unreadable, "a path that is empty: cannot", [] { read_file(""); });
}
