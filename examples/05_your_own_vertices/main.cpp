// Positions are read in place from your own vertex structs, and a model that is moved, turned and scaled
// keeps the map it was built with.

#include <echinus/echinus.hpp>

#include <cstdio>
#include <numbers>
#include <vector>

namespace {

struct Vertex { // as an engine might have it
    float u, v;
    echinus::Vec3f position;
    unsigned colour;
};

} // namespace

int main() {
    using namespace echinus;
    Collider box{.map = ExactMap::build(make_box({1, 1, 1}))};
    box.pose = {Rotation::about({0, 0, 1}, std::numbers::pi / 4), {100, 0, 0}};
    box.scale = {2, 2, 2}; // now a cube of edge length 2 that is centred at x = 100, turned by 45 degrees

    std::vector<Vertex> vertices;
    for (int i = 0; i <= 8; ++i) {
        vertices.push_back({0, 0, {98.0F + 0.5F * static_cast<float>(i), 0, 0}, 0xFFFFFFU});
    }

    const StridedSpan<const Vec3f> positions(&vertices.front().position, vertices.size(), sizeof(Vertex));
    std::vector<Contact> contacts(vertices.size());
    contacts_batch(box, positions, 0.0F, contacts);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        std::printf("x = %5.1f: %s, depth %.2f\n", positions[i].x, contacts[i].inside ? "inside" : "outside",
                    contacts[i].depth);
    }
}
