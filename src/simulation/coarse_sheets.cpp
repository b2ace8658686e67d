#include "simulation/coarse_sheets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace echinus {

namespace {

using Level = CoarseSheets::Level;
using Between = CoarseSheets::Between;

/// Of the sticks of a level, forwards and backwards.
constexpr int kSweeps = 2;

/// Particles in rows and columns, row by row from the first one on.
struct Grid {
    std::uint32_t first, column_count, row_count;

    std::size_t count() const { return std::size_t{column_count} * row_count; }
};

/// The two faces of a square, as make_cloth() lays them.
bool is_square(std::span<const Triangle> faces, std::uint32_t corner, std::uint32_t column_count) {
    const std::uint32_t above = corner + column_count;
    return faces[0] == Triangle{corner, corner + 1, above + 1} &&
           faces[1] == Triangle{corner, above + 1, above};
}

/// The sheet that begins with these faces, if one does.
std::optional<Grid> grid_at(std::span<const Triangle> faces) {
    if (faces.size() < 2 || faces[1][2] <= faces[0][0] + 1) return std::nullopt;
    Grid grid{faces[0][0], faces[1][2] - faces[0][0], 1};
    const std::size_t faces_per_row = 2 * (std::size_t{grid.column_count} - 1);
    while (faces.size() >= faces_per_row) {
        const std::uint32_t row = grid.first + (grid.row_count - 1) * grid.column_count;
        for (std::uint32_t c = 0; c + 1 < grid.column_count; ++c)
            if (!is_square(faces.subspan(2 * std::size_t{c}), row + c, grid.column_count)) return grid;
        ++grid.row_count;
        faces = faces.subspan(faces_per_row);
    }
    return grid;
}

std::vector<Grid> grids_of(std::span<const Triangle> faces) {
    std::vector<Grid> grids;
    while (faces.size() >= 2) {
        const std::optional<Grid> grid = grid_at(faces);
        const bool is_sheet = grid && grid->row_count > 1;
        if (is_sheet) grids.push_back(*grid);
        faces = faces.subspan(is_sheet ? 2 * (std::size_t{grid->column_count} - 1) * (grid->row_count - 1)
                                       : std::size_t{1});
    }
    return grids;
}

/// How long the sticks of a sheet are at rest, by the particle that has the lower row, or column.
class RestLengths {
  public:
    RestLengths(const Grid& grid, std::span<const Stick> sticks) : grid_(grid) {
        for (std::vector<float>& lengths : lengths_) lengths.assign(grid.count(), kNone);
        for (const Stick& stick : sticks) add(std::min(stick.a, stick.b), std::max(stick.a, stick.b), stick);
    }

    /// Along the sticks from one particle to another that is steps of one direction away.
    /// @return infinity where there are none
    float along(std::uint32_t row, std::uint32_t column, int rows, int columns) const {
        const int steps = std::max(std::abs(rows), std::abs(columns));
        const int down = rows > 0 ? 1 : 0, right = (columns > 0) - (columns < 0);
        const std::vector<float>& lengths = lengths_[static_cast<std::size_t>(3 * down + right + 1)];
        double sum = 0;
        for (int i = 0; i < steps; ++i)
            sum += double{lengths[(row + static_cast<std::uint32_t>(i * down)) * grid_.column_count + column +
                                  static_cast<std::uint32_t>(i * right)]};
        return static_cast<float>(sum);
    }

  private:
    void add(std::uint32_t low, std::uint32_t high, const Stick& stick) {
        if (low < grid_.first || high - grid_.first >= grid_.count()) return;
        const std::uint32_t from = low - grid_.first, to = high - grid_.first;
        const int down =
            static_cast<int>(to / grid_.column_count) - static_cast<int>(from / grid_.column_count);
        const int right =
            static_cast<int>(to % grid_.column_count) - static_cast<int>(from % grid_.column_count);
        if (down > 1 || right < -1 || right > 1) return;
        lengths_[static_cast<std::size_t>(3 * down + right + 1)][from] = stick.rest_length;
    }

    static constexpr float kNone = std::numeric_limits<float>::infinity();
    Grid grid_;
    std::array<std::vector<float>, 6> lengths_; ///< by direction: 3 * rows + columns + 1
};

/// Every stride-th number below count, and the last one.
std::vector<std::uint32_t> every(std::uint32_t stride, std::uint32_t count) {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < count - 1; i += stride) numbers.push_back(i);
    numbers.push_back(count - 1);
    return numbers;
}

