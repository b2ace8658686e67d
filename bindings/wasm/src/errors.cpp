// Reports errors to JavaScript, and allocates memory for it.

#include "interface.hpp"

#include <echinus/error.hpp>

#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>

namespace echinus::wasm {

namespace {

struct Note {
    const char* code = "";
    // Of fixed size: when memory runs out, there is none for the sentence.
    char sentence[1024] = "";

    void set(const char* new_code, std::string_view text) {
        code = new_code;
        std::size_t size = std::min(text.size(), sizeof sentence - 1);
        // Not in the middle of a character: bytes 10xxxxxx continue one.
        while (size < text.size() && size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0) == 0x80)
            --size;
        text.copy(sentence, size);
        sentence[size] = '\0';
    }
};

Note last_error;

const char* name_of(ErrorCode code) {
    switch (code) {
    case ErrorCode::Unreadable:
        return "Unreadable";
    case ErrorCode::Unwritable:
        return "Unwritable";
    case ErrorCode::WrongFormat:
        return "WrongFormat";
    case ErrorCode::Damaged:
        return "Damaged";
    case ErrorCode::UnsupportedVersion:
        return "UnsupportedVersion";
    case ErrorCode::InvalidMesh:
        return "InvalidMesh";
    case ErrorCode::InvalidOptions:
        return "InvalidOptions";
    case ErrorCode::InvalidScene:
        return "InvalidScene";
    case ErrorCode::Diverged:
        return "Diverged";
    }
    return "Internal";
}

constexpr std::string_view kOutOfMemory =
    "the module's memory does not suffice; delete() what is no longer needed, or take a smaller model or map";

} // namespace

void note_error() noexcept {
    try {
        throw;
    } catch (const Error& error) {
        last_error.set(name_of(error.code()), error.what());
    } catch (const std::bad_alloc&) {
        last_error.set("OutOfMemory", kOutOfMemory);
    } catch (const std::length_error&) { // a container cannot be that large
        last_error.set("OutOfMemory", kOutOfMemory);
    } catch (const std::exception& error) {
        last_error.set("Internal", error.what());
    } catch (...) {
        last_error.set("Internal", "an exception of an unknown kind");
    }
}

ECHINUS_EXPORT(last_error_code) const char* last_error_code() {
    return last_error.code;
}
ECHINUS_EXPORT(last_error_sentence) const char* last_error_sentence() {
    return last_error.sentence;
}

ECHINUS_EXPORT(text_bytes) const char* text_bytes(const Text* text) {
    return text->bytes.data();
}
ECHINUS_EXPORT(text_size) std::uint32_t text_size(const Text* text) {
    return static_cast<std::uint32_t>(text->bytes.size());
}
ECHINUS_EXPORT(text_delete) void text_delete(Text* text) {
    delete text;
}

/// Memory for JavaScript, in whole vectors; 0 when there is not enough.
ECHINUS_EXPORT(memory_take) void* memory_take(std::uint32_t byte_count) {
    return guarded([&] { return ::operator new (byte_count, std::align_val_t{16}); });
}
ECHINUS_EXPORT(memory_give_back) void memory_give_back(void* first) {
    ::operator delete (first, std::align_val_t{16});
}

} // namespace echinus::wasm
