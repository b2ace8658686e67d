#include "output.hpp"

#include "console/options.hpp"
#include "files/atomic_file.hpp"
#include "files/system.hpp"
#include "mesh_io/mesh_source.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
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

/// The folder itself if it exists, otherwise the nearest existing folder above it: a rename between the two
/// stays on one disk.
fs::path nearest_existing_folder(fs::path path) {
    while (!fs::exists(path) && path.has_relative_path()) path = path.parent_path();
    return path;
}

/// Makes a folder that others cannot read, if it does not exist yet.
void make_private_folder(const fs::path& path) {
    if (!echinus::system::make_private_folder(path))
        throw fs::filesystem_error("mkdir", path, std::error_code(errno, std::generic_category()));
}

/// Runs `action` and converts a system error into Error Unwritable.
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
    if (target == kStandardStream) return;
    echinus::remove_abandoned_parts(target.parent_path().empty() ? "." : target.parent_path());
    file_.emplace(target);
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

/// Another program that clears the folder at this moment may find and remove the part before it is locked;
/// then a new one is made. On file systems without locks, the last one is used anyway.
PartFolder::PartFolder(const fs::path& parent) {
    echinus::remove_abandoned_parts(parent);
    constexpr int kMostTries = 4;
    for (int tries = 0; tries < kMostTries; ++tries) {
        if (hold_ >= 0) echinus::system::close(hold_);
        path_ = echinus::new_part(parent);
        removal_.emplace(path_);
        make_private_folder(path_);
        hold_ = echinus::system::hold_folder(path_);
        if (hold_ >= 0 && fs::exists(path_)) return;
    }
    make_private_folder(path_);
}

PartFolder::~PartFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    if (hold_ >= 0) echinus::system::close(hold_);
}

OutputFolder::OutputFolder(const fs::path& target) : target_(fs::absolute(target).lexically_normal()) {
    or_unwritable(target_, [&] {
        const fs::path folder = nearest_existing_folder(target_);
        if (!fs::is_directory(folder))
            throw Error(ErrorCode::Unwritable, folder.string() + ": is not a folder; name one with -o");
        part_.emplace(folder);
    });
}

void OutputFolder::commit() {
    or_unwritable(target_, [&] {
        const auto together = hold_interruption();
        fs::create_directories(target_);
        for (const auto& entry : fs::directory_iterator(part_->path())) {
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
        throw WrongUse(target.string(), "is an input file; give the result another name");
}

void require_ending(const fs::path& target, std::initializer_list<std::string_view> endings) {
    const std::string ending = echinus::lower_case_ending(target);
    if (target == kStandardStream || std::ranges::find(endings, ending) != endings.end()) return;
    std::string list;
    for (const std::string_view& one : endings) {
        if (&one != endings.begin()) list += &one + 1 == endings.end() ? " or " : ", ";
        list += one;
    }
    throw WrongUse("--output", "must end in " + list + ", or be -; it is " + target.string());
}

void require_one_result(const fs::path& target, bool json) {
    if (json && target == kStandardStream)
        throw WrongUse("--json", "cannot be used where the result goes to standard output (-), since "
                                 "both are printed there");
}
