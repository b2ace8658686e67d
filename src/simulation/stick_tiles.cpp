#include "simulation/stick_tiles.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace echinus {

namespace {

/// Sticks of a long run that are worth a piece of work.
constexpr std::size_t kSticksPerTile = 1024;

constexpr std::size_t kRowsPerGroup = 4;
/// Along a row and to the rows before, for each particle of it.
constexpr std::size_t kSticksAlong = 2, kSticksAcross = 4;
constexpr std::size_t kLeastWidth = 32; ///< of columns, in particles
/// By so many places columns lean to the left from row to row: as far as the two diagonals of squares reach.
constexpr std::size_t kLean = 2;

bool is_long(const StickRun& run) {
    return run.shape == RunShape::Disjoint && run.count >= 2 * kSticksPerTile;
}

/// Sticks from one row of a sheet to the next.
bool joins_rows(const StickRun& run) {
    return run.shape == RunShape::SideBySide && run.a < run.b;
}

/// Where a sheet's particles stand, as far as runs of sticks show it.
class Rows {
  public:
    Rows(std::span<const StickRun> runs, std::size_t column_count) {
        std::map<std::uint32_t, std::size_t> counts;
        for (const StickRun& run : runs)
            if (joins_rows(run)) counts[run.b - run.a] += run.count;
        if (counts.empty()) return;
        const auto by_count = [](const auto& a, const auto& b) { return a.second < b.second; };
        length_ = std::max_element(counts.begin(), counts.end(), by_count)->first;
        first_ = runs.front().a;
        for (const StickRun& run : runs)
            if (joins_rows(run)) first_ = std::min<std::size_t>(first_, run.a);
        width_ = std::max(length_ / column_count, kLeastWidth);
    }

    bool empty() const { return length_ == 0; }
    std::size_t sticks_along() const { return kRowsPerGroup * kSticksAlong * length_; }
    std::size_t sticks_across() const { return kRowsPerGroup * kSticksAcross * length_; }
    std::uint32_t column(std::size_t particle) const {
        const std::size_t place = particle < first_ ? 0 : particle - first_;
        return static_cast<std::uint32_t>((place % length_ + kLean * (place / length_)) / width_);
    }

  private:
    std::size_t length_ = 0, first_ = 0, width_ = kLeastWidth;
};

/// Some sticks of a run that belong to one tile of a step.
struct Part {
    std::size_t step, tile;
    StickRun run;
};

class Cutter {
  public:
    Cutter(const StickArrays& sticks, std::size_t particle_count, std::size_t thread_count)
        : sticks_(sticks), thread_count_(thread_count), columns_(particle_count), owners_(particle_count),
          first_steps_(particle_count) {}

    StickTiles cut() {
        const std::span<const StickRun> runs(sticks_.runs);
        for (std::size_t first = 0, end = 0; first < runs.size(); first = end) {
            if (is_long(runs[first])) {
                end = first + 1;
                cut_long(runs[first]);
                continue;
            }
            while (end < runs.size() && !is_long(runs[end])) ++end;
            cut_sheet(runs.subspan(first, end - first));
        }
        return std::move(tiles_);
    }

  private:
    void cut_long(const StickRun& run) {
        begin_step();
        for (std::size_t first = 0; first < run.count; first += kSticksPerTile) {
            begin_tile();
            add(part_of(run, first, std::min(kSticksPerTile, run.count - first)));
        }
    }

