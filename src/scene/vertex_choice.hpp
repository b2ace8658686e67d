#pragma once

#include <echinus_scene/scene.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace echinus {

/// The vertices' numbers. @param key  of the choice, for sentences
/// @throws Error InvalidOptions when there is none in a box
std::vector<std::uint32_t> chosen(const VertexChoice& choice, const std::vector<Vec3f>& vertices,
                                  const std::string& key);

} // namespace echinus
