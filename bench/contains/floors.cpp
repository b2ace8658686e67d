// What every system pays: the stream of particles, and one look into a table.

#include "contains/system.hpp"

#include <cmath>

using namespace echinus;

namespace {

/// Reads each particle and writes its byte: is it within the sphere that bounds the mesh?
class Stream : public ContainsSystem {
  public:
    void build(const TriangleMesh& mesh) override { sphere_ = inspect(mesh).bounding_sphere; }
    std::size_t byte_count() const override { return 0; }
    std::vector<ContainsWay> ways() override {
        return {{"stream", [this](std::span<const Vec3f> points, std::span<std::uint8_t> inside) {
                     const Vec3f centre(sphere_.centre);
                     const auto radius_sq = static_cast<float>(sphere_.radius * sphere_.radius);
                     const std::size_t count = points.size();
                     const Vec3f* const p = points.data();
                     std::uint8_t* const out = inside.data();
#pragma omp simd
                     for (std::size_t i = 0; i < count; ++i) {
                         const float x = p[i].x - centre.x, y = p[i].y - centre.y, z = p[i].z - centre.z;
                         out[i] = x * x + y * y + z * z < radius_sq ? 1 : 0;
                     }
                 }}};
    }

  protected:
    Sphere sphere_;
};

/// A map of directions with one radius each: an octahedral square of 256 x 256 floats, the nearest sample,
/// one gather a particle. It answers for the sphere.
class OneGather : public Stream {
  public:
    void build(const TriangleMesh& mesh) override {
        Stream::build(mesh);
        radii_.assign(kSide * kSide, static_cast<float>(sphere_.radius));
    }
    std::size_t byte_count() const override { return radii_.size() * sizeof(float); }
    std::vector<ContainsWay> ways() override {
        return {{"one gather", [this](std::span<const Vec3f> points, std::span<std::uint8_t> inside) {
                     const Vec3f centre(sphere_.centre);
                     const float* const radii = radii_.data();
                     const std::size_t count = points.size();
                     const Vec3f* const p = points.data();
                     std::uint8_t* const out = inside.data();
#pragma omp simd
                     for (std::size_t i = 0; i < count; ++i) {
                         const float x = p[i].x - centre.x, y = p[i].y - centre.y, z = p[i].z - centre.z;
                         const float radius = radii[sample_of(x, y, z)];
                         out[i] = x * x + y * y + z * z < radius * radius ? 1 : 0;
                     }
                 }}};
    }

  private:
    static constexpr std::int32_t kSide = 256;

    /// The octahedron unfolded into a square (Meyer et al. 2010, "On Floating-Point Normal Vectors").
    static std::int32_t sample_of(float x, float y, float z) {
        const float scale = 1 / (std::fabs(x) + std::fabs(y) + std::fabs(z) + 1e-30F);
        const float u = x * scale, v = y * scale;
        const float folded_u = z < 0 ? std::copysign(1 - std::fabs(v), u) : u;
        const float folded_v = z < 0 ? std::copysign(1 - std::fabs(u), v) : v;
        constexpr float kHalf = 0.4999F * static_cast<float>(kSide);
        const auto column = static_cast<std::int32_t>((folded_u + 1) * kHalf);
        const auto row = static_cast<std::int32_t>((folded_v + 1) * kHalf);
        return row * kSide + column;
    }

    std::vector<float> radii_;
};

} // namespace

void list_floors(ContainsList& list) {
    list.push_back(listed<Stream, ContainsSystem>("floor", Role::Floor, true));
    list.push_back(listed<OneGather, ContainsSystem>("floor", Role::Floor, true));
}