    void cut_sheet(std::span<const StickRun> runs) {
        const Rows rows(runs, thread_count_);
        if (rows.empty()) {
            begin_step();
            begin_tile();
            for (const StickRun& run : runs) add(run);
            return;
        }
        parts_.clear();
        const std::vector<StickRun> across = find_rows(runs, rows);
        for (std::size_t i = 0; i < columns_.size(); ++i) columns_[i] = rows.column(i);
        std::fill(first_steps_.begin(), first_steps_.end(), kNever);
        std::size_t stick_count = 0;
        for (const StickRun& run : across) {
            cut_run(run, stick_count / rows.sticks_across());
            stick_count += run.count;
        }
        add_rows();
        // Within a tile, and from group to group, the order stays.
        std::stable_sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
            return std::pair(a.step, a.tile) < std::pair(b.step, b.tile);
        });
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            const bool is_new_step = i == 0 || parts_[i].step != parts_[i - 1].step;
            if (is_new_step) begin_step();
            if (is_new_step || parts_[i].tile != parts_[i - 1].tile) begin_tile();
            add(parts_[i].run);
        }
    }

    /// Runs along rows whose particles no other run has touched before. @return the others
    std::vector<StickRun> find_rows(std::span<const StickRun> runs, const Rows& rows) {
        std::fill(owners_.begin(), owners_.end(), kNobody);
        rows_.clear();
        std::vector<StickRun> others;
        std::size_t stick_count = 0;
        for (const StickRun& run : runs) {
            const bool is_along = run.shape == RunShape::Neighbours || run.shape == RunShape::EverySecond;
            const bool fits_anywhere = is_along && belongs_to(run, kNobody);
            if (fits_anywhere && (rows_.empty() || stick_count >= rows.sticks_along())) {
                rows_.emplace_back();
                stick_count = 0;
            }
            const std::size_t tile = rows_.size();
            const bool fits = fits_anywhere || (is_along && tile > 0 && belongs_to(run, tile));
            for_each_particle(run, [&](std::uint32_t particle) { owners_[particle] = fits ? tile : kOther; });
            (fits ? rows_.back() : others).push_back(run);
            stick_count += run.count;
        }
        return others;
    }

    /// Or to nobody.
    bool belongs_to(const StickRun& run, std::size_t owner) const {
        bool belongs = true;
        for_each_particle(run, [&](std::uint32_t particle) {
            belongs = belongs && (owners_[particle] == kNobody || owners_[particle] == owner);
        });
        return belongs;
    }
    template <typename Visit>
    void for_each_particle(const StickRun& run, const Visit& visit) const {
        for (std::size_t i = run.first; i < run.first + run.count; ++i) {
            visit(sticks_.a[i]);
            visit(sticks_.b[i]);
        }
    }

    /// Each tile of rows in the step before its particles are needed, while they are in the cache.
    void add_rows() {
        for (std::size_t tile = 0; tile < rows_.size(); ++tile) {
            std::size_t needed = kNever;
            for (const StickRun& run : rows_[tile])
                for_each_particle(
                    run, [&](std::uint32_t particle) { needed = std::min(needed, first_steps_[particle]); });
            const std::size_t step = needed == kNever ? 0 : needed - 1;
            for (const StickRun& run : rows_[tile]) parts_.push_back({step, kFirstTileOfRows + tile, run});
        }
    }

    /// Into parts that each lie in one column. The first step is left to rows.
    void cut_run(const StickRun& run, std::size_t group) {
        const std::size_t unit = run.shape == RunShape::EverySecond ? 2 : 1;
        std::size_t first = 0;
        std::uint32_t column = 0;
        const auto add_part = [&](std::size_t end) {
            const Part& part =
                parts_.emplace_back(Part{1 + group + column, group, part_of(run, first, end - first)});
            for_each_particle(part.run, [&](std::uint32_t particle) {
                first_steps_[particle] = std::min(first_steps_[particle], part.step);
            });
            first = end;
        };
        for (std::size_t i = 0; i < run.count; i += unit) {
            const std::uint32_t next = claim_column(run.first + i, std::min(unit, run.count - i));
            if (i > 0 && next != column) add_part(i);
            column = next;
        }
        add_part(run.count);
    }

    /// The column of sticks that stay together: the last one of their particles, which move there.
    std::uint32_t claim_column(std::size_t first, std::size_t count) {
        std::uint32_t column = 0;
        for (std::size_t i = first; i < first + count; ++i)
            column = std::max({column, columns_[sticks_.a[i]], columns_[sticks_.b[i]]});
        for (std::size_t i = first; i < first + count; ++i)
            columns_[sticks_.a[i]] = columns_[sticks_.b[i]] = column;
        return column;
    }

    void begin_step() { tiles_.steps.push_back({tiles_.tiles.size(), 0}); }
    void begin_tile() {
        tiles_.tiles.push_back({tiles_.parts.size(), 0});
        ++tiles_.steps.back().count;
    }
    void add(const StickRun& part) {
        tiles_.parts.push_back(part);
        ++tiles_.tiles.back().count;
    }

    static constexpr std::size_t kNobody = 0, kOther = static_cast<std::size_t>(-1), kNever = kOther;
    static constexpr std::size_t kFirstTileOfRows = kNever / 2; ///< beyond the numbers of groups

    const StickArrays& sticks_;
    std::size_t thread_count_;
    // By particle.
    std::vector<std::uint32_t> columns_;      ///< so far
    std::vector<std::size_t> owners_;         ///< the tile of rows, counted from 1
    std::vector<std::size_t> first_steps_;    ///< in which it is touched across rows
    std::vector<std::vector<StickRun>> rows_; ///< tiles of runs along rows
    std::vector<Part> parts_;
    StickTiles tiles_;
};

} // namespace

StickTiles cut_into_tiles(const StickArrays& sticks, std::size_t particle_count, std::size_t thread_count) {
    return Cutter(sticks, particle_count, thread_count).cut();
}

} // namespace echinus
