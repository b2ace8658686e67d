#pragma once

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

/// A JSON value to be written. Keys keep their order. Only json.cpp includes the underlying library, which
/// takes seconds to compile.
class Json {
  public:
    struct Member;

    Json(std::nullptr_t = nullptr); ///< null
    Json(bool value);
    Json(double value); ///< null if it is not finite
    Json(std::string_view value);
    Json(const std::string& value) : Json(std::string_view(value)) {}
    Json(const char* value) : Json(std::string_view(value)) {}
    template <std::signed_integral T>
    Json(T value) : Json(Signed{value}) {}
    template <std::unsigned_integral T>
    Json(T value) : Json(Unsigned{value}) {}
    template <typename T> // an array
    Json(const std::vector<T>& values) : Json(array()) {
        for (const T& value : values) push_back(value);
    }
    template <typename T, std::size_t count>
    Json(const std::array<T, count>& values) : Json(array()) {
        for (const T& value : values) push_back(value);
    }
    Json(std::initializer_list<double> numbers); ///< an array
    Json(std::initializer_list<Member> members); ///< an object
    Json(const Json& other);
    Json(Json&& other) noexcept;
    Json& operator=(Json other) noexcept;
    ~Json();

    static Json object();
    static Json array();

    /// @pre an object; an existing key gets the new value
    void add(const std::string& key, const Json& value);
    /// @pre an array
    void push_back(const Json& value);
    /// The members of an object with these keys, in this order.
    /// @pre all exist
    Json part(std::initializer_list<const char*> keys) const;

    // The value as text. Strings need not be UTF-8, since names of files may not be; invalid bytes are
    // replaced.
    std::string one_line() const;
    std::string indented() const; ///< ends with a newline

  private:
    struct Signed {
        long long value;
    };
    struct Unsigned {
        unsigned long long value;
    };
    Json(Signed value);
    Json(Unsigned value);

    std::unique_ptr<nlohmann::ordered_json> value_; // never null, except after a move
};

struct Json::Member {
    std::string key;
    Json value;
};
