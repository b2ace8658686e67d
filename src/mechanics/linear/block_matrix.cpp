#include "mechanics/linear/block_matrix.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace echinus {

Block inverse(const Block& block) {
    std::array<std::array<double, 3>, 3> m{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) m[i][j] = double{block(i, j)};
    const auto cofactor = [&](std::size_t i, std::size_t j) {
        const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
        return m[a][c] * m[b][d] - m[a][d] * m[b][c];
    };
    const double determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
    Block result;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            result.columns[j].set(i, static_cast<float>(cofactor(j, i) / determinant));
    return result;
}

namespace {

void sort_unique(std::vector<Coupling>& couplings) {
    std::sort(couplings.begin(), couplings.end());
    couplings.erase(std::unique(couplings.begin(), couplings.end()), couplings.end());
}

/// @param couplings  ascending and unique
template <typename Value>
void set_rows(Rows<Value>& rows, std::size_t row_count, std::span<const Coupling> couplings) {
    rows.first.assign(row_count + 1, 0);
    rows.columns.clear();
    for (const Coupling& coupling : couplings) {
        ++rows.first[coupling[0] + 1];
        rows.columns.push_back(coupling[1]);
    }
    for (std::size_t row = 0; row < row_count; ++row) rows.first[row + 1] += rows.first[row];
    rows.values.assign(rows.columns.size(), Value{});
}

template <typename Value>
std::uint32_t find(const Rows<Value>& rows, std::uint32_t row, std::uint32_t column) {
    const auto begin = rows.columns.begin() + rows.first[row],
               end = rows.columns.begin() + rows.first[row + 1];
    const auto found = std::lower_bound(begin, end, column);
    if (found == end || *found != column) return BlockMatrix::kNone;
    return static_cast<std::uint32_t>(found - rows.columns.begin());
}

} // namespace

void BlockMatrix::set_pattern(std::size_t row_count, std::vector<Coupling> coupled,
                              std::vector<Coupling> coupled_by_multiples) {
    for (std::uint32_t row = 0; row < row_count; ++row) coupled.push_back({row, row});
    sort_unique(coupled);
    sort_unique(coupled_by_multiples);
    std::vector<Coupling> far;
    std::set_difference(coupled_by_multiples.begin(), coupled_by_multiples.end(), coupled.begin(),
                        coupled.end(), std::back_inserter(far));
    set_rows(blocks, row_count, coupled);
    set_rows(multiples, row_count, far);
    set_rows(contacts, row_count, {});
    diagonal.resize(row_count);
    for (std::uint32_t row = 0; row < row_count; ++row) diagonal[row] = find_block(row, row);
}

std::uint32_t BlockMatrix::find_block(std::uint32_t row, std::uint32_t column) const {
    return find(blocks, row, column);
}

std::uint32_t BlockMatrix::find_multiple(std::uint32_t row, std::uint32_t column) const {
    return find(multiples, row, column);
}

void BlockMatrix::set_contacts() {
    contacts.columns.clear();
    contacts.values.clear();
    order_contacts_by_rows();
    row_slots_.resize(row_count(), kNone);
    for (std::size_t row = 0; row < row_count(); ++row) {
        sum_row(std::span(contact_order_)
                    .subspan(contacts.first[row], contacts.first[row + 1] - contacts.first[row]));
        contacts.first[row] = static_cast<std::uint32_t>(contacts.columns.size());
        for (const std::uint32_t column : row_columns_) {
            contacts.columns.push_back(column);
            contacts.values.push_back(row_values_[row_slots_[column]]);
            row_slots_[column] = kNone;
        }
    }
    contacts.first[row_count()] = static_cast<std::uint32_t>(contacts.columns.size());
}

/// Sums the added entries of a row by columns. Close layers add many for the same column, so only the columns
/// are sorted and not the entries.
void BlockMatrix::sum_row(std::span<const std::uint32_t> numbers) {
    row_columns_.clear();
    row_values_.clear();
    for (const std::uint32_t number : numbers) {
        const AddedContact& entry = added_contacts_[number];
        std::uint32_t& slot = row_slots_[entry.at[1]];
        if (slot != kNone) {
            row_values_[slot] += entry.value;
            continue;
        }
        slot = static_cast<std::uint32_t>(row_columns_.size());
        row_columns_.push_back(entry.at[1]);
        row_values_.push_back(entry.value);
    }
    std::sort(row_columns_.begin(), row_columns_.end());
}

/// Sets `contacts.first` to the position at which the added entries of each row begin in their order.
void BlockMatrix::order_contacts_by_rows() {
    contacts.first.assign(row_count() + 1, 0);
    for (const AddedContact& entry : added_contacts_) ++contacts.first[entry.at[0] + 1];
    std::partial_sum(contacts.first.begin(), contacts.first.end(), contacts.first.begin());
    contact_order_.resize(added_contacts_.size());
    // Each row's entry is advanced to the position of its next element, and so ends where the next row
    // begins.
    for (std::uint32_t number = 0; number < added_contacts_.size(); ++number)
        contact_order_[contacts.first[added_contacts_[number].at[0]]++] = number;
    std::copy_backward(contacts.first.begin(), contacts.first.end() - 1, contacts.first.end());
    contacts.first.front() = 0;
}

void BlockMatrix::clear() {
    std::fill(blocks.values.begin(), blocks.values.end(), Block{});
    std::fill(multiples.values.begin(), multiples.values.end(), 0.0F);
    added_contacts_.clear();
    set_contacts();
}

void BlockMatrix::invert_diagonal(const Workers& workers) {
    inverse_diagonal.resize(row_count());
    workers.for_ranges(row_count(), kRowsPerPiece,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           for (std::size_t row = begin; row < end; ++row)
                               inverse_diagonal[row] = inverse(blocks.values[diagonal[row]]);
                       });
}

void BlockMatrix::multiply(std::span<const Float4> x, std::span<Float4> result,
                           const Workers& workers) const {
    workers.for_ranges(row_count(), kRowsPerPiece,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           for (std::size_t row = begin; row < end; ++row) result[row] = row_times(row, x);
                       });
}

} // namespace echinus
