#include "mesh/components.hpp"

#include "geometry/union_find.hpp"
#include "geometry/whole_numbers.hpp"

#include <limits>

namespace echinus {

Components find_components(const TriangleMesh& mesh) {
    UnionFind sets(mesh.vertices.size());
    for (const Triangle& face : mesh.faces) {
        sets.join(face[0], face[1]);
        sets.join(face[0], face[2]);
    }
    constexpr std::uint32_t kUnnumbered = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> number_of_set(mesh.vertices.size(), kUnnumbered);
    Components components;
    components.of_face.reserve(mesh.faces.size());
    for (const Triangle& face : mesh.faces) {
        std::uint32_t& number = number_of_set[sets.find(face[0])];
        if (number == kUnnumbered) number = kept_as<std::uint32_t>(components.count++);
        components.of_face.push_back(number);
    }
    return components;
}

} // namespace echinus
