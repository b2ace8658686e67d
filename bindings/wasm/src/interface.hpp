#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

/// The module's exports: C functions of numbers, called by js/. Objects are handles, which are their
/// addresses; js/ ensures that each is deleted once and not used afterwards. A function that can fail returns
/// 0 when it does, and records the reason for last_error_code() and last_error_sentence().
///
/// Single requests and their results are JSON; data of many particles lie in the module's memory and are
/// passed by address.
#define ECHINUS_EXPORT(NAME) extern "C" __attribute__((export_name(#NAME)))

namespace echinus::wasm {

using nlohmann::json;

/// Bytes that JavaScript reads, UTF-8 where they are a text, and frees by text_delete().
struct Text {
    std::string bytes;
};

/// Records the current exception for JavaScript. Call from a handler.
void note_error() noexcept;

/// The result of `body`, or a zero of that type when it throws.
template <typename Body>
auto guarded(const Body& body) noexcept -> decltype(body()) {
    try {
        return body();
    } catch (...) {
        note_error();
        return {};
    }
}

/// A new object from the result of `body`, or null when it throws.
template <typename Body>
auto make_handle(const Body& body) noexcept {
    using Object = decltype(body());
    return guarded([&] { return new Object(body()); });
}

/// The text of a JSON value. Numbers that are not finite become null.
template <typename Body>
Text* make_json(const Body& body) noexcept {
    return make_handle([&] { return Text{json(body()).dump()}; });
}

inline std::string_view text_at(const char* first, std::uint32_t byte_count) {
    return {first, byte_count};
}

/// Values that JavaScript wrote into the module's memory.
template <typename T>
std::span<const T> values_at(const T* first, std::uint32_t count) {
    return {first, count};
}

} // namespace echinus::wasm
