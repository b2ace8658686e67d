#include "tables.hpp"

#include "common/page.hpp"
#include "rivals/compare/columns.hpp"

#include <fmt/format.h>

#include <algorithm>

using namespace echinus::comparison;

namespace {

std::string table_of(const Comparison& comparison) {
    std::vector<Column> columns = time_columns(comparison);
    std::ranges::copy(error_columns(comparison), std::back_inserter(columns));
    std::vector<std::vector<std::string>> rows(1 + comparison.systems.size());
    rows[0].emplace_back("system");
    for (std::size_t i = 0; i < comparison.systems.size(); ++i)
        rows[i + 1].emplace_back(comparison.systems[i].system->title);
    std::string group;
    for (const Column& column : columns) {
        rows[0].push_back(column.group == group ? column.head : column.group + ": " + column.head);
        group = column.group;
        for (std::size_t i = 0; i < comparison.systems.size(); ++i)
            rows[i + 1].push_back(column.cell(comparison.systems[i]));
    }
    return markdown_table(rows);
}

} // namespace

std::string tables_of(std::span<const Model> models) {
    std::string text;
    for (const Model& model : models) {
        text += fmt::format("{}### {}: {}, {} faces\n\n{}\n", text.empty() ? "" : "\n", model.name,
                            model.what, model.result.face_count, table_of(model.result));
        const std::vector<std::string> remarks = remarks_on(model.result);
        if (!remarks.empty()) text += "\n";
        for (const std::string& remark : remarks) text += "- " + remark + "\n";
    }
    return text;
}
