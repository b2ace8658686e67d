#pragma once

#include "input.hpp"

#include <echinus/contact.hpp>
#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Points from a file, returned in order, block by block.
class PointSource {
  public:
    virtual ~PointSource() = default;

    /// The total number of points.
    virtual std::uint64_t count() const = 0;
    /// Fills the block with the next points; returns how many there were, 0 at the end.
    /// @throws echinus::Error if the file contains fewer or more points than its header declares
    virtual std::size_t read(std::span<echinus::Vec3d> block) = 0;
    /// Are the points stored as floats, whose spacing is coarse for large coordinates?
    virtual bool holds_floats() const { return false; }
};

enum class TableFormat { Npy, Csv };

/// The most points of a file that is read into memory whole, since a pipe may have no end.
inline constexpr std::uint64_t kMaxPointsInMemory = 100'000'000;

/// The format by the extension of a file's name (.npy, .csv), otherwise by the first byte.
TableFormat format_of_points(const std::filesystem::path& path, Input& input);

/// Points from an array [n, 3] in a .npy file: float32 or float64; C or Fortran order. The latter is read
/// into memory whole.
/// @throws echinus::Error WrongFormat or Damaged; Unreadable if more than kMaxPointsInMemory would have to be
/// in memory
std::unique_ptr<PointSource> open_npy_points(std::unique_ptr<Input> input);

/// Points from lines "x,y,z", read into memory whole. Empty lines and lines that begin with # are skipped,
/// and so is the first line if it contains names: a file with only that line has no points.
/// @throws echinus::Error Damaged with the number of the line; WrongFormat for a file without lines;
/// Unreadable for more than kMaxPointsInMemory
std::unique_ptr<PointSource> open_csv_points(std::unique_ptr<Input> input);

/// As much of a file's text as fits on a line of a terminal, in quotes.
std::string excerpt(std::string_view text);

/// Refuses more points than kMaxPointsInMemory.
void require_room_for(const Input& input, std::uint64_t count);

/// Points that are in memory.
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

/// The header of a .npy file, which describes the array that follows it (NumPy enhancement proposal 1; the
/// format's versions 1 to 3).
struct NpyHeader {
    std::string descr; ///< the type of the elements, such as "<f4"; a list of fields begins with "["
    bool fortran_order = false;
    std::vector<std::uint64_t> shape;
};

/// The first byte of every .npy file, and of no text.
inline constexpr char kNpyFirstByte = '\x93';

/// Reads the header and leaves the input at the first element.
/// @throws echinus::Error WrongFormat or Damaged
NpyHeader read_npy_header(Input& input);

/// The header of a version 1 file, for an array [element_count] of elements whose type is written as the
/// Python literal `descr`.
std::string format_npy_header(const std::string& descr, std::uint64_t element_count);

/// The answers about some points. Answers that were not requested are empty.
struct Answers {
    std::span<const echinus::Contact> contacts = {};
    std::span<const float> signed_distances = {}, winding_numbers = {};
};

/// Which answers are requested, in addition to contacts.
struct AnswerFields {
    bool signed_distance = false, winding_number = false;
    echinus::Vec3d origin{}; ///< of the map; if it is not 0, contact points are written as doubles
};

/// Writes the answers of a query in the order of the points, block by block. Nothing is left unless finish()
/// is called.
class AnswerWriter {
  public:
    virtual ~AnswerWriter() = default;

    virtual void write(const Answers& answers) = 0;
    virtual void finish() = 0;
};

/// Opens a table of `count` answers. As .npy: a structured array that numpy.load() reads without pickle, its
/// fields packed: inside u1, depth f4, normal 3 f4, point 3 f4 (or 3 f8: AnswerFields::origin), face i4,
/// certain u1, and f4 for signed_distance and winding_number if they are requested. As .csv: a line of names
/// and one line for each answer, floats with enough digits to restore the same bits.
/// @throws echinus::Error Unwritable
std::unique_ptr<AnswerWriter> open_answers(const std::filesystem::path& target, TableFormat format,
                                           std::uint64_t count, AnswerFields fields);
