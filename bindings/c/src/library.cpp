// Errors, arrays, the version and the instruction sets.

#include "border.hpp"
#include "files/text.hpp"

#include <echinus/error.hpp>
#include <echinus/instruction_set.hpp>
#include <echinus/version.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <new>

namespace echinus::c {

namespace {

/// The last error sentence of each thread. Its size is fixed, since there would be no memory for it after
/// memory has run out.
class Sentence {
  public:
    void set(std::string_view function, std::string_view text) {
        size_ = 0;
        bytes_[kCapacity] = '\0';
        add(function);
        if (!function.empty()) add(": ");
        add(text);
        // Do not cut in the middle of a character: bytes 10xxxxxx continue one.
        if (size_ == kCapacity)
            while (size_ > 0 && (static_cast<unsigned char>(bytes_[size_]) & 0xC0) == 0x80) --size_;
        bytes_[size_] = '\0';
    }
    const char* c_str() const { return bytes_; }

  private:
    static constexpr std::size_t kCapacity = 2047;

    void add(std::string_view text) {
        // One byte more than the visible text, so that set() sees whether it continues a character.
        const std::size_t room = sizeof bytes_ - size_;
        text.copy(bytes_ + size_, room);
        size_ = std::min(size_ + text.size(), kCapacity);
    }

    char bytes_[kCapacity + 1] = "";
    std::size_t size_ = 0;
};

thread_local Sentence last_sentence;

static_assert(ECHINUS_UNREADABLE == static_cast<int>(ErrorCode::Unreadable) + 1 &&
              ECHINUS_UNWRITABLE == static_cast<int>(ErrorCode::Unwritable) + 1 &&
              ECHINUS_WRONG_FORMAT == static_cast<int>(ErrorCode::WrongFormat) + 1 &&
              ECHINUS_DAMAGED == static_cast<int>(ErrorCode::Damaged) + 1 &&
              ECHINUS_UNSUPPORTED_VERSION == static_cast<int>(ErrorCode::UnsupportedVersion) + 1 &&
              ECHINUS_INVALID_MESH == static_cast<int>(ErrorCode::InvalidMesh) + 1 &&
              ECHINUS_INVALID_OPTIONS == static_cast<int>(ErrorCode::InvalidOptions) + 1 &&
              ECHINUS_INVALID_SCENE == static_cast<int>(ErrorCode::InvalidScene) + 1 &&
              ECHINUS_DIVERGED == static_cast<int>(ErrorCode::Diverged) + 1);

echinus_status note(echinus_status status, std::string_view function, std::string_view sentence) {
    last_sentence.set(function, sentence);
    return status;
}

constexpr std::string_view kOutOfMemory =
    "out of memory; destroy objects that are no longer needed, or use a smaller model or map";

} // namespace

echinus_status note_error(const char* function) noexcept {
    try {
        throw;
    } catch (const Error& error) {
        return note(static_cast<echinus_status>(static_cast<int>(error.code()) + 1), "", error.what());
    } catch (const WrongArgument& error) {
        return note(ECHINUS_INVALID_ARGUMENT, function, error.what());
    } catch (const std::bad_alloc&) {
        return note(ECHINUS_OUT_OF_MEMORY, function, kOutOfMemory);
    } catch (const std::length_error&) { // a container cannot be that large
        return note(ECHINUS_OUT_OF_MEMORY, function, kOutOfMemory);
    } catch (const std::exception& error) {
        return note(ECHINUS_INTERNAL, function, error.what());
    } catch (...) {
        return note(ECHINUS_INTERNAL, function, "an exception of an unknown kind");
    }
}

void require_index(std::size_t index, std::size_t count, const char* name) {
    if (index >= count) throw WrongArgument(no_such_text(name, std::to_string(index), count));
}

std::size_t times(std::size_t count, std::size_t width, const char* name) {
    if (count > std::numeric_limits<std::ptrdiff_t>::max() / width)
        throw WrongArgument("the count of " + std::string(name) + ", " + std::to_string(count) +
                            ", is more than memory can hold");
    return count * width;
}

Vec3d finite_vector_at(const double* first, const char* name) {
    at(first, name);
    const Vec3d vector{first[0], first[1], first[2]};
    if (!is_finite(vector)) throw WrongArgument(std::string(name) + " is not finite");
    return vector;
}

void require_size(std::size_t size, std::size_t known_size, std::size_t first_size, const char* name) {
    // The upper bound detects a size that was never set.
    constexpr std::size_t kLargest = 4096;
    if (size >= first_size && size <= kLargest) return;
    throw WrongArgument("the size of " + std::string(name) + " is " + std::to_string(size) +
                        "; expected sizeof, " + std::to_string(known_size) +
                        ": fill options by their _init function and set the size of " + "results");
}

void require_zero(const void* first, std::size_t known_size, std::size_t size, const char* name) {
    const auto* bytes = static_cast<const unsigned char*>(first);
    for (std::size_t i = known_size; i < size; ++i)
        if (bytes[i] != 0)
            throw WrongArgument(std::string(name) + " sets a member that version " + version() +
                                " of the library does not have");
}

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

const char* echinus_status_name(echinus_status status) {
    std::int32_t number = 0; // the caller may have stored any number
    std::memcpy(&number, &status, sizeof number);
    switch (number) {
    case ECHINUS_OK:
        return "ECHINUS_OK";
    case ECHINUS_UNREADABLE:
        return "ECHINUS_UNREADABLE";
    case ECHINUS_UNWRITABLE:
        return "ECHINUS_UNWRITABLE";
    case ECHINUS_WRONG_FORMAT:
        return "ECHINUS_WRONG_FORMAT";
    case ECHINUS_DAMAGED:
        return "ECHINUS_DAMAGED";
    case ECHINUS_UNSUPPORTED_VERSION:
        return "ECHINUS_UNSUPPORTED_VERSION";
    case ECHINUS_INVALID_MESH:
        return "ECHINUS_INVALID_MESH";
    case ECHINUS_INVALID_OPTIONS:
        return "ECHINUS_INVALID_OPTIONS";
    case ECHINUS_INVALID_SCENE:
        return "ECHINUS_INVALID_SCENE";
    case ECHINUS_DIVERGED:
        return "ECHINUS_DIVERGED";
    case ECHINUS_INVALID_ARGUMENT:
        return "ECHINUS_INVALID_ARGUMENT";
    case ECHINUS_OUT_OF_MEMORY:
        return "ECHINUS_OUT_OF_MEMORY";
    case ECHINUS_INTERNAL:
        return "ECHINUS_INTERNAL";
    default:
        return "unknown status";
    }
}

const char* echinus_last_error(void) {
    return last_sentence.c_str();
}

const char* echinus_version(void) {
    return version();
}

// The names are literals, so they end with a zero.
const char* echinus_instruction_set(void) {
    return instruction_set().data();
}

const char* echinus_available_instruction_set(size_t number) {
    const char* name = nullptr;
    guarded(__func__, [&] {
        const auto names = available_instruction_sets();
        if (number < names.size()) name = names[number].data();
    });
    return name;
}

echinus_status echinus_use_instruction_set(const char* name) {
    return guarded(__func__, [&] { use_instruction_set(&at(name, "name")); });
}

const void* echinus_array_data(const echinus_array* array) {
    return array == nullptr ? nullptr : array->data;
}
size_t echinus_array_count(const echinus_array* array) {
    return array == nullptr ? 0 : array->count;
}
void echinus_array_destroy(echinus_array* array) {
    delete array;
}
