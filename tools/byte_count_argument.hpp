#pragma once

#include <CLI/CLI.hpp>

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

/// A number of bytes written with its unit, as "300KB" or "0.3MB"; nothing for any other text.
inline std::optional<std::size_t> parse_byte_count(std::string_view text) {
    constexpr std::pair<std::string_view, double> kUnits[] = {{"B", 1},
                                                              {"KB", 1e3},
                                                              {"MB", 1e6},
                                                              {"GB", 1e9},
                                                              {"KiB", 1024},
                                                              {"MiB", 1024 * 1024},
                                                              {"GiB", 1024 * 1024 * 1024}};
    constexpr double kMost = 1e15; // so that it is a number of bytes
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{}) return {};
    const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
    for (const auto& [name, size] : kUnits)
        if (unit == name && number * size >= 1 && number * size <= kMost)
            return static_cast<std::size_t>(number * size);
    return {};
}

/// An option that takes a number of bytes.
inline CLI::Option* add_byte_count(CLI::App& command, const std::string& option, std::size_t& variable,
                                   const std::string& description) {
    const auto store = [option, &variable](const std::string& text) {
        const std::optional<std::size_t> bytes = parse_byte_count(text);
        if (!bytes)
            throw CLI::ValidationError(
                option, "must be a number of bytes, at least one and at most 1000000GB, with "
                        "one of the units B, KB, MB, GB, KiB, MiB and GiB, such as 300KB, not " +
                            text);
        variable = *bytes;
    };
    return command.add_option_function<std::string>(option, store, description)->type_name("SIZE");
}
