#include "records.hpp"

#include "files/atomic_file.hpp"

#include <echinus/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

using namespace echinus;

namespace {

/// Cells hold no quotes, and no commas: add() drops them.
std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line)
        if (c == ',')
            cells.emplace_back();
        else
            cells.back() += c;
    return cells;
}

} // namespace

Records Records::read(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) throw Error(ErrorCode::Unreadable, path.string() + ": cannot be read");
    Records records({});
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("# ")) {
            records.comments_.push_back(line.substr(2));
            continue;
        }
        const std::vector<std::string> cells = cells_of(line);
        if (records.columns_.empty()) {
            records.columns_ = cells;
            continue;
        }
        if (cells.size() != records.columns_.size())
            throw Error(ErrorCode::Damaged,
                        fmt::format("{}: a line has {} cells instead of {}: {}", path.string(), cells.size(),
                                    records.columns_.size(), line));
        Record record;
        for (std::size_t i = 0; i < cells.size(); ++i) record[records.columns_[i]] = cells[i];
        records.records_.push_back(std::move(record));
    }
    return records;
}

void Records::add(Record record) {
    for (auto& [column, cell] : record) std::erase(cell, ','); // which separates cells
    records_.push_back(std::move(record));
}

void Records::write(const std::filesystem::path& path, const std::vector<std::string>& comments) const {
    std::string text;
    for (const std::string& comment : comments) text += "# " + comment + '\n';
    text += fmt::format("{}\n", fmt::join(columns_, ","));
    for (const Record& record : records_) {
        std::vector<std::string> cells;
        for (const std::string& column : columns_) {
            const auto found = record.find(column);
            cells.push_back(found == record.end() ? "" : found->second);
        }
        text += fmt::format("{}\n", fmt::join(cells, ","));
    }
    std::filesystem::create_directories(std::filesystem::absolute(path).parent_path());
    write_file(path, text);
}

double number(const Records::Record& record, const std::string& column) {
    const auto cell = record.find(column);
    if (cell == record.end() || cell->second.empty()) return std::nan("");
    return std::strtod(cell->second.c_str(), nullptr);
}
