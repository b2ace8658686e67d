#include "output.hpp"

#include "options.hpp"

#include <echinus/error.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <random>
#include <string>

namespace fs = std::filesystem;
using echinus::Error;
using echinus::ErrorCode;

namespace {

[[noreturn]] void fail_standard_output() {
    throw Error(ErrorCode::Unwritable, std::string("standard output: cannot write: ") + std::strerror(errno));
}

void write_standard_output(const void* data, std::size_t byte_count) {
    if (byte_count != 0 && std::fwrite(data, 1, byte_count, stdout) != byte_count) fail_standard_output();
}

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

Output::Output(const fs::path& target) {
    if (target != kStandardStream) file_.emplace(target);
}

void Output::write(const void* data, std::size_t byte_count) {
    if (file_) {
        file_->write(data, byte_count);
    } else {
        write_standard_output(data, byte_count);
    }
}

void Output::commit() {
    if (file_) {
        file_->commit();
    } else {
        flush_standard_output();
    }
}

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

void print(std::string_view text) {
    write_standard_output(text.data(), text.size());
}

void flush_standard_output() {
    if (std::fflush(stdout) != 0) fail_standard_output();
}

void require_another_file(const fs::path& source, const fs::path& target) {
    std::error_code not_there;
    if (fs::equivalent(source, target, not_there))
        throw WrongUse(target.string(), "this file is read; give the result another name");
}

void require_one_result(const fs::path& target, bool json) {
    if (json && target == kStandardStream)
        throw WrongUse("--json", "cannot be used where the result goes to standard output (-), both print "
                                 "there");
}
