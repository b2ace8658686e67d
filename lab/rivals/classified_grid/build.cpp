// From a mesh to a classified grid: faces are put into cells, then the winding number is carried along the
// rows of centres, from outside.

#include "exact_map/build/open_surface.hpp"
#include "exact_map/query/ray_crossing.hpp"
#include "rivals/classified_grid/classified_grid.hpp"
#include "rivals/classified_grid/face_cells.hpp"
#include "rivals/classified_grid/layout.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace echinus::rivals {

namespace {

constexpr std::size_t kNarrowLimit = std::numeric_limits<std::uint16_t>::max();
constexpr std::int32_t kMaxBricks = 1 << 28;
constexpr std::int32_t kMargin = 2 * GridFrame::kSlack; // what is beyond the grid is outside

/// The mesh on the lattice: every face, those without area too, since they count for distances.
struct SnappedMesh {
    LatticeMesh lattice;
    const std::vector<Triangle>& faces;
    Vec3<std::int32_t> low, high; ///< of the vertices that faces use

    explicit SnappedMesh(const TriangleMesh& mesh) : lattice(snap_to_lattice(mesh)), faces(mesh.faces) {
        if (!find_border(lattice).empty())
            throw Error(ErrorCode::InvalidMesh, "the mesh is open; a classified grid needs a closed one");
        LatticePoint least = lattice.vertices[faces[0][0]], most = least;
        for (const Triangle& face : faces)
            for (const std::uint32_t vertex : face) {
                const LatticePoint& p = lattice.vertices[vertex];
                least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
                most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
            }
        low = Vec3<std::int32_t>(least);
        high = Vec3<std::int32_t>(most);
    }
    /// The size at which one cell holds everything.
    std::int32_t coarsest_cell() const {
        return std::max({high.x - low.x, high.y - low.y, high.z - low.z}) + 2 * kMargin + 1;
    }
    std::array<LatticePoint, 3> corners(std::size_t face) const {
        return {lattice.vertices[faces[face][0]], lattice.vertices[faces[face][1]],
                lattice.vertices[faces[face][2]]};
    }
};

/// The grid of cells of a size, or nothing where they are too many.
std::optional<GridFrame> frame_for(const SnappedMesh& mesh, std::int32_t cell_steps) {
    GridFrame frame;
    frame.lattice = mesh.lattice.frame;
    frame.centre = mesh.lattice.centre;
    frame.cell_steps = cell_steps;
    frame.origin = mesh.low - Vec3<std::int32_t>{kMargin, kMargin, kMargin};
    const std::array<std::int32_t, 3> extents{mesh.high.x - mesh.low.x, mesh.high.y - mesh.low.y,
                                              mesh.high.z - mesh.low.z};
    double bricks = 1;
    for (std::size_t d = 0; d < 3; ++d) {
        frame.cell_counts[d] = (extents[d] + 2 * kMargin) / cell_steps + 1;
        frame.brick_counts[d] = (frame.cell_counts[d] + Brick::kEdge - 1) / Brick::kEdge;
        bricks *= frame.brick_counts[d];
    }
    if (bricks > kMaxBricks) return std::nullopt;
    frame.cell_limits = {static_cast<float>(frame.cell_counts[0]), static_cast<float>(frame.cell_counts[1]),
                         static_cast<float>(frame.cell_counts[2])};
    frame.cells_per_unit = static_cast<float>(frame.lattice.inverse_step / cell_steps);
    frame.shift = Vec3f(Vec3d(frame.origin) * (-1.0 / cell_steps));
    return frame;
}

/// Which cells the faces meet.
class Coverage {
  public:
    Coverage(const SnappedMesh& mesh, const GridFrame& frame)
        : frame_(frame), cells_(frame.brick_count()), reference_counts_(frame.brick_count()) {
        for (std::size_t face = 0; face < mesh.faces.size(); ++face)
            for_each_cell(frame, mesh.corners(face), [&](const CellPlace& cell) {
                const std::size_t brick = frame.brick_at(brick_of(cell));
                cells_[brick] |= std::uint64_t{1} << cell_in_brick(cell);
                ++reference_counts_[brick];
                ++reference_count_;
            });
        for (std::size_t brick = 0; brick < cells_.size(); ++brick) {
            if (cells_[brick] == 0) continue;
            ++brick_count_;
            cell_count_ += static_cast<std::size_t>(std::popcount(cells_[brick]));
            longest_ = std::max(longest_, reference_counts_[brick]);
        }
    }

    const GridFrame& frame() const { return frame_; }
    std::uint64_t cells(std::size_t brick) const { return cells_[brick]; }
    std::uint32_t reference_count(std::size_t brick) const { return reference_counts_[brick]; }
    std::size_t reference_count() const { return reference_count_; }
    std::size_t stored_bricks() const { return brick_count_ + 2; }
    std::size_t list_count() const { return cell_count_ + brick_count_; } // each brick ends with one more
    bool fits_format() const { return longest_ <= kNarrowLimit; }

