#pragma once

#include <echinus/geometry.hpp>

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace echinus {

/// Parses JSON with comments.
/// @throws Error InvalidScene if the text is not JSON or contains a key twice; the sentence begins with
/// `name`
nlohmann::json parse_json(std::string_view text, const std::string& name);

/// The limits of a number, both included.
struct Range {
    double least, most;
};

/// Reads one object of a scene key by key and remembers which keys were requested; finish() refuses all
/// others. A key that is absent leaves the value as it is, unless it is required. Every error is an Error
/// InvalidScene that names the file and the key's path.
class JsonObject {
  public:
    /// @param key_path  of the object itself, "" for the whole scene
    /// @throws Error InvalidScene if `value` is not an object
    JsonObject(const nlohmann::json& value, const std::string& scene_name, const std::string& key_path);

    bool has(const char* key) const { return value_.contains(key); }
    /// @param other  an alternative key, for the sentence
    void require(const char* key, const char* other = nullptr);

    void read(const char* key, bool& value);
    void read(const char* key, double& value, Range range);
    void read(const char* key, std::optional<double>& value, Range range);
    void read(const char* key, std::uint32_t& value, Range range);
    void read(const char* key, Vec3d& value, Range range);
    void read(const char* key, std::array<double, 2>& value, Range range);
    void read(const char* key, std::array<double, 4>& value, Range range);
    /// Whole numbers have to be written as such: 10, not 1e1.
    void read(const char* key, std::array<std::uint32_t, 2>& value, Range range);
    void read(const char* key, std::vector<std::array<std::uint32_t, 2>>& value, Range range);
    void read(const char* key, std::vector<std::uint32_t>& value, Range range);
    std::optional<std::string> read_string(const char* key);
    /// A string that has to be one of `words`; returns its index.
    std::optional<std::size_t> read_word(const char* key, const std::vector<std::string_view>& words);
    /// A list of strings, each of which has to be one of `words`.
    std::vector<std::size_t> read_words(const char* key, const std::vector<std::string_view>& words);
    /// The object under a key, if it is present.
    std::optional<JsonObject> object(const char* key);
    /// The objects of an array under a key; none if it is absent. They are named KEY[0], KEY[1], ...
    std::vector<JsonObject> objects(const char* key);
    bool is_string(const char* key) const { return has(key) && value_[key].is_string(); }
    bool is_object(const char* key) const { return has(key) && value_[key].is_object(); }
    bool is_array(const char* key) const { return has(key) && value_[key].is_array(); }
    /// An array whose first element is an object.
    bool is_array_of_objects(const char* key) const {
        return is_array(key) && !value_[key].empty() && value_[key].front().is_object();
    }

    /// To be called after all keys have been requested.
    void finish() const;

    /// Refuses keys that are present but require a different choice, which the sentence names: they are not
    /// misspelt.
    /// @param choice  the key that makes the choice @param word  the value that these keys require
    void refuse_keys(std::initializer_list<const char*> keys, const std::string& choice,
                     const std::string& word) const;

    /// Accepts a key, whatever its value, that has no effect.
    /// @param instead  what to do, which completes "...has no effect "
    /// @return the sentence about it, if the key is present
    std::optional<std::string> ignore(const char* key, const std::string& instead);

    /// The sentence about a key of an earlier version, if it is present. @param instead  what to write
    /// instead
    std::optional<std::string> warn_of_former(const char* key, const std::string& instead) const;

    /// Refuses the value of a key: `expected` completes "...; it must be ".
    [[noreturn]] void refuse(const char* key, const std::string& expected) const;

  private:
    const nlohmann::json* find(const char* key);
    std::string path_of(const std::string& key) const;
    [[noreturn]] void fail(const std::string& sentence) const;

    const nlohmann::json& value_;
    std::string scene_name_, key_path_;
    std::vector<std::string> known_keys_;
};

} // namespace echinus
