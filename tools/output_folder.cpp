#include "output_folder.hpp"

#include <echinus/error.hpp>

#include <random>

namespace fs = std::filesystem;
using echinus::Error;
using echinus::ErrorCode;

namespace {

/// The folder itself if it exists, else the nearest one above it: a rename between the two stays on one disk.
fs::path nearest_existing_folder(fs::path path) {
    while (!fs::exists(path) && path.has_relative_path()) path = path.parent_path();
    return path;
}

/// Runs `action` and turns the system's error into ours.
template <typename Action>
void or_unwritable(const fs::path& target, const Action& action) {
    try {
        action();
    } catch (const fs::filesystem_error& error) {
        throw Error(ErrorCode::Unwritable,
                    target.string() + ": cannot write to this folder: " + error.code().message());
    }
}

} // namespace

OutputFolder::OutputFolder(const fs::path& target) : target_(fs::absolute(target).lexically_normal()) {
    or_unwritable(target_, [&] {
        const fs::path folder = nearest_existing_folder(target_);
        if (!fs::is_directory(folder))
            throw Error(ErrorCode::Unwritable, folder.string() + ": is not a folder; name one with -o");
        temporary_ = folder / (".echinus.part" + std::to_string(std::random_device{}()));
        fs::create_directory(temporary_);
    });
}

OutputFolder::~OutputFolder() {
    std::error_code ignored;
    fs::remove_all(temporary_, ignored);
}

void OutputFolder::commit() {
    or_unwritable(target_, [&] {
        fs::create_directories(target_);
        for (const auto& entry : fs::directory_iterator(temporary_)) {
            const fs::path place = target_ / entry.path().filename();
            if (entry.is_directory() || fs::is_directory(place)) fs::remove_all(place);
            fs::rename(entry.path(), place);
        }
    });
}

void OutputFolder::remove_old(const std::string& name) const {
    or_unwritable(target_, [&] { fs::remove_all(target_ / name); });
}
