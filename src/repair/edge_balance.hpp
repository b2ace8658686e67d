#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace echinus {

/// How many more faces of a mesh run one way along each edge than the other: its *imbalance*, 0 at every edge
/// of a closed mesh. repair() drops faces only where that leaves no edge with a larger imbalance, so it never
/// opens a closed mesh.
class EdgeBalance {
  public:
    using Faces = std::vector<std::uint32_t>;
    static constexpr std::uint32_t kNoEdge = std::numeric_limits<std::uint32_t>::max();

    /// @pre indices are in range
    explicit EdgeBalance(const TriangleMesh& mesh);

    std::size_t edge_count() const { return sums_.size(); }
    /// The three edges of a face, numbered from 0, or kNoEdge three times where two of its corners are equal.
    std::span<const std::uint32_t, 3> edges_of(std::uint32_t face) const {
        return std::span(edges_of_face_).subspan(3 * std::size_t{face}).first<3>();
    }

    /// By how much the imbalances fall in total if these faces, each named once, are dropped.
    std::ptrdiff_t gain_without(const Faces& faces);

    /// The faces of as many sets as can be dropped together without a larger imbalance anywhere. Sets at an
    /// edge where all of them together would leave one are given up, and so on. Time O(n log n) of the faces
    /// in the sets.
    /// @param sets  disjoint
    Faces droppable(std::vector<Faces> sets);

    void drop(const Faces& faces) { add(faces, -1); }

  private:
    std::size_t imbalance(std::uint32_t edge) const {
        return static_cast<std::size_t>(sums_[edge] < 0 ? -sums_[edge] : sums_[edge]);
    }
    Faces edges_at(const Faces& faces) const;
    void add(const Faces& faces, std::int32_t count);

    std::vector<std::uint32_t> edges_of_face_; ///< [3 * face_count]
    std::vector<std::int8_t> directions_;      ///< [3 * face_count] 1 or -1
    std::vector<std::int32_t> sums_;           ///< [edge_count]
};

} // namespace echinus
