#include <echinus/echinus.hpp>

#include <cstdio>

int main() {
    using namespace echinus;
    const TriangleMesh torus = make_torus(1.0, 0.4, 60, 24); // the paper's: 2880 faces
    const ExactMap map = ExactMap::build(torus);             // once; milliseconds

    for (const Vec3f particle : {Vec3f{1.3F, 0, 0}, Vec3f{1, 0, 0.3F}, Vec3f{0, 0, 0}}) {
        const Contact answer = contact(map, particle);
        std::printf("%s, %.2f deep, the way out leads to (%.2f, %.2f, %.2f)\n",
                    answer.inside ? "inside" : "outside", answer.depth, answer.point.x, answer.point.y,
                    answer.point.z);
    }
}
