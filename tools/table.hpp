#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

/// Two columns for people: what, and how much.
class Table {
  public:
    explicit Table(std::string title) : title_(std::move(title)) {}

    void add(std::string label, std::string value) { rows_.emplace_back(std::move(label), std::move(value)); }

    /// The title, then the rows, indented, their values aligned.
    std::string text() const {
        std::size_t width = 0;
        for (const auto& [label, value] : rows_) width = std::max(width, label.size());
        std::string text = title_ + "\n";
        for (const auto& [label, value] : rows_)
            text += "  " + label + std::string(width - label.size() + 2, ' ') + value + "\n";
        return text;
    }

  private:
    std::string title_;
    std::vector<std::pair<std::string, std::string>> rows_;
};

inline const char* yes_or_no(bool value) {
    return value ? "yes" : "no";
}
