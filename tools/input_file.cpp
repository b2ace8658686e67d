#include "input_file.hpp"

#include "files/read_file.hpp"
#include "run_program.hpp"

#include <echinus/mesh_io.hpp>

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
        if (total > echinus::kMostStreamBytes)
            input.fail(ErrorCode::Unreadable,
                       "has more than " + std::to_string(echinus::kMostStreamBytes) +
                           " bytes, the limit for such input; write it to a file first");
        output.write(block.data(), byte_count);
    }
    output.commit();
}

} // namespace

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
        throw WrongUse("--format", "is required for a mesh on standard input, for example --format obj");
    }
}

echinus::TriangleMesh read_mesh(const MeshArgument& argument) {
    argument.require_format();
    const InputFile file(argument.path, argument.format);
    return file.read([](const fs::path& path) { return echinus::read_mesh(path); });
}

void move_to_frame(const echinus::Vec3d& origin, echinus::TriangleMesh& mesh, const std::string& name) {
    if (mesh.origin == origin) return;
    warn(name + ": moved to the frame of the first mesh, where coordinates are rounded to float");
    const echinus::Vec3d offset = mesh.origin - origin;
    for (echinus::Vec3f& vertex : mesh.vertices) vertex = echinus::Vec3f(echinus::Vec3d(vertex) + offset);
    mesh.origin = origin;
}
