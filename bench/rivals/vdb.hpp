#pragma once

#include "rivals/depth_normal.hpp"

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

/// OpenVDB's sparse grid of signed distances: three samples deep outside, all of the inside, as many samples
/// across the bounding sphere as the paper's distance field has (200). Read by trilinear interpolation.
class OpenVdbRival {
  public:
    explicit OpenVdbRival(const echinus::TriangleMesh& mesh);
    ~OpenVdbRival();

    void contains(std::span<const echinus::Vec3f> points, std::span<std::uint8_t> inside) const;
    void contacts(std::span<const echinus::Vec3f> points, std::span<DepthNormal> contacts) const;

    std::size_t byte_count() const; ///< of the grid, by OpenVDB

    struct Impl;
    const Impl& impl() const { return *impl_; }

  private:
    std::unique_ptr<const Impl> impl_;
};

/// The same samples as NanoVDB stores them: one block of memory.
class NanoVdbRival {
  public:
    explicit NanoVdbRival(const echinus::TriangleMesh& mesh);
    ~NanoVdbRival();

    void contains(std::span<const echinus::Vec3f> points, std::span<std::uint8_t> inside) const;
    void contacts(std::span<const echinus::Vec3f> points, std::span<DepthNormal> contacts) const;

    std::size_t byte_count() const; ///< of the block

  private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};
