#include "player.hpp"

#include "files/mapped_file.hpp"

#include <echinus/error.hpp>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

constexpr std::string_view kPlace = "<!-- recording -->";

/// Beside the program, so that an installed tree may be moved.
fs::path installed_player() {
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    return (program.parent_path() / ECHINUS_DATA_FOLDER / "player.html").lexically_normal();
}

std::string read_text(const fs::path& path) {
    const MappedFile file(path);
    return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

std::string read_player(const fs::path& path) {
    try {
        return read_text(path);
    } catch (const Error& error) {
        throw Error(ErrorCode::Unreadable,
                    std::string(error.what()) +
                        "; --html needs the player: build it with scripts/web --build-only (and install "
                        "again, for an installed program), or name one with --player");
    }
}

} // namespace

Player::Player(fs::path path) {
    if (path.empty()) path = installed_player();
    page_ = read_player(path);
    place_ = page_.find(kPlace);
    if (place_ != std::string::npos && page_.find(kPlace, place_ + 1) == std::string::npos) return;
    throw Error(ErrorCode::WrongFormat, path.string() + ": is no player: it must have the line " +
                                            std::string(kPlace) +
                                            " once; scripts/web --build-only builds one");
}

std::string_view Player::tail() const {
    return std::string_view(page_).substr(place_ + kPlace.size());
}
