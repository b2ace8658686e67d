#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace echinus::test {

/// The contents of a page of `simulate --html`, read as docs/command_line.md describes it, without the
/// program's code.
struct PlayerPage {
    using Point = std::array<double, 3>;

    nlohmann::json description;
    std::vector<float> model_vertices;
    std::vector<std::uint32_t> model_faces, cloth_faces;
    std::vector<std::vector<Point>> positions; ///< of each frame

    explicit PlayerPage(const std::string& html);
};

} // namespace echinus::test
