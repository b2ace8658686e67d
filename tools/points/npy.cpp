#include "points/points.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <string_view>
#include <type_traits>
#include <vector>

using echinus::ErrorCode;
using echinus::Vec3d;

namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

/// Reads the header's text, a Python dict of which the format allows only this form:
/// {'descr': STRING or [LIST], 'fortran_order': True or False, 'shape': (COUNT, ...), }
class DictReader {
  public:
    DictReader(const Input& input, std::string_view text) : input_(input), rest_(text) {}

    NpyHeader read() {
        expect('{');
        while (!accept('}')) {
            const std::string key = read_string();
            expect(':');
            read_value(key);
            if (!accept(',')) {
                expect('}');
                break;
            }
        }
        skip_space();
        if (!rest_.empty() || header_.descr.empty() || !has_order_ || !has_shape_) fail();
        return header_;
    }

  private:
    [[noreturn]] void fail() const {
        input_.fail(ErrorCode::Damaged, "its .npy header does not consist of descr, fortran_order and shape; "
                                        "write the file again with numpy.save");
    }

    void read_value(const std::string& key) {
        if (key == "descr") {
            skip_space();
            header_.descr = rest_.starts_with('[') ? read_list() : read_string();
        } else if (key == "fortran_order") {
            header_.fortran_order = read_bool();
            has_order_ = true;
        } else if (key == "shape") {
            header_.shape = read_tuple();
            has_shape_ = true;
        } else {
            fail();
        }
    }

    void skip_space() {
        while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\n')) rest_.remove_prefix(1);
    }

    bool accept(std::string_view token) {
        skip_space();
        if (!rest_.starts_with(token)) return false;
        rest_.remove_prefix(token.size());
        return true;
    }
    bool accept(char token) { return accept(std::string_view(&token, 1)); }
    void expect(char token) {
        if (!accept(token)) fail();
    }

    std::string take(std::size_t length) {
        std::string text(rest_.substr(0, length));
        rest_.remove_prefix(length);
        return text;
    }

    std::string read_string() {
        const char quote = accept('\'') ? '\'' : '"';
        if (quote == '"') expect('"');
        const std::size_t end = rest_.find(quote);
        if (end == std::string_view::npos) fail();
        std::string text = take(end);
        expect(quote);
        return text;
    }

    /// The fields of a structured type as they are in the text, with balanced brackets.
    std::string read_list() {
        std::size_t depth = 0;
        for (std::size_t i = 0; i < rest_.size(); ++i) {
            if (rest_[i] == '[') ++depth;
            if (rest_[i] == ']' && --depth == 0) return take(i + 1);
        }
        fail();
    }

    bool read_bool() {
        if (accept("True")) return true;
        if (!accept("False")) fail();
        return false;
    }

    std::uint64_t read_count() {
        skip_space();
        std::uint64_t count = 0;
        const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), count);
        if (error != std::errc{}) fail();
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return count;
    }

    std::vector<std::uint64_t> read_tuple() {
        std::vector<std::uint64_t> counts;
        expect('(');
        while (!accept(')')) {
            counts.push_back(read_count());
            if (accept(',')) continue;
            expect(')');
            break;
        }
        return counts;
    }

    const Input& input_;
    std::string_view rest_;
    NpyHeader header_;
    bool has_order_ = false;
    bool has_shape_ = false;
};

void read_exactly(Input& input, void* bytes, std::size_t byte_count) {
    if (input.read(bytes, byte_count) != byte_count) {
        input.fail(ErrorCode::Damaged, "it ends within its .npy header");
    }
}

/// The number of bytes of the dict, from the little-endian 2 bytes of version 1 or 4 bytes of versions 2
/// and 3.
std::size_t read_dict_size(Input& input) {
    std::array<unsigned char, 2> version{};
    read_exactly(input, version.data(), version.size());
    if (version[0] < 1 || version[0] > 3) {
        input.fail(ErrorCode::WrongFormat, "a .npy file of version " + std::to_string(version[0]) +
                                               ", but only versions 1 to 3 are supported");
    }
    std::array<unsigned char, 4> size{};
    read_exactly(input, size.data(), version[0] == 1 ? 2 : 4);
    return size[0] | std::size_t{size[1]} << 8 | std::size_t{size[2]} << 16 | std::size_t{size[3]} << 24;
}

} // namespace

NpyHeader read_npy_header(Input& input) {
    // Our own headers have about 60 bytes; NumPy itself refuses more than 10 000 from sources that it does
    // not trust.
    constexpr std::size_t kMaxDictSize = 65'535;
    std::array<char, kMagic.size()> magic{};
    const std::size_t magic_size = input.read(magic.data(), magic.size());
    if (std::string_view(magic.data(), magic_size) != kMagic) {
        input.fail(ErrorCode::WrongFormat, magic_size == 0
                                               ? "not a .npy file: it is empty"
                                               : "not a .npy file: it does not begin with \\x93NUMPY");
    }
    const std::size_t dict_size = read_dict_size(input);
    if (dict_size > kMaxDictSize) {
        input.fail(ErrorCode::Damaged, "its .npy header claims " + std::to_string(dict_size) + " bytes");
    }
    std::string dict(dict_size, '\0');
    read_exactly(input, dict.data(), dict.size());
    return DictReader(input, dict).read();
}