    /// Of the grid, unless it needs winding numbers beside the inside bits.
    std::size_t byte_count(const SnappedMesh& mesh) const {
        const std::size_t number = stored_bricks() <= kNarrowLimit ? 2 : 4;
        const std::size_t face = mesh.faces.size() <= kNarrowLimit ? 2 : 4;
        const std::size_t vertex = mesh.lattice.vertices.size() <= kNarrowLimit ? 2 : 4;
        return number * (frame_.brick_count() + 1) + sizeof(Brick) * (stored_bricks() + 1) +
               sizeof(std::uint16_t) * list_count() + face * reference_count_ +
               sizeof(PackedPoint) * mesh.lattice.vertices.size() + vertex * (3 * mesh.faces.size() + 1);
    }

  private:
    GridFrame frame_;
    std::vector<std::uint64_t> cells_;
    std::vector<std::uint32_t> reference_counts_;
    std::size_t reference_count_ = 0, brick_count_ = 0, cell_count_ = 0;
    std::uint32_t longest_ = 0;
};

/// Numbers as Indices, narrow where `limit` of them fit.
class IndexWriter {
  public:
    IndexWriter(std::size_t size, std::size_t limit) {
        if (limit <= kNarrowLimit)
            indices_.narrow.resize(size);
        else
            indices_.wide.resize(size);
    }
    void set(std::size_t i, std::size_t value) {
        if (indices_.wide.empty())
            indices_.narrow[i] = static_cast<std::uint16_t>(value);
        else
            indices_.wide[i] = static_cast<std::uint32_t>(value);
    }
    Indices take() { return std::move(indices_); }

  private:
    Indices indices_;
};

void store_mesh(const SnappedMesh& mesh, GridArrays& grid) {
    const std::size_t vertex_count = mesh.lattice.vertices.size();
    for (const LatticePoint& vertex : mesh.lattice.vertices) grid.vertices.push_back(packed(vertex));
    IndexWriter corners(3 * mesh.faces.size() + 1, vertex_count);
    for (std::size_t i = 0; i < 3 * mesh.faces.size(); ++i) corners.set(i, mesh.faces[i / 3][i % 3]);
    grid.corners = corners.take();
}

std::uint32_t surface_bit(std::uint32_t cell) {
    return std::uint32_t{kSurfaceBit} << (2 * (cell & 15));
}

/// Bricks with the bits of their cells on the surface, and room for their lists.
void store_bricks(const Coverage& coverage, GridArrays& grid) {
    const std::size_t brick_count = grid.frame.brick_count();
    IndexWriter numbers(brick_count + 1, coverage.stored_bricks());
    grid.bricks.resize(2); // all outside, all inside
    for (std::uint32_t& states : grid.bricks[GridArrays::kInside].states) states = 0x5555'5555;
    std::uint32_t list = 0;
    std::size_t reference = 0;
    for (std::size_t b = 0; b < brick_count; ++b) {
        const std::uint64_t cells = coverage.cells(b);
        if (cells == 0) continue;
        numbers.set(b, grid.bricks.size());
        Brick& brick = grid.bricks.emplace_back();
        for (std::uint32_t cell = 0; cell < 64; ++cell)
            if (cells >> cell & 1) brick.states[cell >> 4] |= surface_bit(cell);
        brick.first_list = list;
        brick.first_reference = static_cast<std::uint32_t>(reference);
        list += static_cast<std::uint32_t>(std::popcount(cells)) + 1;
        reference += coverage.reference_count(b);
    }
    grid.bricks.emplace_back(); // the end
    grid.bricks.back().first_list = list;
    grid.brick_numbers = numbers.take();
}

void store_lists(const SnappedMesh& mesh, GridArrays& grid, std::size_t reference_count) {
    const auto list_of_cell = [&](const CellPlace& cell) {
        const Brick& brick = grid.brick(cell);
        return brick.first_list + rank_in_brick(brick, cell_in_brick(cell));
    };
    const std::uint32_t list_count = grid.bricks.back().first_list;
    struct Reference {
        std::uint32_t list, face;
    };
    std::vector<Reference> found;
    found.reserve(reference_count);
    std::vector<std::uint32_t> cursors(list_count + 1);
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        for_each_cell(grid.frame, mesh.corners(face), [&](const CellPlace& cell) {
            found.push_back({list_of_cell(cell), static_cast<std::uint32_t>(face)});
            ++cursors[found.back().list + 1];
        });
    for (std::uint32_t list = 0; list < list_count; ++list) cursors[list + 1] += cursors[list];
    grid.list_begins.resize(list_count);
    for (std::size_t b = 2; b + 1 < grid.bricks.size(); ++b)
        for (std::uint32_t list = grid.bricks[b].first_list; list < grid.bricks[b + 1].first_list; ++list)
            grid.list_begins[list] =
                static_cast<std::uint16_t>(cursors[list] - grid.bricks[b].first_reference);
    IndexWriter references(found.size(), mesh.faces.size());
    for (const Reference& r : found) references.set(cursors[r.list]++, r.face);
    grid.references = references.take();
}

/// How the winding number changes along a row of centres.
class RowWalk {
  public:
    explicit RowWalk(const GridArrays& grid) : grid_(grid) {}

