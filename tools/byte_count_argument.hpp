#pragma once

#include <CLI/CLI.hpp>

#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

/// A number of bytes written with its unit, as "300KB" or "0.3MB".
struct ByteCountArgument {
    std::size_t bytes = 0;
};

/// Lets CLI11 read a ByteCountArgument; a refusal becomes its "wrong use" with the option's name.
inline bool lexical_cast(const std::string& text, ByteCountArgument& count) {
    constexpr std::pair<std::string_view, double> kUnits[] = {
        {"B", 1}, {"KB", 1e3}, {"MB", 1e6}, {"KiB", 1024}, {"MiB", 1024 * 1024}};
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const CLI::ValidationError wrong("--budget",
                                     "must be a number with one of the units B, KB, MB, KiB and MiB, such as "
                                     "300KB, not " +
                                         text);
    if (error != std::errc{}) throw wrong;
    const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
    for (const auto& [name, size] : kUnits) {
        if (name != unit) continue;
        constexpr double kMost = 1e15; // so that it is a number of bytes
        const double bytes = number * size;
        if (!(bytes >= 1 && bytes <= kMost)) throw wrong;
        count.bytes = static_cast<std::size_t>(bytes);
        return true;
    }
    throw wrong;
}
