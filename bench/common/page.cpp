#include "page.hpp"

#include <echinus/error.hpp>

#include <fmt/ranges.h>

#include <fstream>
#include <iterator>

using namespace echinus;

namespace {

std::string row(const std::vector<std::string>& cells) {
    return fmt::format("| {} |", fmt::join(cells, " | "));
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw Error(ErrorCode::Unreadable, path.string() + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace

std::string markdown_table(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::string> alignment(rows.front().size(), "--:");
    alignment.front() = "---";
    std::string table = row(rows.front()) + '\n' + row(alignment);
    for (std::size_t i = 1; i < rows.size(); ++i) table += '\n' + row(rows[i]);
    return table;
}

std::string fill_page(const std::filesystem::path& page_template, const Values& values) {
    const std::string text = read_text(page_template);
    std::string page;
    std::size_t done = 0;
    for (std::size_t open = text.find("{{"); open != std::string::npos; open = text.find("{{", done)) {
        const std::size_t close = text.find("}}", open);
        const std::string name = text.substr(open + 2, close - open - 2);
        const auto value = values.find(name);
        if (value == values.end())
            throw Error(ErrorCode::Damaged,
                        page_template.string() + ": nothing is known of {{" + name + "}}");
        page += text.substr(done, open - done) + value->second;
        done = close + 2;
    }
    return page + text.substr(done);
}
