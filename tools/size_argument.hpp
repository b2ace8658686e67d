#pragma once

#include <echinus/geometry.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <string_view>

/// Three lengths written as "1x0.5x2".
struct SizeArgument {
    echinus::Vec3d lengths;
};

/// Lets CLI11 read a SizeArgument; a refusal becomes its "wrong use" with the option's name.
inline bool lexical_cast(const std::string& text, SizeArgument& size) {
    std::string_view rest = text;
    std::array<double, 3> lengths{};
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        const std::string_view number = rest.substr(0, i < 2 ? rest.find('x') : std::string_view::npos);
        const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), lengths[i]);
        if (error != std::errc{} || end != number.data() + number.size()) return false;
        rest.remove_prefix(std::min(number.size() + 1, rest.size()));
    }
    size.lengths = {lengths[0], lengths[1], lengths[2]};
    return true;
}
