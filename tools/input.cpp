#include "input.hpp"

#include "files/mapped_file.hpp"

#include <echinus/mesh_io.hpp>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <vector>

namespace fs = std::filesystem;
using echinus::Error;
using echinus::ErrorCode;

namespace {

void copy_standard_input(const fs::path& target) {
    Input input{fs::path(kStandardStream)};
    Output output(target);
    std::vector<char> block(std::size_t{1} << 16);
    std::size_t total = 0;
    while (const std::size_t byte_count = input.read(block.data(), block.size())) {
        total += byte_count;
        if (total > echinus::MappedFile::kMostReadBytes)
            input.fail(ErrorCode::Unreadable,
                       "has more than " + std::to_string(echinus::MappedFile::kMostReadBytes) +
                           " bytes, the most that are read from it; write them to a file first, if they have "
                           "an end");
        output.write(block.data(), byte_count);
    }
    output.commit();
}

} // namespace

std::string name_of_input(const fs::path& path) {
    return path == kStandardStream ? "standard input" : path.string();
}

Input::Input(const fs::path& path)
    : name_(name_of_input(path)), stream_(path == kStandardStream ? std::cin : file_) {
    if (path == kStandardStream) return;
    errno = 0;
    file_.open(path, std::ios::binary);
    // A directory opens like a file and fails only when it is read, without a reason.
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) errno = EISDIR;
    if (!file_ || errno == EISDIR) {
        fail(ErrorCode::Unreadable, std::string("cannot open the file: ") + std::strerror(errno));
    }
}

std::size_t Input::read(void* bytes, std::size_t byte_count) {
    stream_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(byte_count));
    require_good();
    return static_cast<std::size_t>(stream_.gcount());
}

bool Input::read_line(std::string& line) {
    line.clear();
    std::streambuf& characters = *stream_.rdbuf();
    constexpr int kEnd = std::char_traits<char>::eof();
    int c = characters.sbumpc();
    if (c == kEnd) {
        stream_.peek(); // notices the end, or an error
        require_good();
        return false;
    }
    for (; c != kEnd && c != '\n'; c = characters.sbumpc()) {
        if (line.size() == kMaxLineLength)
            fail(ErrorCode::Damaged,
                 "a line has more than " + std::to_string(kMaxLineLength) + " characters");
        line += static_cast<char>(c);
    }
    if (line.ends_with('\r')) line.pop_back();
    return true;
}

bool Input::next_is(char byte) {
    return stream_.peek() == std::char_traits<char>::to_int_type(byte);
}

bool Input::at_end() {
    return stream_.peek() == std::char_traits<char>::eof();
}

void Input::fail(ErrorCode code, const std::string& finding) const {
    throw echinus::Error(code, name_ + ": " + finding);
}

void Input::require_good() const {
    if (stream_.bad()) fail(ErrorCode::Unreadable, "cannot be read to its end");
}

InputFile::InputFile(const fs::path& argument, const std::string& format)
    : path_(argument), name_(name_of_input(argument)) {
    if (argument != kStandardStream) return;
    copy_.emplace(fs::temp_directory_path());
    path_ = copy_->path() / ("input." + format);
    copy_standard_input(path_);
}

std::string InputFile::renamed(std::string sentence) const {
    const std::string copy = path_.string();
    const std::size_t position = copy_ ? sentence.find(copy) : std::string::npos;
    if (position != std::string::npos) sentence.replace(position, copy.size(), name_);
    return sentence;
}

std::string MeshArgument::name() const {
    return name_of_input(path);
}

void MeshArgument::add_format_option(Command command) {
    std::vector<std::pair<std::string, std::string>> choices;
    for (const char* ending : {"obj", "ply", "stl", "off", "gltf", "glb", "3ds"}) {
        choices.emplace_back(ending, ending);
    }
    add_choice(command, "--format", format, choices, "Format of a mesh on standard input");
}

void MeshArgument::require_format() const {
    if (path == kStandardStream && format.empty()) {
        throw WrongUse("--format", "needed for a mesh on standard input, such as --format obj");
    }
}

echinus::TriangleMesh read_mesh(const MeshArgument& argument) {
    argument.require_format();
    const InputFile file(argument.path, argument.format);
    return file.read([](const fs::path& path) { return echinus::read_mesh(path); });
}
