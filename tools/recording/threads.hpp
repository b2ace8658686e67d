#pragma once

#include <echinus/mesh_io.hpp>
#include <echinus/simulation.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Threads of a cloth: edges without faces. Among faces a piece of thread is { a, b, b }, a face without
/// area, as for echinus::intersecting_pairs().

/// The structural constraints that are not edges of faces.
std::vector<std::array<std::uint32_t, 2>> threads_of(const echinus::Deformable& cloth);

/// The faces of a cloth, followed by its threads.
std::vector<echinus::Triangle> surface_of(const echinus::Deformable& cloth);
std::vector<echinus::Triangle> surface_of(const echinus::MeshAndEdges& cloth);

/// The parts of a deformable that files contain: its faces, its threads, and the particles that these use, in
/// the order of the particles. Interior particles of a soft body are left out.
class VisibleSurface {
  public:
    explicit VisibleSurface(const echinus::Deformable& deformable);

    std::size_t vertex_count() const { return particles_.size(); }
    /// @param positions  [particle_count]
    std::vector<echinus::Vec3f> vertices(std::span<const echinus::Vec3f> positions) const;
    echinus::MeshAndEdges mesh(std::span<const echinus::Vec3f> positions) const;

  private:
    std::vector<std::uint32_t> particles_; ///< by vertex
    std::vector<echinus::Triangle> faces_;
    std::vector<std::array<std::uint32_t, 2>> threads_;
};

/// For drawing: the mesh, and a tube of kTubeFaces faces along each piece of thread, in the order of the
/// pieces. A tube's thickness is 0.3 times the mean length of the pieces.
echinus::TriangleMesh with_tubes(const echinus::MeshAndEdges& cloth);
inline constexpr std::uint32_t kTubeFaces = 12;
