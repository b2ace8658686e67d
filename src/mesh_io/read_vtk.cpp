#include "mesh_io/readers.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

// The format: "VTK File Formats for VTK Version 4.2", the simple legacy format, an unstructured grid, as text
// or as bytes, big endian (https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html); and cells in
// arrays of offsets and corners, as in version 5.1. The data of points and cells that follow are ignored, and
// so are the fields and metadata between the parts that ParaView and VisIt write.

namespace echinus {

namespace {

constexpr std::int64_t kVtkTetrahedron = 10;

/// Vertices, lines and plane cells: VTK_VERTEX to VTK_QUAD.
bool is_flat(std::int64_t type) {
    return type >= 1 && type <= 9;
}

std::optional<NumberType> type_named(std::string_view name) {
    if (name == "float") return NumberType::Float32;
    if (name == "double") return NumberType::Float64;
    if (name == "int" || name == "vtktypeint32") return NumberType::Int32;
    if (name == "long" || name == "vtktypeint64") return NumberType::Int64;
    return {};
}

/// The number of bytes of a value in a field; 0 for a type that cannot be skipped.
std::size_t size_of_type(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, std::size_t>, 14> kSizes{{{"char", 1},
                                                                               {"unsigned_char", 1},
                                                                               {"short", 2},
                                                                               {"unsigned_short", 2},
                                                                               {"int", 4},
                                                                               {"unsigned_int", 4},
                                                                               {"vtkIdType", 4},
                                                                               {"vtktypeint32", 4},
                                                                               {"float", 4},
                                                                               {"long", 8},
                                                                               {"unsigned_long", 8},
                                                                               {"vtktypeint64", 8},
                                                                               {"vtktypeuint64", 8},
                                                                               {"double", 8}}};
    const auto* const found =
        std::find_if(kSizes.begin(), kSizes.end(), [&](const auto& type) { return type.first == name; });
    return found == kSizes.end() ? 0 : found->second;
}

class VtkReader {
  public:
    VtkReader(NumberSource& numbers, bool is_version_5) : numbers_(numbers), is_version_5_(is_version_5) {}

    TetrahedraInFile read() {
        if (const auto words = numbers_.require_line("DATASET");
            words.size() != 2 || words[0] != "DATASET" || words[1] != "UNSTRUCTURED_GRID")
            numbers_.fail(ErrorCode::WrongFormat, "only data sets of the kind UNSTRUCTURED_GRID are read");
        while (types_.empty()) {
            const auto words = numbers_.require_line("POINTS, CELLS or CELL_TYPES");
            if (words[0] == "POINTS" && words.size() == 3 && mesh_.vertices.empty())
                read_points(words);
            else if (words[0] == "CELLS" && words.size() == 3 && corner_counts_.empty())
                read_cells(words);
            else if (words[0] == "CELL_TYPES" && words.size() == 2 && !corner_counts_.empty())
                read_types(words);
            else if (words[0] == "FIELD" && words.size() == 3)
                skip_field(words);
            else if (words[0] == "METADATA")
                is_in_metadata_ = true;
            else if (!is_in_metadata_)
                numbers_.fail(ErrorCode::Damaged,
                              "POINTS, CELLS or CELL_TYPES with a count was expected, not " +
                                  in_quotes(words[0]));
        }
        gather();
        return std::move(mesh_);
    }

  private:
    std::size_t count(std::string_view word) {
        std::int64_t value = 0;
        if (!parse_integer(word, value) || value < 0 || value >= std::int64_t{1} << 32)
            numbers_.fail(ErrorCode::Damaged, "a count was expected, not " + in_quotes(word));
        return static_cast<std::size_t>(value);
    }

    /// Skips arrays, each of which begins with a line with its name, the number of components, the number of
    /// tuples and the type.
    void skip_field(const std::vector<std::string_view>& words) {
        is_in_metadata_ = false;
        for (std::size_t left = count(words[2]); left > 0; --left) {
            const auto array = numbers_.require_line("an array of a field");
            const std::size_t size = array.size() == 4 ? size_of_type(array[3]) : 0;
            if (size == 0)
                numbers_.fail(ErrorCode::WrongFormat,
                              "the array " + in_quotes(array[0]) +
                                  " of a field does not contain numbers; save the grid "
                                  "without it");
            const std::size_t component_count = count(array[1]);
            const std::size_t tuple_count = component_count == 0 ? 0 : count(array[2]);
            for (std::size_t i = 0; i < tuple_count; ++i) numbers_.skip(component_count, size);
        }
    }

    void read_points(const std::vector<std::string_view>& words) {
        is_in_metadata_ = false;
        const std::size_t point_count = count(words[1]);
        const std::optional<NumberType> type = type_named(words[2]);
        if (type != NumberType::Float32 && type != NumberType::Float64)
            numbers_.fail(ErrorCode::WrongFormat,
                          "points of float or double are read, not of " + in_quotes(words[2]));
        for (std::size_t i = 0; i < point_count; ++i) mesh_.vertices.push_back(numbers_.position(*type));
    }