    void start() {
        winding_ = 0;
        faces_.clear();
    }
    int winding() const { return winding_; }
    /// To a cell without faces.
    void go_to_empty(const CellPlace& cell) {
        if (!faces_.empty()) cross(faces_, cell);
        faces_.clear();
    }
    /// To a cell on the surface: the way leads through that and the last.
    void go_to(const CellPlace& cell, const CellList& list) {
        const std::size_t before = faces_.size();
        for (std::uint32_t r = list.first; r < list.last; ++r) faces_.push_back(grid_.references[r]);
        const auto middle = faces_.begin() + static_cast<std::ptrdiff_t>(before);
        both_.clear();
        std::set_union(faces_.begin(), middle, middle, faces_.end(), std::back_inserter(both_));
        cross(both_, cell);
        faces_.erase(faces_.begin(), middle);
    }

  private:
    void cross(const std::vector<std::uint32_t>& faces, const CellPlace& cell) {
        const LatticePoint to(grid_.frame.centre_of(cell));
        const std::int64_t origin = grid_.frame.origin.x; // outside; farther the numbers would grow too long
        const LatticePoint from{std::max(to.x - grid_.frame.cell_steps, origin), to.y, to.z};
        for (const std::uint32_t face : faces) {
            const auto corners = grid_.face(face);
            const auto& [a, b, c] = corners;
            // Most faces lie beside the row.
            if ((a.y < to.y && b.y < to.y && c.y < to.y) || (a.y > to.y && b.y > to.y && c.y > to.y) ||
                (a.z < to.z && b.z < to.z && c.z < to.z) || (a.z > to.z && b.z > to.z && c.z > to.z))
                continue;
            if (const auto crossing = crossing_with_face(corners, from, to))
                winding_ += crossing->entering() ? 1 : -1;
        }
    }

    const GridArrays& grid_;
    int winding_ = 0;
    std::vector<std::uint32_t> faces_; ///< of the last cell, ascending
    std::vector<std::uint32_t> both_;
};

/// Gives every cell and every centre its side.
class Classification {
  public:
    explicit Classification(GridArrays& grid) : grid_(grid), windings_(grid.list_begins.size()) {}

    void run() {
        const auto& counts = grid_.frame.cell_counts;
        RowWalk walk(grid_);
        for (std::int32_t z = 0; z < counts[2]; ++z)
            for (std::int32_t y = 0; y < counts[1]; ++y) {
                walk.start();
                for (std::int32_t x = 0; x < grid_.frame.brick_counts[0]; ++x)
                    pass_brick(walk, {4 * x, y, z});
            }
        const bool said_by_bits =
            std::all_of(windings_.begin(), windings_.end(), [](std::int16_t w) { return w == 0 || w == 1; });
        if (!said_by_bits) grid_.windings = std::move(windings_);
    }

  private:
    /// Four cells of a row.
    void pass_brick(RowWalk& walk, const CellPlace& first) {
        const std::size_t place = grid_.frame.brick_at(brick_of(first));
        const std::uint32_t number = grid_.brick_numbers[place];
        if (number <= GridArrays::kInside) {
            walk.go_to_empty(first);
            set_number(place, walk.winding() != 0 ? GridArrays::kInside : GridArrays::kOutside);
            return;
        }
        Brick& brick = grid_.bricks[number];
        for (std::int32_t i = 0; i < Brick::kEdge; ++i) {
            const CellPlace cell{first.x + i, first.y, first.z};
            if (cell.x >= grid_.frame.cell_counts[0]) break;
            const std::uint32_t in_brick = cell_in_brick(cell);
            if (state_of(brick, in_brick) & kSurfaceBit) {
                const CellList list = list_of(grid_, brick, in_brick);
                walk.go_to(cell, list);
                windings_[list.number] = checked(walk.winding());
            } else {
                walk.go_to_empty(cell);
            }
            if (walk.winding() != 0)
                brick.states[in_brick >> 4] |= std::uint32_t{kInsideBit} << (2 * (in_brick & 15));
        }
    }
    void set_number(std::size_t place, std::uint32_t number) {
        if (grid_.brick_numbers.wide.empty())
            grid_.brick_numbers.narrow[place] = static_cast<std::uint16_t>(number);
        else
            grid_.brick_numbers.wide[place] = number;
    }
    static std::int16_t checked(int winding) {
        if (std::abs(winding) > std::numeric_limits<std::int16_t>::max())
            throw Error(ErrorCode::InvalidMesh, "the mesh winds around a place more than 32767 times");
        return static_cast<std::int16_t>(winding);
    }

