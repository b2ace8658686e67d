#include <echinus/echinus.hpp>

#include <cstdio>

int main() {
    using namespace echinus;
    const TriangleMesh torus = make_torus(1.0, 0.4, 60, 24); // or read_mesh("model.obj")
    const ExactMap map = ExactMap::build(torus);             // once; milliseconds

    for (const Vec3f particle : {Vec3f{1.3F, 0.1F, 0.1F}, Vec3f{0.3F, 0.9F, 0.3F}, Vec3f{0, 0, 0}}) {
        const Contact answer = contact(map, particle);
        if (answer.inside)
            std::printf("inside, %.2f deep; the nearest point of the surface is (%.2f, %.2f, %.2f)\n",
                        answer.depth, answer.point.x, answer.point.y, answer.point.z);
        else
            std::printf("outside\n");
    }
}
