#include "points.hpp"

#include "npy_header.hpp"

#include <algorithm>

TableFormat format_of_points(const std::filesystem::path& path, Input& input) {
    if (path.extension() == ".npy") return TableFormat::Npy;
    if (path.extension() == ".csv") return TableFormat::Csv;
    return input.next_is(kNpyFirstByte) ? TableFormat::Npy : TableFormat::Csv;
}

std::size_t PointList::read(std::span<echinus::Vec3f> block) {
    const std::size_t count = std::min(block.size(), points_.size() - read_count_);
    std::copy_n(points_.begin() + static_cast<std::ptrdiff_t>(read_count_), count, block.begin());
    read_count_ += count;
    return count;
}
