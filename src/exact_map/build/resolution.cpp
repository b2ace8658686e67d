#include "exact_map/build/resolution.hpp"

#include "geometry/whole_numbers.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>
#include <cmath>

namespace echinus {

namespace {

/// The size of maps as a function of the number of cells. The function is concave: each cell takes a few
/// bytes, each face's outline takes bytes in proportion to its length, hence to the square root of the number
/// of cells, and the face's area in proportion to the number of cells. So extrapolating linearly from two
/// points never underestimates a finer map, and a map predicted to fit does fit.
class Growth {
  public:
    void add(std::uint32_t divisions, std::size_t byte_count) {
        before_ = last_;
        last_ = {square(divisions), static_cast<double>(byte_count)};
    }

    std::uint32_t divisions_of(std::size_t byte_count) const {
        constexpr double kMost = ExactMapOptions::kMaxDivisions;
        const double slope = (last_.bytes - before_.bytes) / (last_.cells - before_.cells);
        const double left = static_cast<double>(byte_count) - last_.bytes;
        if (left >= slope * (square(kMost) - last_.cells)) return ExactMapOptions::kMaxDivisions;
        return truncated_to<std::uint32_t>(std::sqrt(last_.cells + left / slope));
    }

  private:
    struct Point {
        double cells, bytes;
    };
    static double square(double number) { return number * number; }

    Point before_{}, last_{};
};

} // namespace

std::uint32_t default_divisions(std::size_t face_count, bool open) {
    // Four cells for five faces: map and mesh then take about the same memory. With fewer cells, lists are
    // longer in proportion; with more, they are hardly shorter, since each face then lies in several cells.
    constexpr double kCellsPerFace = 0.8;
    const double divisions = std::sqrt(kCellsPerFace * static_cast<double>(face_count) / 8);
    // The smaller a cell, the less the winding number changes in it, and the more of it is certain.
    const std::uint32_t least = open ? 20 : 4;
    return std::clamp(truncated_to<std::uint32_t>(std::round(divisions)), least,
                      ExactMapOptions::kMaxDivisions);
}

std::size_t default_byte_limit(std::size_t face_count, std::size_t vertex_count) {
    constexpr std::size_t kPerFace = 512, kPerMap = 65'536, kPerVertex = 12;
    const std::size_t unused = vertex_count - std::min(vertex_count, 3 * face_count);
    return kPerFace * face_count + kPerMap + kPerVertex * unused;
}

std::uint32_t most_useful_divisions(std::size_t face_count, bool open) {
    // Sixteen times the default number of cells: nearly every band then holds two or three faces.
    const std::uint32_t usual = default_divisions(face_count, open);
    return open ? usual : std::min(4 * usual, ExactMapOptions::kMaxDivisions);
}

std::optional<std::uint32_t>
finest_within(const ByteRange& bytes, std::uint32_t most,
              const std::function<std::optional<std::size_t>(std::uint32_t divisions)>& byte_count) {
    Growth growth;
    std::uint32_t fitting = 0, too_many = most + 1;
    for (std::uint32_t candidate = 1; fitting + 1 < too_many;) {
        if (const std::optional<std::size_t> taken = byte_count(candidate)) {
            fitting = candidate;
            if (*taken >= bytes.enough) break;
            growth.add(candidate, *taken);
        } else {
            too_many = candidate;
            if (fitting == 0) return std::nullopt;
        }
        candidate = growth.divisions_of(bytes.limit);
        if (candidate >= too_many) candidate = too_many > most ? most : (fitting + too_many) / 2;
        candidate = std::max(candidate, fitting + 1);
    }
    return fitting;
}

} // namespace echinus
