#include "mesh/box_tree.hpp"

#include "geometry/whole_numbers.hpp"

#include <algorithm>

namespace echinus {

namespace {

Vec3f lower(const Vec3f& a, const Vec3f& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

Vec3f upper(const Vec3f& a, const Vec3f& b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// The coordinate along which a box is longest. In double: the difference of two floats may exceed all
/// floats.
float Vec3f::*longest_side(const FaceBox& box) {
    const Vec3d side = Vec3d(box.high) - Vec3d(box.low);
    if (side.x >= side.y && side.x >= side.z) return &Vec3f::x;
    return side.y >= side.z ? &Vec3f::y : &Vec3f::z;
}

} // namespace

FaceBox FaceBox::around(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    return {lower(lower(a, b), c), upper(upper(a, b), c)};
}

FaceBox FaceBox::around(const FaceBox& a, const FaceBox& b) {
    return {lower(a.low, b.low), upper(a.high, b.high)};
}

BoxTree::BoxTree(const TriangleMesh& mesh) {
    leaves_.reserve(mesh.faces.size());
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
        const auto [a, b, c] = mesh.faces[face];
        leaves_.push_back({FaceBox::around(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]), face});
    }
    nodes_.reserve(leaves_.size());
    build(0, kept_as<std::uint32_t>(leaves_.size()));
}

void BoxTree::build(std::uint32_t begin, std::uint32_t end) {
    const auto index = kept_as<std::uint32_t>(nodes_.size());
    FaceBox box = leaves_[begin].box;
    for (std::uint32_t i = begin + 1; i < end; ++i) box = FaceBox::around(box, leaves_[i].box);
    nodes_.push_back({box, begin, end, 0});
    if (nodes_[index].is_leaf()) return;
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto side = longest_side(box);
    const auto centre = [side](const Leaf& leaf) { return double{leaf.box.low.*side} + leaf.box.high.*side; };
    std::nth_element(leaves_.begin() + begin, leaves_.begin() + middle, leaves_.begin() + end,
                     [&](const Leaf& p, const Leaf& q) { return centre(p) < centre(q); });
    build(begin, middle);
    nodes_[index].right = kept_as<std::uint32_t>(nodes_.size());
    build(middle, end);
}

} // namespace echinus
