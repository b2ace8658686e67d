#include "console/json.hpp"

#include <nlohmann/json.hpp>

#include <utility>

using nlohmann::ordered_json;

namespace {

template <typename T>
std::unique_ptr<ordered_json> make(T&& value) {
    return std::make_unique<ordered_json>(std::forward<T>(value));
}

constexpr auto kReplace = ordered_json::error_handler_t::replace;

} // namespace

Json::Json(std::nullptr_t) : value_(make(nullptr)) {}
Json::Json(bool value) : value_(make(value)) {}
Json::Json(double value) : value_(make(value)) {}
Json::Json(std::string_view value) : value_(make(value)) {}
Json::Json(Signed value) : value_(make(value.value)) {}
Json::Json(Unsigned value) : value_(make(value.value)) {}

Json::Json(std::initializer_list<double> numbers) : value_(make(std::vector<double>(numbers))) {}

Json::Json(std::initializer_list<Member> members) : Json(object()) {
    for (const Member& member : members) add(member.key, member.value);
}

Json::Json(const Json& other) : value_(make(*other.value_)) {}
Json::Json(Json&& other) noexcept = default;
Json& Json::operator=(Json other) noexcept {
    value_ = std::move(other.value_);
    return *this;
}
Json::~Json() = default;

Json Json::object() {
    Json result;
    *result.value_ = ordered_json::object();
    return result;
}

Json Json::array() {
    Json result;
    *result.value_ = ordered_json::array();
    return result;
}

void Json::add(const std::string& key, const Json& value) {
    (*value_)[key] = *value.value_;
}

void Json::push_back(const Json& value) {
    value_->push_back(*value.value_);
}

Json Json::part(std::initializer_list<const char*> keys) const {
    Json result = object();
    for (const char* key : keys) (*result.value_)[key] = value_->at(key);
    return result;
}

std::string Json::one_line() const {
    return value_->dump(-1, ' ', false, kReplace);
}

std::string Json::indented() const {
    return value_->dump(2, ' ', false, kReplace) + "\n";
}
