#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// Measurements as lines of a CSV file, for lab/bench/pages/ and other readers.
class Records {
  public:
    using Record = std::map<std::string, std::string>;

    explicit Records(std::vector<std::string> columns) : columns_(std::move(columns)) {}

    /// @throws echinus::Error Unreadable, or Damaged when a line has another number of cells than the head
    static Records read(const std::filesystem::path& path);

    /// Columns that a record does not have stay empty; commas in its cells are dropped. @pre it has no others
    void add(Record record);
    /// Writes the file whole; lines of comment, such as the machine, begin with #.
    void write(const std::filesystem::path& path, const std::vector<std::string>& comments) const;

    const std::vector<Record>& all() const { return records_; }
    const std::vector<std::string>& comments() const { return comments_; }

  private:
    std::vector<std::string> columns_, comments_;
    std::vector<Record> records_;
};

/// The number in a column; NaN where there is none.
double number(const Records::Record& record, const std::string& column);
