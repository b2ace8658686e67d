#pragma once

#include <CLI/CLI.hpp>

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

/// Two counts written as "200x200".
struct GridArgument {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
};

/// Lets CLI11 read a GridArgument; a refusal becomes its "wrong use" with the option's name.
inline bool lexical_cast(const std::string& text, GridArgument& grid) {
    const auto read_count = [](std::string_view digits, std::uint32_t& count) {
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
        return error == std::errc{} && end == digits.data() + digits.size();
    };
    const std::size_t cross = text.find('x');
    return cross != std::string::npos && read_count(std::string_view(text).substr(0, cross), grid.first) &&
           read_count(std::string_view(text).substr(cross + 1), grid.second);
}
