#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// What stands in a page's template between {{ and }}, by name.
using Values = std::map<std::string, std::string>;

/// Rows of cells as a Markdown table; the first row is the head. All columns but the first are set flush
/// right. No newline at the end.
std::string markdown_table(const std::vector<std::vector<std::string>>& rows);

/// Replaces each {{name}} of the template.
/// @throws echinus::Error Unreadable, or Damaged when the template names a value that there is not
std::string fill_page(const std::filesystem::path& page_template, const Values& values);
