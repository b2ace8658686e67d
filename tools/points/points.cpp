#include "points/points.hpp"

#include "files/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <string_view>

using echinus::ErrorCode;
using echinus::Vec3d;

namespace {

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kSpace = " \t";
    const std::size_t first = text.find_first_not_of(kSpace);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::optional<double> parse_number(std::string_view text) {
    double value = 0;
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return {};
    return value;
}

std::optional<Vec3d> parse_point(std::string_view line) {
    std::array<double, 3> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::size_t comma = line.find(',');
        const bool last = i + 1 == numbers.size();
        if ((comma == std::string_view::npos) != last) return {};
        const std::optional<double> number = parse_number(trimmed(line.substr(0, comma)));
        if (!number) return {};
        numbers[i] = *number;
        if (!last) line.remove_prefix(comma + 1);
    }
    return Vec3d{numbers[0], numbers[1], numbers[2]};
}

/// Three columns that each begin like a name: "x,y,z".
bool holds_names(std::string_view line) {
    const auto begins_like_name = [](std::string_view field) {
        field = trimmed(field);
        if (field.starts_with('"')) field.remove_prefix(1);
        return !field.empty() && (std::isalpha(static_cast<unsigned char>(field[0])) || field[0] == '_');
    };
    std::size_t column_count = 1;
    for (std::size_t comma; (comma = line.find(',')) != std::string_view::npos; ++column_count) {
        if (!begins_like_name(line.substr(0, comma))) return false;
        line.remove_prefix(comma + 1);
    }
    return column_count == 3 && begins_like_name(line);
}

/// The remedy for a line that is not a point; empty if none is apparent.
std::string remedy_for(std::string_view line) {
    const bool has_commas = line.find(',') != std::string_view::npos;
    if (line.find(';') != std::string_view::npos)
        return std::string("; separate them by commas, not by semicolons") +
               (has_commas ? ", and write a decimal point" : "");
    if (has_commas) {
        const auto column_count = 1 + std::count(line.begin(), line.end(), ',');
        return column_count == 3 ? "" : "; it has " + std::to_string(column_count) + " columns";
    }
    if (line.find('\t') != std::string_view::npos) return "; separate them by commas, not by tabs";
    if (line.find(' ') != std::string_view::npos) return "; separate them by commas, not by blanks";
    return "";
}

} // namespace

std::unique_ptr<PointSource> open_csv_points(std::unique_ptr<Input> input) {
    std::vector<Vec3d> points;
    std::string line;
    bool names_may_follow = true;
    for (std::size_t line_number = 1; input->read_line(line); ++line_number) {
        std::string_view text = line;
        if (line_number == 1)
            text = echinus::utf8_text(
                text, [&](const std::string& what) { input->fail(ErrorCode::WrongFormat, what); });
        text = trimmed(text);
        if (text.empty() || text.starts_with('#')) continue;
        if (const std::optional<Vec3d> point = parse_point(text)) {
            points.push_back(*point);
            require_room_for(*input, points.size());
        } else if (!(names_may_follow && holds_names(text))) {
            input->fail(ErrorCode::Damaged, "line " + std::to_string(line_number) + " is " + excerpt(text) +
                                                ", not three numbers x,y,z" + remedy_for(text));
        }
        names_may_follow = false;
    }
    if (names_may_follow)
        input->fail(ErrorCode::WrongFormat,
                    "it contains neither points nor a line of names; a line is x,y,z");
    return std::make_unique<PointList>(std::move(points));
}

TableFormat format_of_points(const std::filesystem::path& path, Input& input) {
    if (path.extension() == ".npy") return TableFormat::Npy;
    if (path.extension() == ".csv") return TableFormat::Csv;
    return input.next_is(kNpyFirstByte) ? TableFormat::Npy : TableFormat::Csv;
}

std::string excerpt(std::string_view text) {
    constexpr std::size_t kLength = 40;
    std::string shown(text.substr(0, kLength));
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return "'" + shown + (text.size() > kLength ? "...'" : "'");
}

void require_room_for(const Input& input, std::uint64_t count) {
    if (count > kMaxPointsInMemory)
        input.fail(ErrorCode::Unreadable,
                   "it has more than " + std::to_string(kMaxPointsInMemory) +
                       " points; that many can be read only from a .npy file in C order");
}

std::size_t PointList::read(std::span<Vec3d> block) {
    const std::size_t count = std::min(block.size(), points_.size() - read_count_);
    std::copy_n(points_.begin() + static_cast<std::ptrdiff_t>(read_count_), count, block.begin());
    read_count_ += count;
    return count;
}
