#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>

std::string Table::text() const {
    std::size_t width = 0;
    for (const auto& [label, value] : rows_) width = std::max(width, label.size());
    std::string text = title_ + "\n";
    for (const auto& [label, value] : rows_) text += fmt::format("  {:<{}}  {}\n", label, width, value);
    return text;
}

std::string yes_or_no(bool value) {
    return value ? "yes" : "no";
}
