#pragma once

#include "geometry/workers.hpp"
#include "mechanics/linear/block_matrix.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The positions of a step, in double, since the residual of stiff material is a small difference between
/// large forces.
using Places = std::span<const Vec3d>;

/// The rows of the gradient and of the Hessian that one thread writes. An element that extends into two slabs
/// is computed for both, so each row sums its elements in their order for any number of threads.
struct RowSlab {
    std::uint32_t begin = 0, end = 0;
    bool has(std::uint32_t row) const { return row >= begin && row < end; }
};

/// Elements by the slabs of rows that they write to.
class SlabLists {
  public:
    /// @param particles_of  (element) returns the range of particles that the element couples
    template <typename ParticlesOf>
    SlabLists(std::size_t row_count, std::size_t element_count, const ParticlesOf& particles_of)
        : row_count_(static_cast<std::uint32_t>(row_count)),
          elements_(Workers::piece_count(row_count, kRowsPerPiece)) {
        for (std::uint32_t element = 0; element < element_count; ++element)
            for (const std::uint32_t particle : particles_of(element)) {
                std::vector<std::uint32_t>& list = elements_[particle / kRowsPerPiece];
                if (list.empty() || list.back() != element) list.push_back(element);
            }
    }

    /// Calls body(element, slab) for all elements of all slabs.
    template <typename Body>
    void for_each(const Workers& workers, const Body& body) const {
        workers.for_pieces(elements_.size(), [&](std::size_t, std::size_t piece) {
            const auto begin = static_cast<std::uint32_t>(piece * kRowsPerPiece);
            const auto size = static_cast<std::uint32_t>(kRowsPerPiece);
            const RowSlab slab{begin, row_count_ - begin < size ? row_count_ : begin + size};
            for (const std::uint32_t element : elements_[piece]) body(element, slab);
        });
    }

  private:
    std::uint32_t row_count_;
    std::vector<std::vector<std::uint32_t>> elements_;
};

/// The sum of term(i) over all i: each piece is summed separately, and the pieces are added in order.
template <typename Term>
double sum_of(std::size_t count, const Workers& workers, const Term& term) {
    constexpr std::size_t kPerPiece = 2048;
    ScratchVector<double> sums(Workers::piece_count(count, kPerPiece), workers.scratch());
    workers.for_ranges(count, kPerPiece,
                       [&](std::size_t, std::size_t piece, std::size_t begin, std::size_t end) {
                           double sum = 0;
                           for (std::size_t i = begin; i < end; ++i) sum += term(i);
                           sums[piece] = sum;
                       });
    double sum = 0;
    for (const double part : sums) sum += part;
    return sum;
}

} // namespace echinus
