#include "points/npy_header.hpp"
#include "points/points.hpp"

#include <algorithm>
#include <bit>
#include <type_traits>
#include <vector>

using echinus::ErrorCode;
using echinus::Vec3d;

static_assert(std::endian::native == std::endian::little, "arrays are little-endian and used as they are");

namespace {

[[noreturn]] void fail_count(const Input& input, std::uint64_t promised_count, const char* finding) {
    input.fail(ErrorCode::Damaged,
               "its header promises " + std::to_string(promised_count) + " points, but the file " + finding);
}

void require_end(Input& input, std::uint64_t promised_count) {
    if (!input.at_end()) fail_count(input, promised_count, "goes on behind them");
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

/// One column of the Fortran order. Grows with what the file holds, not with what its header promises.
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
