#include "compare/markup.hpp"

#include <fmt/format.h>

namespace echinus::comparison {

std::string escaped(std::string_view plain) {
    std::string result;
    for (const char c : plain) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '"')
            result += "&quot;";
        else
            result += c;
    }
    return result;
}

std::string svg_text(double x, double y, std::string_view anchor, std::string_view content,
                     std::string_view more) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
                       escaped(content));
}

} // namespace echinus::comparison
