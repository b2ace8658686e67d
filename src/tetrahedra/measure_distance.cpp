#include "geometry/whole_numbers.hpp"
#include "mesh/local_frame.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/tetrahedra.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

namespace echinus {

namespace {

constexpr std::size_t kPointsPerBatch = 65'536;

double mean_edge(const TriangleMesh& mesh) {
    double sum = 0;
    for (const Triangle& face : mesh.faces)
        for (std::size_t i = 0; i < 3; ++i)
            sum += length(Vec3d(mesh.vertices[face[(i + 1) % 3]]) - Vec3d(mesh.vertices[face[i]]));
    return sum / static_cast<double>(3 * mesh.faces.size());
}

/// Collects samples and measures their distances in batches.
class Sampler {
  public:
    Sampler(const ExactMapView& target, unsigned thread_count)
        : target_(target), thread_count_(thread_count) {}

    void add(const Vec3d& point) {
        points_.emplace_back(point);
        if (points_.size() == kPointsPerBatch) measure();
    }

    /// The mean and the greatest distance of all samples.
    std::pair<double, double> finish() {
        measure();
        return {sum_ / static_cast<double>(std::max<std::size_t>(count_, 1)), greatest_};
    }

  private:
    void measure() {
        distances_.resize(points_.size());
        signed_distance_batch(target_, points_, distances_, {}, thread_count_);
        for (const float distance : distances_) {
            sum_ += std::abs(double{distance});
            greatest_ = std::max(greatest_, std::abs(double{distance}));
        }
        count_ += points_.size();
        points_.clear();
    }

    const ExactMapView& target_;
    unsigned thread_count_;
    std::vector<Vec3f> points_;
    std::vector<float> distances_;
    double sum_ = 0, greatest_ = 0;
    std::size_t count_ = 0;
};

/// Samples a face at points with equal steps along two of its edges. The steps are no longer than the
/// spacing, but there are at most 64 per side.
void sample_face(const std::array<Vec3d, 3>& p, double spacing, Sampler& sampler) {
    const double longest = std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
    const int steps = truncated_to<int>(std::clamp(std::ceil(longest / spacing), 1.0, 64.0));
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j)
            sampler.add(p[0] + (p[1] - p[0]) * (double{1} * i / steps) +
                        (p[2] - p[0]) * (double{1} * j / steps));
}

std::pair<double, double> distances(const TriangleMesh& from, const ExactMapView& to, double spacing,
                                    unsigned thread_count) {
    Sampler sampler(to, thread_count);
    for (const Triangle& face : from.faces)
        sample_face(
            {Vec3d(from.vertices[face[0]]), Vec3d(from.vertices[face[1]]), Vec3d(from.vertices[face[2]])},
            spacing, sampler);
    return sampler.finish();
}

} // namespace

BoundaryDistance measure_distance(const TetrahedralMesh& mesh, const ExactMapView& model,
                                  unsigned thread_count) {
    require_valid_tetrahedra(mesh);
    TriangleMesh surface = boundary(mesh);
    move_to_origin(model.origin, surface);
    const double spacing = mean_edge(surface);
    const ExactMap map = ExactMap::build(surface, {.thread_count = thread_count});
    BoundaryDistance result;
    std::tie(result.mean_to_model, result.greatest_to_model) =
        distances(surface, model, spacing, thread_count);
    std::tie(result.mean_to_boundary, result.greatest_to_boundary) =
        distances(reconstruct_surface(model).mesh, map, spacing, thread_count);
    return result;
}

} // namespace echinus
