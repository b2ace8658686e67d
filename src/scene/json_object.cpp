#include "scene/json_object.hpp"

#include "files/text.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

namespace echinus {

using nlohmann::json;

namespace {

/// Refuses two values with one key, of which the parser would keep the last, and values nested too deeply for
/// the library's recursive functions.
class ParsingRules {
  public:
    explicit ParsingRules(const std::string& name) : name_(name) {}

    bool operator()(int depth, json::parse_event_t event, json& parsed) {
        constexpr int kMostDepth = 32; // a scene needs five
        if (depth > kMostDepth)
            throw Error(ErrorCode::InvalidScene,
                        name_ + ": nests deeper than " + std::to_string(kMostDepth) + " levels");
        if (event == json::parse_event_t::object_start) keys_.emplace_back();
        if (event == json::parse_event_t::object_end) keys_.pop_back();
        if (event == json::parse_event_t::key && !keys_.back().insert(parsed.get<std::string>()).second)
            throw Error(ErrorCode::InvalidScene,
                        name_ + ": the key " + parsed.dump() + " is given twice in one object");
        return true;
    }

  private:
    const std::string& name_;
    std::vector<std::set<std::string>> keys_; // the keys of the open objects
};

/// The library's message without its tag in brackets.
std::string reason_of(const json::exception& error) {
    const std::string message = error.what();
    const std::size_t end_of_tag = message.find("] ");
    return end_of_tag == std::string::npos ? message : message.substr(end_of_tag + 2);
}

std::string expected_number(Range range) {
    if (range.most == std::numeric_limits<double>::infinity())
        return "a number of at least " + number_text(range.least);
    return "a number from " + number_text(range.least) + " to " + number_text(range.most);
}

std::string expected_whole_number(Range range) {
    const auto text = [](double limit) {
        return std::to_string(static_cast<std::uint32_t>(std::min(limit, double{UINT32_MAX})));
    };
    return "a whole number from " + text(range.least) + " to " + text(range.most);
}

std::string expected_array(std::size_t size, const std::string& element) {
    return "an array of " + std::to_string(size) + " elements, each " + element;
}

bool within(double value, Range range) {
    return value >= range.least && value <= range.most;
}

/// Does `value` contain an element of this type and in this range? Numbers of type double may be written as
/// integers, but not the reverse.
bool holds(const json& value, double, Range range) {
    return value.is_number() && within(value.get<double>(), range);
}
bool holds(const json& value, std::uint32_t, Range range) {
    return value.is_number_integer() && within(value.get<double>(), range);
}

template <typename T, std::size_t kSize>
bool read_array(const json& value, std::array<T, kSize>& array, Range range) {
    if (!value.is_array() || value.size() != kSize) return false;
    const auto fits = [&](const json& element) { return holds(element, T{}, range); };
    if (!std::all_of(value.begin(), value.end(), fits)) return false;
    for (std::size_t i = 0; i < kSize; ++i) array[i] = value[i].get<T>();
    return true;
}

std::string list_of(const std::vector<std::string_view>& words) {
    std::string list;
    for (const std::string_view word : words) {
        if (!list.empty()) list += word == words.back() ? " or " : ", ";
        list += '"' + std::string(word) + '"';
    }
    return list;
}

std::optional<std::size_t> number_of(const json& value, const std::vector<std::string_view>& words) {
    if (!value.is_string()) return std::nullopt;
    const auto found = std::find(words.begin(), words.end(), value.get_ref<const std::string&>());
    if (found == words.end()) return std::nullopt;
    return static_cast<std::size_t>(found - words.begin());
}

/// A value as it is in the scene, shortened if it is long.
std::string excerpt(const json& value) {
    constexpr std::size_t kLongest = 60;
    const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

} // namespace

json parse_json(std::string_view text, const std::string& name) {
    const std::string_view utf8 = utf8_text(
        text, [&](const std::string& what) { throw Error(ErrorCode::InvalidScene, name + ": " + what); });
    try {
        constexpr bool kThrow = true;
        constexpr bool kIgnoreComments = true;
        return json::parse(utf8, ParsingRules(name), kThrow, kIgnoreComments);
    } catch (const json::exception& error) {
        throw Error(ErrorCode::InvalidScene, name + ": not JSON: " + reason_of(error));
    }
}

JsonObject::JsonObject(const json& value, const std::string& scene_name, const std::string& key_path)
    : value_(value), scene_name_(scene_name), key_path_(key_path) {
    if (!value.is_object())
        fail((key_path.empty() ? "the scene" : key_path) + " is " + excerpt(value) +
             "; it must be an object");
}

void JsonObject::require(const char* key, const char* other) {
    if (has(key)) return;
    const std::string in_place =
        other != nullptr ? ", and so is " + path_of(other) + "; one of them is needed" : "";
    fail("the key " + path_of(key) + " is missing" + in_place);
}

void JsonObject::read(const char* key, bool& value) {
    const json* found = find(key);
    if (found == nullptr) return;
    if (!found->is_boolean()) refuse(key, "true or false");
    value = found->get<bool>();
}

void JsonObject::read(const char* key, double& value, Range range) {
    const json* found = find(key);
    if (found == nullptr) return;
    if (!holds(*found, double{}, range)) refuse(key, expected_number(range));
    value = found->get<double>();
}

void JsonObject::read(const char* key, std::optional<double>& value, Range range) {
    double number = 0;
    read(key, number, range);
    if (has(key)) value = number;
}

void JsonObject::read(const char* key, std::uint32_t& value, Range range) {
    const json* found = find(key);
    if (found == nullptr) return;
    if (!holds(*found, std::uint32_t{}, range)) refuse(key, expected_whole_number(range));
    value = found->get<std::uint32_t>();
}

void JsonObject::read(const char* key, Vec3d& value, Range range) {
    const json* found = find(key);
    std::array<double, 3> xyz{};
    if (found == nullptr) return;
    if (!read_array(*found, xyz, range)) refuse(key, expected_array(3, expected_number(range)));
    value = {xyz[0], xyz[1], xyz[2]};
}

void JsonObject::read(const char* key, std::array<double, 2>& value, Range range) {
    const json* found = find(key);
    if (found != nullptr && !read_array(*found, value, range))
        refuse(key, expected_array(2, expected_number(range)));
}

void JsonObject::read(const char* key, std::array<double, 4>& value, Range range) {
    const json* found = find(key);
    if (found != nullptr && !read_array(*found, value, range))
        refuse(key, expected_array(4, expected_number(range)));
}

void JsonObject::read(const char* key, std::array<std::uint32_t, 2>& value, Range range) {
    const json* found = find(key);
    if (found != nullptr && !read_array(*found, value, range))
        refuse(key, expected_array(2, expected_whole_number(range)));
}

void JsonObject::read(const char* key, std::vector<std::array<std::uint32_t, 2>>& value, Range range) {
    const json* found = find(key);
    if (found == nullptr) return;
    const std::string expected = "an array, each element " + expected_array(2, expected_whole_number(range));
    if (!found->is_array()) refuse(key, expected);
    value.resize(found->size());
    for (std::size_t i = 0; i < value.size(); ++i)
        if (!read_array((*found)[i], value[i], range)) refuse(key, expected);
}

void JsonObject::read(const char* key, std::vector<std::uint32_t>& value, Range range) {
    const json* found = find(key);
    if (found == nullptr) return;
    const std::string expected = "an array, each element " + expected_whole_number(range);
    if (!found->is_array()) refuse(key, expected);
    value.resize(found->size());
    for (std::size_t i = 0; i < value.size(); ++i) {
        if (!holds((*found)[i], std::uint32_t{}, range)) refuse(key, expected);
        value[i] = (*found)[i].get<std::uint32_t>();
    }
}

std::optional<std::string> JsonObject::read_string(const char* key) {
    const json* found = find(key);
    if (found == nullptr) return std::nullopt;
    if (!found->is_string()) refuse(key, "a string");
    return found->get<std::string>();
}

std::optional<std::size_t> JsonObject::read_word(const char* key,
                                                 const std::vector<std::string_view>& words) {
    const json* found = find(key);
    if (found == nullptr) return std::nullopt;
    const std::optional<std::size_t> number = number_of(*found, words);
    if (!number) refuse(key, list_of(words));
    return number;
}

std::vector<std::size_t> JsonObject::read_words(const char* key, const std::vector<std::string_view>& words) {
    const json* found = find(key);
    std::vector<std::size_t> numbers;
    if (found == nullptr) return numbers;
    const std::string expected = "an array of " + list_of(words);
    if (!found->is_array()) refuse(key, expected);
    for (const json& element : *found) {
        const std::optional<std::size_t> number = number_of(element, words);
        if (!number) refuse(key, expected);
        numbers.push_back(*number);
    }
    return numbers;
}

std::optional<JsonObject> JsonObject::object(const char* key) {
    const json* found = find(key);
    if (found == nullptr) return std::nullopt;
    return JsonObject(*found, scene_name_, path_of(key));
}

std::vector<JsonObject> JsonObject::objects(const char* key) {
    const json* found = find(key);
    std::vector<JsonObject> list;
    if (found == nullptr) return list;
    if (!found->is_array() || found->empty()) refuse(key, "an array of objects, with at least one");
    for (std::size_t i = 0; i < found->size(); ++i)
        list.emplace_back((*found)[i], scene_name_, path_of(key) + "[" + std::to_string(i) + "]");
    return list;
}

void JsonObject::finish() const {
    for (const auto& item : value_.items()) {
        const std::string& key = item.key();
        if (std::find(known_keys_.begin(), known_keys_.end(), key) != known_keys_.end()) continue;
        const auto farther = [&](const std::string& a, const std::string& b) {
            return edit_distance(key, a) < edit_distance(key, b);
        };
        const auto nearest = std::min_element(known_keys_.begin(), known_keys_.end(), farther);
        fail("there is no key " + excerpt(path_of(key)) + "; the nearest is " + excerpt(path_of(*nearest)));
    }
}

void JsonObject::refuse_keys(std::initializer_list<const char*> keys, const std::string& choice,
                             const std::string& word) const {
    for (const char* key : keys)
        if (has(key)) refuse(key, "left out, or \"" + choice + "\" must be \"" + word + "\"");
}

std::optional<std::string> JsonObject::ignore(const char* key, const std::string& instead) {
    if (!has(key)) return std::nullopt;
    known_keys_.emplace_back(key);
    return scene_name_ + ": the key " + path_of(key) + " has no effect " + instead;
}

std::optional<std::string> JsonObject::warn_of_former(const char* key, const std::string& instead) const {
    if (!has(key)) return std::nullopt;
    return scene_name_ + ": the key " + path_of(key) + " is of an earlier version; write " + instead;
}

void JsonObject::refuse(const char* key, const std::string& expected) const {
    fail(path_of(key) + " is " + excerpt(value_.at(key)) + "; it must be " + expected);
}

const json* JsonObject::find(const char* key) {
    known_keys_.emplace_back(key);
    const auto found = value_.find(key);
    return found == value_.end() ? nullptr : &*found;
}

std::string JsonObject::path_of(const std::string& key) const {
    return key_path_.empty() ? key : key_path_ + "." + key;
}

void JsonObject::fail(const std::string& sentence) const {
    throw Error(ErrorCode::InvalidScene, scene_name_ + ": " + sentence);
}

} // namespace echinus
