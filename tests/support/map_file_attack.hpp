#pragma once

#include <echinus/error.hpp>
#include <echinus/map_file.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace echinus::test {

/// What a reader of hostile bytes must do: refuse them with an Error, or give a map that can be queried
/// anywhere, looked at, and written again so that it reads back the same.
/// @return  whether the bytes were taken as a map
/// @throws std::logic_error when it does something else
inline bool attack_map_file(std::span<const std::byte> bytes) {
    // A buffer of exactly this size: the address sanitizer sees every read beyond it.
    const auto storage = std::make_shared<std::vector<std::byte>>(bytes.begin(), bytes.end());
    storage->shrink_to_fit();
    std::optional<DistanceMap> map;
    try {
        map = load_distance_map(*storage, storage, "attacked");
    } catch (const Error& error) {
        const std::string sentence = error.what();
        const bool proper = sentence.starts_with("attacked: ") && sentence.find('\n') == std::string::npos;
        if (!proper) throw std::logic_error("not a proper sentence: " + sentence);
        return false;
    }
    std::size_t direction_count = 0;
    for (const std::size_t count : entry_histogram(*map)) direction_count += count;
    if (direction_count != map->view().direction_count()) throw std::logic_error("histogram is not complete");

    const std::vector<std::byte> written = serialise(*map);
    if (serialise(load_distance_map(written, nullptr, "written")) != written) {
        throw std::logic_error("what was written does not read back the same");
    }
    return true;
}

} // namespace echinus::test
