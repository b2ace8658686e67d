#pragma once

#include "input.hpp"

#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Points from a file, handed out in order, block by block.
class PointSource {
  public:
    virtual ~PointSource() = default;

    /// How many there are in all.
    virtual std::uint64_t count() const = 0;
    /// Fills the block as far as points are left; gives how many that were, 0 at the end.
    /// @throws echinus::Error when the file turns out to hold fewer or more than it promised
    virtual std::size_t read(std::span<echinus::Vec3d> block) = 0;
    /// Do they come as floats, and so in steps where they are large?
    virtual bool holds_floats() const { return false; }
};

enum class TableFormat { Npy, Csv };

/// The most points of a file that is read into memory whole, since a pipe may have no end.
inline constexpr std::uint64_t kMaxPointsInMemory = 100'000'000;

/// By the ending of a file's name (.npy, .csv), otherwise by the first byte.
TableFormat format_of_points(const std::filesystem::path& path, Input& input);

/// Points from an array [n, 3] in a .npy file: float32 or float64; C or Fortran order. The latter is read
/// into memory whole.
/// @throws echinus::Error WrongFormat or Damaged; Unreadable when more than kMaxPointsInMemory would have to
/// be in memory
std::unique_ptr<PointSource> open_npy_points(std::unique_ptr<Input> input);

/// Points from lines "x,y,z", read into memory whole. Empty lines and lines that begin with # are skipped,
/// and so is the first line when it holds names: such a file without any other line has no points.
/// @throws echinus::Error Damaged with the number of the line; WrongFormat for a file without lines;
/// Unreadable for more than kMaxPointsInMemory
std::unique_ptr<PointSource> open_csv_points(std::unique_ptr<Input> input);

/// Of a file's text, as much as can be shown within a line of a terminal, in quotes.
std::string excerpt(std::string_view text);

/// Refuses more points than kMaxPointsInMemory.
void require_room_for(const Input& input, std::uint64_t count);

/// Points that lie in memory.
class PointList final : public PointSource {
  public:
    explicit PointList(std::vector<echinus::Vec3d> points, bool holds_floats = false)
        : points_(std::move(points)), holds_floats_(holds_floats) {}

    std::uint64_t count() const override { return points_.size(); }
    std::size_t read(std::span<echinus::Vec3d> block) override;
    bool holds_floats() const override { return holds_floats_; }

  private:
    std::vector<echinus::Vec3d> points_;
    bool holds_floats_;
    std::size_t read_count_ = 0;
};