    /// Reads cells: each is given by the number of its corners and the corners; since version 5.1, by two
    /// arrays.
    void read_cells(const std::vector<std::string_view>& words) {
        is_in_metadata_ = false;
        const std::size_t first = count(words[1]), second = count(words[2]);
        if (is_version_5_) return read_cell_arrays(first, second);
        for (std::size_t cell = 0; cell < first; ++cell) {
            const std::size_t corner_count = numbers_.count(NumberType::Int32, "the number of corners");
            for (std::size_t i = 0; i < corner_count; ++i) corners_.push_back(corner(NumberType::Int32));
            corner_counts_.push_back(corner_count);
        }
        if (corner_counts_.size() + corners_.size() != second)
            numbers_.fail(ErrorCode::Damaged,
                          "the cells have " + std::to_string(corner_counts_.size() + corners_.size()) +
                              " numbers, not " + std::to_string(second) + " as CELLS declares");
    }

    void read_cell_arrays(std::size_t offset_count, std::size_t corner_count) {
        const NumberType offset_type = array_type("OFFSETS");
        std::size_t last = 0;
        for (std::size_t i = 0; i < offset_count; ++i) {
            const std::size_t offset = numbers_.count(offset_type, "an offset");
            if (offset < last || (i == 0 && offset != 0))
                numbers_.fail(ErrorCode::Damaged, "the offsets of cells do not ascend from 0");
            if (i > 0) corner_counts_.push_back(offset - last);
            last = offset;
        }
        if (last != corner_count)
            numbers_.fail(ErrorCode::Damaged, "the offsets of cells end at " + std::to_string(last) +
                                                  ", not at " + std::to_string(corner_count) +
                                                  " as CELLS declares");
        const NumberType corner_type = array_type("CONNECTIVITY");
        for (std::size_t i = 0; i < corner_count; ++i) corners_.push_back(corner(corner_type));
    }

    NumberType array_type(const std::string& name) {
        const auto words = numbers_.require_line(name);
        if (words.size() == 2 && words[0] == name)
            for (const NumberType type : {NumberType::Int32, NumberType::Int64})
                if (type_named(words[1]) == type) return type;
        numbers_.fail(ErrorCode::Damaged, name + " with vtktypeint32 or vtktypeint64 was expected");
    }

    std::uint32_t corner(NumberType type) {
        const std::int64_t index = numbers_.integer(type, "a point");
        if (index < 0 || static_cast<std::uint64_t>(index) >= mesh_.vertices.size())
            numbers_.fail(ErrorCode::InvalidMesh,
                          "a cell refers to point " + std::to_string(index) + ", but there are " +
                              std::to_string(mesh_.vertices.size()) + " points, numbered from 0");
        return static_cast<std::uint32_t>(index);
    }

    void read_types(const std::vector<std::string_view>& words) {
        if (count(words[1]) != corner_counts_.size())
            numbers_.fail(ErrorCode::Damaged, "there are " + std::to_string(corner_counts_.size()) +
                                                  " cells, but " + std::string(words[1]) + " types");
        for (std::size_t i = 0; i < corner_counts_.size(); ++i) {
            types_.push_back(numbers_.integer(NumberType::Int32, "the type of a cell"));
            if (types_.back() == kVtkTetrahedron ? corner_counts_[i] != 4 : !is_flat(types_.back()))
                numbers_.fail(
                    ErrorCode::WrongFormat,
                    "cell " + std::to_string(i) + " of type " + std::to_string(types_.back()) +
                        " is not a tetrahedron with four corners; save the body as linear tetrahedra");
        }
    }

    void gather() {
        std::size_t begin = 0;
        for (std::size_t cell = 0; cell < types_.size(); begin += corner_counts_[cell++])
            if (types_[cell] == kVtkTetrahedron)
                mesh_.tetrahedra.push_back(
                    {corners_[begin], corners_[begin + 1], corners_[begin + 2], corners_[begin + 3]});
    }

    NumberSource& numbers_;
    bool is_version_5_;
    bool is_in_metadata_ = false; ///< in which only the lines that end it are recognised
    TetrahedraInFile mesh_;
    std::vector<std::uint32_t> corners_;
    std::vector<std::size_t> corner_counts_;
    std::vector<std::int64_t> types_;
};

/// Skips the first two lines: the mark with the version, and a title that may be anything. Returns the offset
/// at which the third line begins.
std::size_t end_of_title(const MeshSource& source) {
    const std::size_t end_of_mark = source.bytes.find('\n');
    const std::size_t end =
        end_of_mark == std::string_view::npos ? end_of_mark : source.bytes.find('\n', end_of_mark + 1);
    if (end == std::string_view::npos)
        source.fail(ErrorCode::Damaged, "the file ends within its first two lines");
    return end + 1;
}

} // namespace

TetrahedraInFile read_vtk(const MeshSource& source) {
    constexpr std::string_view kMark = "# vtk DataFile Version ";
    const std::string_view text = text_of(source);
    if (!text.starts_with(kMark))
        source.fail(ErrorCode::WrongFormat,
                    "the file does not begin with '# vtk DataFile Version', as legacy VTK "
                    "files do; XML files are not read");
    const bool is_version_5 = text.substr(kMark.size(), 1) == "5";
    LineScanner scanner(source, end_of_title(source), 3);
    scanner.require_line("ASCII or BINARY");
    const std::string_view format = scanner.next_word();
    if (format == "BINARY") {
        BinaryNumbers numbers(source, scanner.offset(), ByteOrder::BigEndian);
        return VtkReader(numbers, is_version_5).read();
    }
    if (format != "ASCII") scanner.fail_expecting("ASCII or BINARY", format, ErrorCode::WrongFormat);
    TextNumbers numbers(source, scanner);
    return VtkReader(numbers, is_version_5).read();
}

} // namespace echinus
