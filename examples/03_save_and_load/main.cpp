// Build a map once, ship the file: the program that loads it needs neither the mesh nor the builder.
// The file is verified before use and read in place.

#include <echinus/echinus.hpp>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <vector>

int main() try {
    using namespace echinus;
    const std::filesystem::path path = "torus.ech";

    const ExactMap built = ExactMap::build(make_torus(1.0, 0.4, 60, 24));
    save(built, path);

    const ExactMap map = load_exact_map(path);
    std::printf("%s: %zu faces, %zu cells, %zu bytes\n", path.string().c_str(), map.view().face_count(),
                map.view().cell_count(), map.view().byte_count());

    // A thousand points on a line through the torus, answered in one call.
    std::vector<Vec3f> points;
    for (int i = 0; i < 1000; ++i) points.emplace_back(-2.0F + 0.004F * static_cast<float>(i), 0.0F, 0.0F);
    std::vector<std::uint8_t> inside(points.size());
    contains_batch(map, points, inside);
    int inside_count = 0;
    for (const std::uint8_t flag : inside) inside_count += flag;
    std::printf("%d of %zu points are inside; from the tube's two diameters 400 are expected\n", inside_count,
                points.size());
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
