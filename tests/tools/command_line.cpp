#include "tools/command_line.hpp"

#include "support/temporary_folder.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace fs = std::filesystem;

namespace {

std::string quoted(const std::string& argument) {
    std::string text = "'";
    for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

std::string read_all(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write_all(const fs::path& path, const std::string& content) {
    fs::remove(path); // overwriting in place waits for the disk on some file systems
    std::ofstream(path, std::ios::binary) << content;
}

} // namespace

std::size_t ProgramResult::error_line_count() const {
    return static_cast<std::size_t>(std::count(error.begin(), error.end(), '\n'));
}

void CommandLineTest::SetUp() {
    const fs::path base = echinus::test::folder_of_test();
    fs::remove_all(base);
    folder_ = base / "work";
    stream_folder_ = base / "streams";
    fs::create_directories(folder_);
    fs::create_directories(stream_folder_);
}

void CommandLineTest::TearDown() {
    fs::remove_all(folder_.parent_path());
}

ProgramResult CommandLineTest::run(const std::vector<std::string>& arguments, const std::string& input,
                                   const std::string& output_target) const {
    const auto stream = [&](const char* name) { return (stream_folder_ / name).string(); };
    write_all(stream("input"), input);
    std::string command = "cd " + quoted(folder_.string()) + " && " + quoted(program_);
    for (const std::string& argument : arguments) command += " " + quoted(argument);
    command += " <" + quoted(stream("input")) + " 2>" + quoted(stream("error")) + " >" +
               quoted(output_target.empty() ? stream("output") : output_target);
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            output_target.empty() ? read_all(stream("output")) : "", read_all(stream("error"))};
}

void CommandLineTest::expect_failure(int exit_status, const std::string& words,
                                     const std::vector<std::string>& arguments,
                                     const std::string& input) const {
    SCOPED_TRACE(program_.filename().string() + " " + testing::PrintToString(arguments));
    const std::vector<std::string> files_before = files();
    const ProgramResult result = run(arguments, input);
    EXPECT_EQ(result.exit_status, exit_status) << result.error;
    EXPECT_EQ(result.error_line_count(), 1u) << result.error;
    EXPECT_TRUE(result.error.starts_with(program_.filename().string() + ": ")) << result.error;
    EXPECT_NE(result.error.find(words), std::string::npos) << result.error;
    EXPECT_EQ(files(), files_before);
}

std::string CommandLineTest::expect_success(const std::vector<std::string>& arguments,
                                            const std::string& input) const {
    SCOPED_TRACE(program_.filename().string() + " " + testing::PrintToString(arguments));
    const ProgramResult result = run(arguments, input);
    EXPECT_EQ(result.exit_status, 0);
    EXPECT_EQ(result.error, "");
    return result.output;
}

void CommandLineTest::write(const std::string& name, const std::string& content) const {
    write_all(path(name), content);
}

std::string CommandLineTest::content(const std::string& name) const {
    return read_all(path(name));
}

std::vector<std::string> CommandLineTest::files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}
