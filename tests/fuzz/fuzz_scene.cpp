#include "support/attacks.hpp"

#include <echinus/error.hpp>
#include <echinus_scene/scene.hpp>

#include <cstdint>
#include <string_view>

using namespace echinus;

namespace {

/// Larger ones are as they were asked for, and take long.
bool is_small(const Scene& scene) {
    constexpr std::uint64_t kMostParticles = 2000;
    return std::uint64_t{scene.cloth.column_count} * scene.cloth.row_count <= kMostParticles &&
           !scene.mesh_cloth && scene.bodies.empty();
}

} // namespace

/// A scene either is refused with an Error or can be made into a deformable, unless the generators say why
/// not.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Scene scene;
    try {
        scene = parse_scene({reinterpret_cast<const char*>(data), size}, "attack");
    } catch (const Error& error) {
        test::require_sentence(error.what(), "attack");
        return 0;
    }
    try {
        if (is_small(scene)) make_deformable(scene);
    } catch (const Error&) {
        return 0;
    }
    return 0;
}
