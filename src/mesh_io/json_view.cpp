#include "mesh_io/json_view.hpp"

#include <algorithm>
#include <charconv>

namespace echinus {

namespace {

constexpr std::string_view kSpace = " \t\r\n";

std::size_t skip_any(std::string_view text, std::string_view characters, std::size_t begin) {
    return std::min(text.find_first_not_of(characters, begin), text.size());
}

/// After the bracket that closes the one at the beginning.
std::size_t end_of_brackets(std::string_view text, std::size_t begin) {
    std::size_t depth = 0;
    for (std::size_t i = begin; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') i = end_of_json_string(text, i) - 1;
        if (c == '[' || c == '{') ++depth;
        if ((c == ']' || c == '}') && --depth == 0) return i + 1;
    }
    return text.size();
}

std::size_t end_of_value(std::string_view text, std::size_t begin) {
    if (begin >= text.size()) return text.size();
    if (text[begin] == '"') return end_of_json_string(text, begin);
    if (text[begin] == '[' || text[begin] == '{') return end_of_brackets(text, begin);
    return std::min(text.find_first_of(" \t\r\n,:]}", begin), text.size());
}

} // namespace

std::size_t end_of_json_string(std::string_view json, std::size_t begin) {
    for (std::size_t i = begin + 1; i < json.size(); ++i) {
        if (json[i] == '\\')
            ++i;
        else if (json[i] == '"')
            return i + 1;
    }
    return json.size();
}

JsonView::JsonView(std::string_view text) {
    const std::size_t begin = skip_any(text, kSpace, 0);
    text_ = text.substr(begin, end_of_value(text, begin) - begin);
}

JsonView JsonView::member(std::string_view key) const {
    if (!text_.starts_with('{')) return {};
    for (std::size_t at = skip_any(text_, " \t\r\n,", 1); at < text_.size() && text_[at] == '"';) {
        const JsonView name(text_.substr(at));
        const std::size_t colon = skip_any(text_, kSpace, at + name.text_.size());
        if (colon == text_.size() || text_[colon] != ':') return {};
        const std::size_t begin = skip_any(text_, kSpace, colon + 1);
        if (name.string() == key) return JsonView(text_.substr(begin));
        at = skip_any(text_, " \t\r\n,", end_of_value(text_, begin));
    }
    return {};
}

std::vector<JsonView> JsonView::elements() const {
    std::vector<JsonView> values;
    if (!text_.starts_with('[')) return values;
    for (std::size_t at = skip_any(text_, " \t\r\n,", 1); at < text_.size();) {
        const JsonView value(text_.substr(at));
        if (!value.exists()) break; // a bracket or a colon
        values.push_back(value);
        at = skip_any(text_, " \t\r\n,", at + value.text_.size());
    }
    return values;
}

std::optional<std::uint64_t> JsonView::natural_number() const {
    std::uint64_t number = 0;
    const char* const end = text_.data() + text_.size();
    const auto [stop, error] = std::from_chars(text_.data(), end, number);
    if (!exists() || error != std::errc{} || stop != end) return std::nullopt;
    return number;
}

std::optional<std::string_view> JsonView::string() const {
    if (text_.size() < 2 || text_.front() != '"' || text_.back() != '"') return std::nullopt;
    return text_.substr(1, text_.size() - 2);
}

} // namespace echinus
