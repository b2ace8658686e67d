#pragma once

#include "geometry/workers.hpp"
#include "mechanics/linear/block.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The entries of a square matrix by rows, with ascending columns in each row.
template <typename Value>
struct Rows {
    std::vector<std::uint32_t> first{0}; ///< [row_count + 1]
    std::vector<std::uint32_t> columns;
    std::vector<Value> values;

    std::size_t row_count() const { return first.size() - 1; }
};

/// Two particles that a term of the energy couples.
using Coupling = std::array<std::uint32_t, 2>;

/// A symmetric matrix of 3 x 3 blocks, of which both triangles are stored. It has entries of three kinds:
/// - blocks on a pattern that is found once for a topology;
/// - multiples of the identity on a second such pattern, for bending, which couples particles that no face
///   joins: as blocks they would cause as much memory traffic as everything else;
/// - blocks where contacts couple particles, on a pattern that changes.
class BlockMatrix {
  public:
    Rows<Block> blocks; ///< including the diagonal of each row
    Rows<float> multiples;
    Rows<Block> contacts;                ///< none on the diagonal
    std::vector<std::uint32_t> diagonal; ///< [row_count] index in `blocks`
    std::vector<Block> inverse_diagonal; ///< [row_count] valid after invert_diagonal()

    std::size_t row_count() const { return diagonal.size(); }

    /// Sets both fixed patterns. @param coupled, coupled_by_multiples  in any order, possibly repeated;
    /// multiples for a coupling that is in both lists are added to its block
    void set_pattern(std::size_t row_count, std::vector<Coupling> coupled,
                     std::vector<Coupling> coupled_by_multiples);
    /// The index of the block in a row and a column. @return kNone if the pattern has none
    std::uint32_t find_block(std::uint32_t row, std::uint32_t column) const;
    std::uint32_t find_multiple(std::uint32_t row, std::uint32_t column) const;
    static constexpr std::uint32_t kNone = UINT32_MAX;

    /// Adds a block that contacts couple but the pattern does not contain.
    /// @pre the row differs from the column
    void add_contact(const Coupling& at, const Block& value) { added_contacts_.push_back({at, value}); }
    /// Adds a multiple of a block for a row and a column: to the pattern if it has them, otherwise as a
    /// contact.
    void add_coupling(const Coupling& at, const Block& block, float factor) {
        const std::uint32_t entry = at[0] == at[1] ? diagonal[at[0]] : find_block(at[0], at[1]);
        if (entry != kNone)
            blocks.values[entry].add_scaled(block, factor);
        else
            add_contact(at, block * factor);
    }
    /// Sets `contacts` to the blocks added since clear(): those of the same row and column are summed in
    /// their order.
    void set_contacts();

    /// Sets all values to 0 and removes all contacts.
    void clear();
    /// @pre each diagonal block is positive definite
    void invert_diagonal(const Workers& workers);

    /// The product of a row with x.
    Float4 row_times(std::size_t row, std::span<const Float4> x) const {
        Float4 sum;
        for (std::uint32_t e = blocks.first[row]; e < blocks.first[row + 1]; ++e)
            sum += blocks.values[e] * x[blocks.columns[e]];
        for (std::uint32_t e = multiples.first[row]; e < multiples.first[row + 1]; ++e)
            sum += x[multiples.columns[e]] * multiples.values[e];
        for (std::uint32_t e = contacts.first[row]; e < contacts.first[row + 1]; ++e)
            sum += contacts.values[e] * x[contacts.columns[e]];
        return sum;
    }
    /// result = A x
    void multiply(std::span<const Float4> x, std::span<Float4> result, const Workers& workers) const;

  private:
    struct AddedContact {
        Coupling at;
        Block value;
    };
    void order_contacts_by_rows();
    void sum_row(std::span<const std::uint32_t> numbers);

    std::vector<AddedContact> added_contacts_;
    std::vector<std::uint32_t> contact_order_;
    std::vector<std::uint32_t> row_columns_; ///< of the row that is summed
    std::vector<Block> row_values_;          ///< [slot] likewise
    std::vector<std::uint32_t> row_slots_;   ///< [column] its slot in the row that is summed, or kNone
};

/// The number of rows that one thread takes at once in a loop over rows. It is fixed, so that the result does
/// not depend on the number of threads.
inline constexpr std::size_t kRowsPerPiece = 1024;

} // namespace echinus
