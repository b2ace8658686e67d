#pragma once

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// The result of running a program.
struct ProgramResult {
    int exit_status = -1; ///< -1: killed by a signal
    std::string output;   ///< standard output
    std::string error;    ///< standard error

    std::size_t error_line_count() const;
};

/// A test with its own empty folder, from which it runs a built program: `echinus`, or the one that is named.
class CommandLineTest : public testing::Test {
  protected:
    explicit CommandLineTest(std::filesystem::path program = ECHINUS_PROGRAM)
        : program_(std::move(program)) {}
    void SetUp() override;
    void TearDown() override;

    /// Runs it with these arguments in the test's folder; `input` becomes its standard input. Standard
    /// output is captured, or goes to the file `output_target`.
    ProgramResult run(const std::vector<std::string>& arguments, const std::string& input = "",
                      const std::string& output_target = "") const;

    /// The run must fail in the way the command line promises: this exit status, one line on standard error
    /// that begins with the program's name and contains `words`, and no new file in the folder.
    void expect_failure(int exit_status, const std::string& words, const std::vector<std::string>& arguments,
                        const std::string& input = "") const;

    /// The run must succeed without output on standard error; returns its standard output.
    std::string expect_success(const std::vector<std::string>& arguments,
                               const std::string& input = "") const;

    std::filesystem::path path(const std::string& name) const { return folder_ / name; }
    void write(const std::string& name, const std::string& content) const;
    std::string content(const std::string& name) const;
    /// Names of the files in the folder, sorted.
    std::vector<std::string> files() const;

  private:
    std::filesystem::path program_;
    std::filesystem::path folder_;
    std::filesystem::path stream_folder_; // standard streams, kept out of the folder under test
};

namespace echinus::test {

/// A mesh as the text of an OBJ file, written without the program's own writer.
inline std::string obj_text(const TriangleMesh& mesh) {
    std::ostringstream text;
    text.precision(9);
    for (const Vec3f& v : mesh.vertices) text << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
    for (const Triangle& f : mesh.faces) {
        text << "f " << f[0] + 1 << ' ' << f[1] + 1 << ' ' << f[2] + 1 << '\n';
    }
    return text.str();
}

inline std::string box_text() {
    return obj_text(make_box({2, 3, 4}));
}

/// The same box without its last face.
inline std::string open_box_text() {
    TriangleMesh mesh = make_box({2, 3, 4});
    mesh.faces.pop_back();
    return obj_text(mesh);
}

/// The same box with its first face twice.
inline std::string doubled_face_text() {
    TriangleMesh mesh = make_box({2, 3, 4});
    mesh.faces.push_back(mesh.faces.front());
    return obj_text(mesh);
}

} // namespace echinus::test
