#include "output.hpp"

#include <echinus/error.hpp>

#include <nlohmann/json.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace {

[[noreturn]] void fail_standard_output() {
    throw echinus::Error(echinus::ErrorCode::Unwritable,
                         std::string("standard output: cannot write: ") + std::strerror(errno));
}

void write_standard_output(const void* data, std::size_t byte_count) {
    if (byte_count != 0 && std::fwrite(data, 1, byte_count, stdout) != byte_count) fail_standard_output();
}

} // namespace

Output::Output(const std::filesystem::path& target) {
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

void print(std::string_view text) {
    write_standard_output(text.data(), text.size());
}

void print_json(const nlohmann::ordered_json& object) {
    // File names need not be UTF-8; JSON must be.
    constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
    print(object.dump(2, ' ', false, kReplace) + "\n");
}

void flush_standard_output() {
    if (std::fflush(stdout) != 0) fail_standard_output();
}
