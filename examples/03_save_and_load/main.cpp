// Building belongs to the workshop, querying to the program that ships: save the map, load it elsewhere.
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

    // Half the bytes: distances in 16 bits, off by at most 7.6e-6 of the model's radius.
    const DistanceMap built =
        DistanceMap::build(make_torus(1.0, 0.4, 60, 24), {.entry_format = EntryFormat::Unorm16});
    save(built, path);

    const DistanceMap map = load_distance_map(path);
    std::printf("%s: %zu directions, %zu entries, %zu bytes\n", path.c_str(), map.view().direction_count(),
                map.view().entry_count(), map.view().byte_count());

    // A thousand points on a line through the torus, answered in one call.
    std::vector<Vec3f> points;
    for (int i = 0; i < 1000; ++i) points.emplace_back(-2.0F + 0.004F * static_cast<float>(i), 0.0F, 0.0F);
    std::vector<std::uint8_t> inside(points.size());
    contains_batch(map, points, inside);
    int inside_count = 0;
    for (const std::uint8_t flag : inside) inside_count += flag;
    std::printf("%d of %zu points are inside; by the tube's two diameters 400 are expected\n", inside_count,
                points.size());
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
