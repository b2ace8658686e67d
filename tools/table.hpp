#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Two columns for people: what, and how much.
class Table {
  public:
    explicit Table(std::string title) : title_(std::move(title)) {}

    void add(std::string label, std::string value) { rows_.emplace_back(std::move(label), std::move(value)); }
    /// The title, then the rows, indented, their values aligned.
    std::string text() const;

  private:
    std::string title_;
    std::vector<std::pair<std::string, std::string>> rows_;
};

std::string yes_or_no(bool value);
