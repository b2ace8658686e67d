#pragma once

#include "rivals/system.hpp"

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

/// The strongest exact rival: a uniform grid of cubic cells over the mesh's box, each classified as inside,
/// outside or on the surface (after Li and Wang, "Fast and robust GPU-based point-in-polyhedron
/// determination", Computer-Aided Design 87, 2017, who classify the centres of cells). A cell on the surface
/// lists the faces that meet it and knows on which side its centre lies; a particle there counts the faces
/// between itself and that centre.
///
/// Written to be as good as we can: cells of two bits, in bricks of 4 x 4 x 4 of which only those on the
/// surface are stored; particles tested 16 at a time, each with its own cell; the same lattice of integers
/// and the same perturbation as ExactMap, so that both give the same answers on closed meshes.
namespace echinus::rivals {

struct GridArrays;

class ClassifiedGrid final : public System {
  public:
    /// The finest cells whose bytes fit, to about one part in a hundred.
    /// @param mesh  closed; inside is where the winding number is not 0
    /// @throws Error InvalidMesh as inspect() does, for an open mesh, or when the bounding radius lies
    /// outside [1e-15, 1e15]; InvalidOptions when the coarsest grid exceeds the budget
    static ClassifiedGrid build(const TriangleMesh& mesh, std::size_t byte_budget);

    /// With cells of a chosen size.
    /// @param cell_steps  edge of a cell in lattice steps, 1.9e-6 of the bounding radius each
    /// @throws Error as above; InvalidOptions when the cells are too many or too long for the format
    static ClassifiedGrid build_with_cells(const TriangleMesh& mesh, std::int32_t cell_steps);

    std::string name() const override { return "classified"; }
    /// All that a query reads, mesh included.
    std::size_t byte_count() const override;
    std::string_view counted() const override { return "cells, lists of faces, vertices and faces"; }

    /// Edge of a cell in lattice steps.
    std::int32_t cell_steps() const;

    /// Is the particle inside? Decided with exact integers: what contains_batch() is compared with.
    /// NaN, infinity and what is beyond the grid count as outside.
    bool contains(const Vec3f& point_local) const noexcept override;

    /// Inside?, and the nearest point of the surface when inside or within the margin. The global minimum, to
    /// the rounding of double; contacts_batch() rounds as float does.
    Contact contact(const Vec3f& point_local, float margin = 0) const noexcept override;

    /// contains() of many points, bit for bit. Allocates scratch memory. Any number of threads.
    /// @param inside  [n] 1 or 0. @pre points_local.size() == inside.size()
    void contains_batch(std::span<const Vec3f> points_local, std::span<std::uint8_t> inside) const override;

    /// contact() of many points. @param margin  not negative, NaN counts as 0
    /// @pre points_local.size() == contacts.size()
    void contacts_batch(std::span<const Vec3f> points_local, float margin,
                        std::span<Contact> contacts) const override;
    using System::contacts_batch;

  private:
    explicit ClassifiedGrid(std::shared_ptr<const GridArrays> arrays) : arrays_(std::move(arrays)) {}

    std::shared_ptr<const GridArrays> arrays_;
};

} // namespace echinus::rivals
