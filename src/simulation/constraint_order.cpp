#include "simulation/constraint_order.hpp"

#include "simulation/constraint_schedule.hpp"

#include <algorithm>
#include <bitset>
#include <numeric>
#include <utility>

namespace echinus {

namespace {

/// Puts constraints into as few packs without a common particle as there are, each into the emptiest one that
/// has none of its particles.
class Packer {
  public:
    explicit Packer(const ConstraintParticles& constraints)
        : constraints_(constraints), packs_at_(constraints.particle_count()) {}

    /// Adds them to `order`, pack by pack.
    void pack(std::span<const std::uint32_t> slab, std::vector<std::uint32_t>& order) {
        constexpr std::size_t kMost = kMostPacks * kConstraintsPerPack;
        for (std::size_t first = 0; first < slab.size(); first += kMost)
            pack_some(slab.subspan(first, std::min(kMost, slab.size() - first)), order);
    }

  private:
    static constexpr std::size_t kMostPacks = 128;
    using Packs = std::bitset<kMostPacks>;

    /// What finds no place begins anew.
    void pack_some(std::span<const std::uint32_t> some, std::vector<std::uint32_t>& order) {
        std::vector<std::uint32_t> left(some.begin(), some.end()), next, packed;
        while (!left.empty()) {
            sizes_.assign(std::max<std::size_t>(left.size() / kConstraintsPerPack, 1), 0);
            packed.resize(sizes_.size() * kConstraintsPerPack);
            next.clear();
            for (const std::uint32_t constraint : left) {
                const std::size_t pack = emptiest_without(constraint);
                if (pack == sizes_.size()) {
                    next.push_back(constraint);
                    continue;
                }
                packed[pack * kConstraintsPerPack + sizes_[pack]++] = constraint;
                for (const std::uint32_t particle : constraints_.of(constraint))
                    packs_at_[particle].set(pack);
            }
            for (const std::uint32_t constraint : left)
                for (const std::uint32_t particle : constraints_.of(constraint)) packs_at_[particle].reset();
            for (std::size_t pack = 0; pack < sizes_.size(); ++pack)
                for (std::size_t i = 0; i < sizes_[pack]; ++i)
                    order.push_back(packed[pack * kConstraintsPerPack + i]);
            left.swap(next);
        }
    }
    /// @return the pack, or their number if none has a place
    std::size_t emptiest_without(std::uint32_t constraint) const {
        Packs taken;
        for (const std::uint32_t particle : constraints_.of(constraint)) taken |= packs_at_[particle];
        std::size_t best = sizes_.size(), least = kConstraintsPerPack;
        for (std::size_t pack = 0; pack < sizes_.size(); ++pack) {
            if (taken[pack] || sizes_[pack] >= least) continue;
            best = pack;
            least = sizes_[pack];
        }
        return best;
    }

    const ConstraintParticles& constraints_;
    std::vector<Packs> packs_at_;    ///< that have the particle
    std::vector<std::size_t> sizes_; ///< of the packs
};

/// From the least to the greatest number of a constraint's particles.
struct Span {
    std::uint32_t first, last;
    std::uint32_t length() const { return last - first; }
};

std::vector<Span> spans_of(const ConstraintParticles& constraints) {
    std::vector<Span> spans;
    for (std::size_t i = 0; i < constraints.count(); ++i) {
        const auto of = constraints.of(i);
        const auto [first, last] = std::minmax_element(of.begin(), of.end());
        spans.push_back({*first, *last});
    }
    return spans;
}

/// But for the few that reach far, as from the last ring of a torus to its first.
std::uint32_t usual_length(const std::vector<Span>& spans) {
    constexpr std::size_t kFew = 20; // one of
    std::vector<std::uint32_t> lengths;
    for (const Span& span : spans) lengths.push_back(span.length());
    const auto usual = lengths.end() - 1 - static_cast<std::ptrdiff_t>(lengths.size() / kFew);
    std::nth_element(lengths.begin(), usual, lengths.end());
    return *usual;
}

struct Slabs {
    std::vector<std::vector<std::uint32_t>> slabs; ///< of constraints
    std::vector<std::uint32_t> rest;               ///< that reach beyond the next slab
};

std::vector<std::uint32_t> as_they_stand(std::size_t count) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    return order;
}

/// By their particles' numbers. A slab is at least as long as its constraints reach into the next, so that
/// not even a line of memory is common to the two on both sides of it.
Slabs slabs_of(const ConstraintParticles& constraints, std::size_t per_slab) {
    constexpr std::uint32_t kParticlesPerLine = 16;
    constexpr std::size_t kFewestSlabs = 3; // of two, none would be relaxed beside another
    const std::vector<Span> spans = spans_of(constraints);
    const std::uint32_t reach = usual_length(spans);
    Slabs all;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order; // by the first particle
    for (std::uint32_t i = 0; i < spans.size(); ++i)
        if (spans[i].length() > reach)
            all.rest.push_back(i);
        else
            order.emplace_back(spans[i].first, i);
    std::sort(order.begin(), order.end());
    std::uint32_t begin = 0;
    for (const auto& [first, i] : order) {
        const bool is_full = !all.slabs.empty() && all.slabs.back().size() >= per_slab &&
                             first >= begin + reach + kParticlesPerLine;
        if (all.slabs.empty() || is_full) {
            all.slabs.emplace_back();
            begin = first;
        }
        all.slabs.back().push_back(i);
    }
    if (all.slabs.size() > 1 && all.slabs.back().size() < per_slab) {
        std::vector<std::uint32_t>& last = all.slabs[all.slabs.size() - 2];
        last.insert(last.end(), all.slabs.back().begin(), all.slabs.back().end());
        all.slabs.pop_back();
    }
    // In the order in which they were given: edges before what only stiffens. A cloth that is relaxed from
    // one end to the other may tremble for ever.
    for (std::vector<std::uint32_t>& slab : all.slabs) std::sort(slab.begin(), slab.end());
    if (all.slabs.size() < kFewestSlabs) return {.slabs = {as_they_stand(constraints.count())}, .rest = {}};
    return all;
}

} // namespace

std::vector<std::uint32_t> relaxation_order(const ConstraintParticles& constraints, std::size_t per_slab) {
    if (constraints.count() == 0) return {};
    const Slabs all = slabs_of(constraints, per_slab);
    Packer packer(constraints);
    std::vector<std::uint32_t> order;
    for (const std::size_t parity : {0, 1})
        for (std::size_t slab = parity; slab < all.slabs.size(); slab += 2)
            packer.pack(all.slabs[slab], order);
    packer.pack(all.rest, order);
    return order;
}

} // namespace echinus