std::string format_npy_header(const std::string& descr, std::uint64_t element_count) {
    // The format asks that the elements begin at a multiple of 64 bytes and that a newline ends the header.
    constexpr std::size_t kAlignment = 64;
    std::string dict = "{'descr': " + descr + ", 'fortran_order': False, 'shape': (" +
                       std::to_string(element_count) + ",), }";
    const std::size_t prefix_size = kMagic.size() + 4;
    while ((prefix_size + dict.size() + 1) % kAlignment != 0) dict += ' ';
    dict += '\n';
    std::string header(kMagic);
    header += '\x01';
    header += '\x00';
    header += static_cast<char>(dict.size() & 0xff);
    header += static_cast<char>(dict.size() >> 8);
    return header + dict;
}

static_assert(std::endian::native == std::endian::little, "arrays are little-endian and used as they are");

namespace {

[[noreturn]] void fail_count(const Input& input, std::uint64_t promised_count, const char* finding) {
    input.fail(ErrorCode::Damaged,
               "its header declares " + std::to_string(promised_count) + " points, but the file " + finding);
}

void require_end(Input& input, std::uint64_t promised_count) {
    if (!input.at_end()) fail_count(input, promised_count, "continues after them");
}

/// Rows of three numbers of type T.
template <typename T>
class RowSource final : public PointSource {
  public:
    RowSource(std::unique_ptr<Input> input, std::uint64_t count) : input_(std::move(input)), count_(count) {}

    std::uint64_t count() const override { return count_; }
    bool holds_floats() const override { return std::is_same_v<T, float>; }

    std::size_t read(std::span<Vec3d> block) override {
        const auto wanted =
            static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), count_ - read_count_));
        rows_.resize(wanted);
        const std::size_t byte_count = wanted * sizeof(echinus::Vec3<T>);
        if (input_->read(rows_.data(), byte_count) != byte_count) fail_count(*input_, count_, "ends before");
        std::transform(rows_.begin(), rows_.end(), block.begin(), [](const auto& row) { return Vec3d(row); });
        read_count_ += wanted;
        if (read_count_ == count_) require_end(*input_, count_);
        return wanted;
    }

  private:
    std::unique_ptr<Input> input_;
    std::uint64_t count_;
    std::uint64_t read_count_ = 0;
    std::vector<echinus::Vec3<T>> rows_;
};

/// One column of the Fortran order. Grows with what the file holds, not with what its header declares.
template <typename T>
std::vector<T> read_column(Input& input, std::uint64_t count) {
    constexpr std::uint64_t kBlock = std::uint64_t{1} << 18;
    std::vector<T> column;
    while (column.size() < count) {
        const std::size_t old_size = column.size();
        const auto wanted = static_cast<std::size_t>(std::min(kBlock, count - old_size));
        column.resize(old_size + wanted);
        require_room_for(input, column.size());
        const std::size_t byte_count = wanted * sizeof(T);
        if (input.read(column.data() + old_size, byte_count) != byte_count)
            fail_count(input, count, "ends before");
    }
    return column;
}

template <typename T>
std::unique_ptr<PointSource> read_columns(Input& input, std::uint64_t count) {
    const std::vector<T> x = read_column<T>(input, count);
    const std::vector<T> y = read_column<T>(input, count);
    const std::vector<T> z = read_column<T>(input, count);
    require_end(input, count);
    std::vector<Vec3d> points(x.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = Vec3d{x[i], y[i], z[i]};
    return std::make_unique<PointList>(std::move(points), std::is_same_v<T, float>);
}

template <typename T>
std::unique_ptr<PointSource> open_array(std::unique_ptr<Input> input, const NpyHeader& header) {
    const std::uint64_t count = header.shape[0];
    if (header.fortran_order) return read_columns<T>(*input, count);
    return std::make_unique<RowSource<T>>(std::move(input), count);
}

std::string shape_text(const NpyHeader& header) {
    std::string text;
    for (const std::uint64_t size : header.shape) text += (text.empty() ? "" : ", ") + std::to_string(size);
    return "[" + text + "]";
}

} // namespace

std::unique_ptr<PointSource> open_npy_points(std::unique_ptr<Input> input) {
    const NpyHeader header = read_npy_header(*input);
    if (header.shape.size() != 2 || header.shape[1] != 3) {
        input->fail(ErrorCode::WrongFormat,
                    "an array of shape " + shape_text(header) + ", but points are [n, 3]");
    }
    if (header.descr == "<f4") return open_array<float>(std::move(input), header);
    if (header.descr == "<f8") return open_array<double>(std::move(input), header);
    if (header.descr.starts_with('>')) {
        input->fail(ErrorCode::WrongFormat, "an array of big-endian numbers (" + excerpt(header.descr) +
                                                "); convert it with points.astype('<f4')");
    }
    input->fail(ErrorCode::WrongFormat, "an array of type " + excerpt(header.descr) +
                                            ", but points are float32 or float64; convert it with "
                                            "points.astype('<f4')");
}