    GridArrays& grid_;
    std::vector<std::int16_t> windings_;
};

GridArrays grid_of(const SnappedMesh& mesh, const Coverage& coverage) {
    GridArrays grid;
    grid.frame = coverage.frame();
    store_mesh(mesh, grid);
    store_bricks(coverage, grid);
    store_lists(mesh, grid, coverage.reference_count());
    Classification(grid).run();
    return grid;
}

/// The finest grid within a budget: bytes grow about as 1 / size^2, which finds the size in a few tries.
Coverage finest_within(const SnappedMesh& mesh, std::size_t budget) {
    const auto try_size = [&](double size) -> std::optional<Coverage> {
        const auto frame = frame_for(mesh, static_cast<std::int32_t>(size));
        if (!frame) return std::nullopt;
        Coverage coverage(mesh, *frame);
        if (!coverage.fits_format()) return std::nullopt;
        return coverage;
    };
    const std::int32_t coarsest = mesh.coarsest_cell();
    double size = coarsest / 32.0 + 1;
    double too_fine = 0, coarse_enough = coarsest;
    std::optional<Coverage> best;
    const std::size_t fixed = Coverage(mesh, *frame_for(mesh, coarsest)).byte_count(mesh);
    constexpr int kTries = 14;
    for (int i = 0; i < kTries && budget >= fixed && coarse_enough - too_fine >= 1; ++i) {
        auto coverage = try_size(size);
        const std::size_t bytes = coverage ? coverage->byte_count(mesh) : 0;
        double next = 0;
        if (coverage && bytes <= budget) {
            const bool close = static_cast<double>(budget - bytes) < 0.01 * static_cast<double>(budget);
            coarse_enough = std::floor(size);
            best = std::move(coverage);
            if (close) break;
        } else {
            too_fine = std::floor(size);
        }
        if (bytes != 0) {
            constexpr double kAim = 0.996; // a little below, so as not to end above
            const double growth = static_cast<double>(bytes - std::min(bytes, fixed) + 1) /
                                  (kAim * static_cast<double>(budget) - static_cast<double>(fixed) + 1);
            next = growth > 0 ? size * std::sqrt(growth) : 0;
        }
        const bool between = next > too_fine + 0.5 && next < coarse_enough - 0.5;
        size = std::max(1.0, between ? next : std::sqrt(std::max(too_fine, 1.0) * coarse_enough));
    }
    if (!best) {
        auto coverage = try_size(coarsest);
        if (!coverage || coverage->byte_count(mesh) > budget)
            throw Error(ErrorCode::InvalidOptions, "the coarsest grid takes more than the budget of " +
                                                       std::to_string(budget) + " bytes");
        best = std::move(coverage);
    }
    return std::move(*best);
}

} // namespace

ClassifiedGrid ClassifiedGrid::build(const TriangleMesh& mesh, std::size_t byte_budget) {
    const SnappedMesh snapped(mesh);
    GridArrays grid = grid_of(snapped, finest_within(snapped, byte_budget));
    if (grid.byte_count() > byte_budget) // winding numbers beyond 0 and 1 were not counted on
        grid = grid_of(snapped,
                       finest_within(snapped, byte_budget - grid.windings.size() * sizeof(std::int16_t)));
    return ClassifiedGrid(std::make_shared<const GridArrays>(std::move(grid)));
}

ClassifiedGrid ClassifiedGrid::build_with_cells(const TriangleMesh& mesh, std::int32_t cell_steps) {
    const SnappedMesh snapped(mesh);
    const auto frame =
        cell_steps > 0 ? frame_for(snapped, std::min(cell_steps, snapped.coarsest_cell())) : std::nullopt;
    const auto refuse = [&]() -> Error {
        return {ErrorCode::InvalidOptions, "cells of " + std::to_string(cell_steps) +
                                               " lattice steps are too many or list too many faces"};
    };
    if (!frame) throw refuse();
    const Coverage coverage(snapped, *frame);
    if (!coverage.fits_format()) throw refuse();
    return ClassifiedGrid(std::make_shared<const GridArrays>(grid_of(snapped, coverage)));
}

std::size_t ClassifiedGrid::byte_count() const {
    return arrays_->byte_count();
}

std::int32_t ClassifiedGrid::cell_steps() const {
    return arrays_->frame.cell_steps;
}

} // namespace echinus::rivals
