#pragma once

#include "geometry/workers.hpp"

#include <cstddef>
#include <vector>

namespace echinus {

/// What the pieces of a parallel loop append to one list, in the order of the pieces.
template <typename T>
class PiecewiseList {
  public:
    void begin(const Workers& workers, std::size_t piece_count) {
        by_worker_.resize(workers.count());
        for (Part& part : by_worker_) part.items.clear();
        slices_.resize(piece_count);
    }
    /// Calls append(items) with a vector to append to. Once for each piece.
    template <typename Append>
    void add(std::size_t worker, std::size_t piece, const Append& append) {
        std::vector<T>& items = by_worker_[worker].items;
        const std::size_t first = items.size();
        append(items);
        slices_[piece] = {worker, first, items.size()};
    }
    /// Calls visit(item) for all, in order.
    template <typename Visit>
    void for_each(const Visit& visit) const {
        for (const Slice& slice : slices_)
            for (std::size_t i = slice.first; i < slice.end; ++i) visit(by_worker_[slice.worker].items[i]);
    }
    void append_to(std::vector<T>& all) const {
        for (const Slice& slice : slices_) {
            const auto begin = by_worker_[slice.worker].items.begin();
            all.insert(all.end(), begin + static_cast<std::ptrdiff_t>(slice.first),
                       begin + static_cast<std::ptrdiff_t>(slice.end));
        }
    }

  private:
    /// On cache lines of its own.
    struct alignas(64) Part {
        std::vector<T> items;
    };
    struct Slice {
        std::size_t worker = 0, first = 0, end = 0;
    };

    std::vector<Part> by_worker_;
    std::vector<Slice> slices_;
};

} // namespace echinus
