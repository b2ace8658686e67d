#include "files/part.hpp"
#include "support/temporary_folder.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

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
