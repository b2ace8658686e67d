#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace echinus {

/// The offset after a string's closing quotation mark.
std::size_t end_of_json_string(std::string_view json, std::size_t begin);

/// A value in the text of a JSON document, for reading a few numbers of a file that another reader validates:
/// malformed values and ones of another kind count as missing. Keys are compared as spelt. Nothing is
/// recursive.
///
/// Not nlohmann-json, because the check must see what Assimp sees: of equal keys the first, where
/// nlohmann-json keeps the last, and text that is not UTF-8, which nlohmann-json does not parse.
class JsonView {
  public:
    JsonView() = default; ///< a value that is not there
    /// @param text  begins with the value, perhaps after white space; what follows the value is not looked at
    explicit JsonView(std::string_view text);

    JsonView member(std::string_view key) const;
    std::vector<JsonView> elements() const;
    std::optional<std::uint64_t> natural_number() const;
    /// As it stands between the quotation marks.
    std::optional<std::string_view> string() const;
    bool exists() const { return !text_.empty(); }

  private:
    std::string_view text_; ///< exactly the value
};

} // namespace echinus