std::vector<Between> between(const std::vector<std::uint32_t>& fine,
                             const std::vector<std::uint32_t>& coarse) {
    std::vector<Between> all;
    std::uint32_t cell = 0;
    for (const std::uint32_t number : fine) {
        while (cell + 2 < coarse.size() && coarse[cell + 1] <= number) ++cell;
        const std::uint32_t before = coarse[cell], after = coarse[cell + 1];
        all.push_back({cell, static_cast<float>(number - before) / static_cast<float>(after - before)});
    }
    return all;
}

/// What the particles of a level weigh, and which of them stand still.
struct Masses {
    std::vector<double> masses;
    std::vector<std::uint8_t> is_held;
};

Masses masses_of(const Grid& grid, std::span<const float> inverse_masses) {
    Masses all;
    for (std::size_t i = 0; i < grid.count(); ++i) {
        const float inverse_mass = inverse_masses[grid.first + i];
        all.masses.push_back(inverse_mass > 0 ? 1 / double{inverse_mass} : 0);
        all.is_held.push_back(inverse_mass > 0 ? 0 : 1);
    }
    return all;
}

/// Each particle of the finer level weighs on those between which it stands; one that is held, holds the
/// nearest.
Masses coarser(const Masses& fine, const Level& level, std::size_t coarse_row_count,
               std::size_t coarse_column_count) {
    const std::size_t count = coarse_row_count * coarse_column_count;
    Masses coarse{std::vector<double>(count, 0), std::vector<std::uint8_t>(count, 0)};
    std::size_t i = 0;
    for (const Between& row : level.rows_between)
        for (const Between& column : level.columns_between) {
            const std::size_t corner = row.cell * coarse_column_count + column.cell;
            const std::size_t above = corner + coarse_column_count;
            const double down = row.share, right = column.share;
            coarse.masses[corner] += fine.masses[i] * (1 - down) * (1 - right);
            coarse.masses[corner + 1] += fine.masses[i] * (1 - down) * right;
            coarse.masses[above] += fine.masses[i] * down * (1 - right);
            coarse.masses[above + 1] += fine.masses[i] * down * right;
            if (fine.is_held[i] != 0)
                coarse.is_held[(down > 0.5 ? above : corner) + (right > 0.5 ? 1 : 0)] = 1;
            ++i;
        }
    return coarse;
}

/// The levels of a sheet.
class Maker {
  public:
    Maker(const Grid& grid, const Deformable& deformable)
        : grid_(grid), lengths_(grid, deformable.sticks),
          masses_(masses_of(grid, deformable.inverse_masses)) {}

    CoarseSheets::Sheet make() {
        CoarseSheets::Sheet sheet{grid_.first, grid_.column_count, {level(1)}};
        const std::uint32_t longest = std::max(grid_.row_count, grid_.column_count) - 1;
        for (std::uint32_t stride = 2; stride <= longest; stride *= 2) {
            Level next = level(stride);
            Level& last = sheet.levels.back();
            last.rows_between = between(last.rows, next.rows);
            last.columns_between = between(last.columns, next.columns);
            masses_ = coarser(masses_, last, next.rows.size(), next.columns.size());
            add_sticks(next);
            sheet.levels.push_back(std::move(next));
        }
        return sheet;
    }

  private:
    Level level(std::uint32_t stride) const {
        Level level;
        level.rows = every(stride, grid_.row_count);
        level.columns = every(stride, grid_.column_count);
        level.starts.resize(level.count());
        level.places.resize(level.count());
        return level;
    }

    /// To the right, down, and along both diagonals of the squares.
    void add_sticks(Level& level) const {
        for (std::uint32_t r = 0; r < level.rows.size(); ++r)
            for (std::uint32_t c = 0; c < level.columns.size(); ++c) {
                add_stick(level, r, c, 0, 1);
                add_stick(level, r, c, 1, 0);
                add_stick(level, r, c, 1, 1);
                add_stick(level, r, c, 1, -1);
            }
    }

