#include <echinus/error.hpp>
#include <echinus_scene/scene.hpp>

#include <gtest/gtest.h>

#include <array>
#include <fstream>

using namespace echinus;
namespace fs = std::filesystem;

TEST(FindModel, TakesTheFirstFolderThatHasTheFile) {
    const fs::path root = fs::temp_directory_path() / "echinus_find_model";
    fs::remove_all(root);
    const std::array folders{root / "empty", root / "first", root / "second"};
    for (const fs::path& folder : folders) fs::create_directories(folder);
    std::ofstream(root / "first" / "horse.3ds") << "x";
    std::ofstream(root / "second" / "horse.3ds") << "x";
    std::ofstream(root / "second" / "cow.obj") << "x";
    fs::create_directory(root / "first" / "cow.obj"); // a folder of that name is no model
    EXPECT_EQ(find_model({"horse.3ds"}, folders), root / "first" / "horse.3ds");
    EXPECT_EQ(find_model({"cow.obj"}, folders), root / "second" / "cow.obj");
    EXPECT_EQ(find_model({(root / "second" / "cow.obj").string()}, folders), root / "second" / "cow.obj");
    try {
        find_model({"pig.obj"}, folders);
        FAIL() << "a model was found that is not there";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::Unreadable);
        const std::string sentence = error.what();
        for (const fs::path& folder : folders) EXPECT_NE(sentence.find(folder.string()), std::string::npos);
    }
    fs::remove_all(root);
}
