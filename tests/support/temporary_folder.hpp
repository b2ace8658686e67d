#pragma once

#include "files/text.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace echinus::test {

/// For the files of the test that runs, and not made yet. Another process, which may run the same test at the
/// time, has another.
inline std::filesystem::path folder_of_test() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    return std::filesystem::temp_directory_path() / (std::string("echinus_") + test->test_suite_name() + "_" +
                                                     test->name() + "_" + std::to_string(getpid()));
}

inline std::string content_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// A test with its own empty folder, which is removed at its end.
class TemporaryFolderTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = folder_of_test();
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    /// @param name  in UTF-8
    std::filesystem::path path(const std::string& name) const { return folder_ / utf8_path(name); }

    std::filesystem::path write(const std::string& name, std::string_view content) const {
        std::filesystem::remove(path(name)); // overwriting in place waits for the disk on some file systems
        std::ofstream(path(name), std::ios::binary) << content;
        return path(name);
    }

  private:
    std::filesystem::path folder_;
};

} // namespace echinus::test