    void add_stick(Level& level, std::uint32_t row, std::uint32_t column, int down, int right) const {
        const auto other_row = static_cast<std::size_t>(row + static_cast<std::uint32_t>(down));
        const auto other_column = static_cast<std::size_t>(column + static_cast<std::uint32_t>(right));
        if (other_row >= level.rows.size() || other_column >= level.columns.size()) return;
        const int rows = static_cast<int>(level.rows[other_row]) - static_cast<int>(level.rows[row]);
        const int columns =
            static_cast<int>(level.columns[other_column]) - static_cast<int>(level.columns[column]);
        if (down != 0 && right != 0 && rows != std::abs(columns))
            return; // no diagonals of squares lead there
        const auto a = static_cast<std::uint32_t>(row * level.columns.size() + column);
        const auto b = static_cast<std::uint32_t>(other_row * level.columns.size() + other_column);
        const double mobility_a = mobility(a), mobility_b = mobility(b), sum = mobility_a + mobility_b;
        const float rest_length = lengths_.along(level.rows[row], level.columns[column], rows, columns);
        if (sum == 0 || !std::isfinite(rest_length)) return;
        level.sticks.push_back(
            {a, b, static_cast<float>(mobility_a / sum), static_cast<float>(mobility_b / sum), rest_length});
    }

    double mobility(std::uint32_t i) const {
        return masses_.is_held[i] != 0 || masses_.masses[i] == 0 ? 0 : 1 / masses_.masses[i];
    }

    Grid grid_;
    RestLengths lengths_;
    Masses masses_; ///< of the last level
};

void relax_stick(const CoarseSheets::CoarseStick& stick, std::vector<Vec3f>& places) {
    const Vec3f across = places[stick.b] - places[stick.a];
    const float length_sq = dot(across, across);
    if (!(length_sq > stick.rest_length * stick.rest_length)) return;
    const Vec3f correction = across * (1 - stick.rest_length / std::sqrt(length_sq));
    places[stick.a] += correction * stick.share_a;
    places[stick.b] -= correction * stick.share_b;
}

void relax_sticks(Level& level) {
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        if (sweep % 2 == 0)
            for (auto stick = level.sticks.begin(); stick != level.sticks.end(); ++stick)
                relax_stick(*stick, level.places);
        else
            for (auto stick = level.sticks.rbegin(); stick != level.sticks.rend(); ++stick)
                relax_stick(*stick, level.places);
}

/// Calls move(number, way) for the particles of the finer level.
template <typename Move>
void interpolate(const Level& fine, const Level& coarse, const Move& move) {
    const std::size_t columns = coarse.columns.size();
    const auto way = [&](std::size_t i) { return coarse.places[i] - coarse.starts[i]; };
    std::size_t i = 0;
    for (const Between& row : fine.rows_between) {
        const std::size_t corner = row.cell * columns;
        const auto way_between = [&](std::size_t column) {
            const Vec3f before = way(corner + column);
            return before + (way(corner + columns + column) - before) * row.share;
        };
        std::size_t cell = 0;
        Vec3f before = way_between(0), after = way_between(1);
        for (const Between& column : fine.columns_between) {
            for (; cell < column.cell; ++cell) before = std::exchange(after, way_between(cell + 2));
            move(i++, before + (after - before) * column.share);
        }
    }
}

void relax(CoarseSheets::Sheet& sheet, Particles& particles) {
    for (std::size_t l = 1; l < sheet.levels.size(); ++l) {
        Level& level = sheet.levels[l];
        std::size_t i = 0;
        for (const std::uint32_t row : level.rows)
            for (const std::uint32_t column : level.columns)
                level.starts[i++] = particles.positions[sheet.first + row * sheet.column_count + column];
        level.places = level.starts;
    }
    for (std::size_t l = sheet.levels.size() - 1; l > 0; --l) {
        Level& fine = sheet.levels[l - 1];
        relax_sticks(sheet.levels[l]);
        if (l > 1) {
            interpolate(fine, sheet.levels[l],
                        [&](std::size_t i, const Vec3f& way) { fine.places[i] += way; });
            continue;
        }
        interpolate(fine, sheet.levels[l], [&](std::size_t i, const Vec3f& way) {
            const std::size_t particle = sheet.first + i;
            particles.move(particle, way * particles.mobility[particle]);
        });
    }
}

} // namespace

CoarseSheets::CoarseSheets(const Deformable& deformable) {
    for (const Grid& grid : grids_of(deformable.faces)) {
        Sheet sheet = Maker(grid, deformable).make();
        if (sheet.levels.size() > 1) sheets_.push_back(std::move(sheet));
    }
}

void CoarseSheets::relax(Particles& particles) {
    for (Sheet& sheet : sheets_) echinus::relax(sheet, particles);
}

} // namespace echinus
