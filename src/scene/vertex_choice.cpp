#include "scene/vertex_choice.hpp"

#include <echinus/error.hpp>

namespace echinus {

std::vector<std::uint32_t> chosen(const VertexChoice& choice, const std::vector<Vec3f>& vertices,
                                  const std::string& key) {
    if (const auto* numbers = std::get_if<std::vector<std::uint32_t>>(&choice)) return *numbers;
    const auto& [from, to] = std::get<VertexBox>(choice);
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        const Vec3d v(vertices[i]);
        if (v.x >= from.x && v.x <= to.x && v.y >= from.y && v.y <= to.y && v.z >= from.z && v.z <= to.z)
            found.push_back(i);
    }
    if (found.empty()) throw Error(ErrorCode::InvalidOptions, "none of its vertices is in the box of " + key);
    return found;
}

} // namespace echinus
