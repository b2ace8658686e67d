#pragma once

#include "rivals/system.hpp"

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

namespace echinus::rivals {

struct SampledField;

/// How one sample of a field is stored.
enum class SampleFormat : std::uint8_t {
    Float32,
    /// In steps of 1/32767 of the largest distance, rounded to nearest: half the bytes, and half the gathers,
    /// since two neighbours are one word.
    Snorm16,
};

struct DenseGridOptions {
    SampleFormat format = SampleFormat::Float32;
    unsigned thread_count = 1; ///< of the build; 0: all cores. The samples do not depend on it.
    /// How far the grid reaches beyond the mesh's box on each side, in the mesh's unit; at most the longest
    /// side. Beyond the grid there are no contacts: with 0 there are none above the mesh's highest point.
    double padding = 0;
};

/// Signed distances at the nodes of a regular grid over the mesh's own box, or a padded one, read by
/// trilinear interpolation: what a programmer writes without a library, and the speed to beat. The samples
/// are exact, from ExactMap.
///
/// Wrong by interpolation. The signed distance of a solid changes by at most the distance moved (its gradient
/// has length 1: Osher and Fedkiw, "Level Set Methods and Dynamic Implicit Surfaces", 2003, chapter 2), and
/// the interpolation is a mean of eight corners, so its error is at most the weighted mean of the distances
/// to them: at most sqrt(sum of w_i |p - c_i|^2) = spacing sqrt(sum of t (1 - t)) over the three axes, which
/// is largest at a cell's centre: sqrt(3) / 2 of the spacing. value_error_bound() adds the rounding of the
/// samples. Where the distance is smooth it is second order: spacing^2 / 8 times the sum of its second
/// derivatives along the axes. The side of a particle is certain where the field is farther from 0 than the
/// bound; details thinner than the spacing may be lost.
class DenseGrid final : public System {
  public:
    /// Offsets of 16-bit samples have 31 bits.
    static constexpr std::size_t kMaxNodes = std::size_t{1} << 30;
    static constexpr std::uint32_t kMaxSamples = 1U << 20; ///< along the longest side

    /// This many samples along the longest side of the grid's box, and as close along the others. Time
    /// O(samples), each a nearest point.
    /// @param mesh  closed; inside is where the winding number is not 0
    /// @throws Error InvalidMesh as inspect() does, for an open mesh, or when the bounding radius lies
    /// outside [1e-15, 1e15]; InvalidOptions for a padding out of range, or unless sample_count
    /// lies in [2, kMaxSamples] and there are at most kMaxNodes nodes
    static DenseGrid with_samples(const TriangleMesh& mesh, std::uint32_t sample_count,
                                  const DenseGridOptions& options = {});

    /// The finest spacing with which the samples take at most so many bytes.
    /// @throws Error as above; InvalidOptions for a budget below 8 samples or above kMaxNodes
    static DenseGrid with_bytes(const TriangleMesh& mesh, std::size_t byte_budget,
                                const DenseGridOptions& options = {});

    /// @param spacing  of the nodes, in the mesh's unit; positive, at most the grid's longest side
    /// @throws Error as above
    static DenseGrid with_spacing(const TriangleMesh& mesh, double spacing,
                                  const DenseGridOptions& options = {});

    std::string name() const override { return "dense"; }
    /// The samples alone: beside them a query reads some ten numbers.
    std::size_t byte_count() const override;
    std::string_view counted() const override { return "the samples of the grid"; }
    std::size_t node_count(int axis) const;
    double spacing() const; ///< in the mesh's unit

    /// By how much a sample may differ from the exact signed distance of the mesh on ExactMap's lattice.
    double sample_error_bound() const;
    /// By how much sample() may, anywhere in the box.
    double value_error_bound() const;

    /// The interpolation and its gradient.
    struct Sample {
        float distance = 0; ///< negative inside
        Vec3f gradient;     ///< of length 1, but for the interpolation's error; 0 beyond the box
    };
    /// The reference for the batches, bit for bit. Beyond the box, and where the point is not finite,
    /// distance and gradient are 0, which is outside.
    Sample sample(const Vec3f& point) const noexcept;

    /// The answers of contacts_batch(), with an array for each component. The normal is that of the field; a
    /// loop without branches computes it for every particle in the box. Depth is positive inside.
    struct Contacts {
        std::span<float> depths, normals_x, normals_y, normals_z; ///< [n] each
    };

    void contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const override;
    void contacts_batch(std::span<const Vec3f> points, const Contacts& contacts) const;
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const override;
    using System::contacts_batch;

  private:
    explicit DenseGrid(std::shared_ptr<const SampledField> field) : field_(std::move(field)) {}

    std::shared_ptr<const SampledField> field_;
};

} // namespace echinus::rivals
