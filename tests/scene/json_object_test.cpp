#include "scene/json_object.hpp"
#include "support/expectations.hpp"

#include <gtest/gtest.h>

#include <functional>

using namespace echinus;

namespace {

std::string refusal(const std::function<void()>& action) {
    return test::refusal_of(ErrorCode::InvalidScene, action);
}

std::string refusal_of_text(const std::string& text) {
    return refusal([&] { parse_json(text, "a.json"); });
}

} // namespace

TEST(Json, MayHaveComments) {
    EXPECT_EQ(parse_json("/* one */ {\"a\": 1} // two", "a.json")["a"], 1);
}

TEST(Json, ThatIsNoneIsRefusedWithLineAndColumn) {
    const std::string sentence = refusal_of_text("{\n  \"a\": }");
    EXPECT_EQ(sentence.rfind("a.json: not JSON: parse error at line 2, column 8", 0), 0u) << sentence;
    EXPECT_EQ(sentence.find('\n'), std::string::npos);
    EXPECT_NE(refusal_of_text(""), "");
    EXPECT_NE(refusal_of_text("{\"a\": NaN}"), "");
    EXPECT_NE(refusal_of_text("{\"a\": 1e999}"), "");
    EXPECT_NE(refusal_of_text(std::string("\x89PNG\r\n\x1a\n\0\0", 10)), "");
    EXPECT_NE(refusal_of_text("{\"a\": 1} {}"), "");
}

TEST(Json, InAnotherEncodingThanUtf8IsNamed) {
    EXPECT_EQ(parse_json("\xef\xbb\xbf{\"a\": 1}", "a.json")["a"], 1);
    EXPECT_EQ(refusal_of_text(std::string("\xff\xfe{\0}\0", 6)),
              "a.json: the text is UTF-16; save it as UTF-8 or ASCII");
    EXPECT_EQ(refusal_of_text(std::string("\0\0\xfe\xff\0\0\0{", 8)),
              "a.json: the text is UTF-32; save it as UTF-8 or ASCII");
}

TEST(Json, DeepEnoughToOverflowAStackIsRefused) {
    constexpr std::size_t kLevels = 100'000;
    const std::string open(kLevels, '[');
    EXPECT_NE(refusal_of_text(open), "");
    const auto show = [&](const std::string& text) { // the excerpt in a sentence is made by a recursion
        return refusal([&] {
            const nlohmann::json json = parse_json("{\"a\":" + text + "}", "a.json");
            JsonObject(json, "a.json", "").object("a");
        });
    };
    EXPECT_EQ(show(open + std::string(kLevels, ']')), "a.json: nests deeper than 32 levels");
    EXPECT_EQ(show("[[[[[[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]]]]]]"),
              "a.json: a is [[[[[[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]]]]]]; it must be an object");
}

TEST(Json, GivingAKeyTwiceIsRefused) {
    EXPECT_EQ(refusal_of_text(R"({"a": {"b": 1, "c": 2, "b": 3}})"),
              R"(a.json: the key "b" is given twice in one object)");
    EXPECT_EQ(refusal_of_text(R"({"a": {"b": 1}, "c": {"b": 1}, "b": 2})"), "");
}

TEST(JsonObject, LeavesAValueAsItIsWhereTheKeyIsAbsent) {
    const nlohmann::json empty = parse_json("{}", "a.json");
    JsonObject object(empty, "a.json", "");
    double number = 3;
    Vec3d vector{1, 2, 3};
    object.read("number", number, {0, 10});
    object.read("vector", vector, {0, 10});
    object.finish();
    EXPECT_EQ(number, 3);
    EXPECT_EQ(vector, (Vec3d{1, 2, 3}));
    EXPECT_EQ(object.read_string("string"), std::nullopt);
    EXPECT_EQ(object.read_word("word", {"x"}), std::nullopt);
    EXPECT_FALSE(object.object("object"));
}

TEST(JsonObject, NamesTheNearestOfTheKeysThatItWasAskedFor) {
    const nlohmann::json json = parse_json(R"({"gravty": 1})", "a.json");
    JsonObject object(json, "a.json", "solver");
    double number = 0;
    for (const char* key : {"iterations", "gravity", "drag"}) object.read(key, number, {0, 10});
    EXPECT_EQ(refusal([&] { object.finish(); }),
              R"(a.json: there is no key "solver.gravty"; the nearest is "solver.gravity")");
}

TEST(JsonObject, SaysWhatAValueMustBe) {
    const nlohmann::json json = parse_json(
        R"({"number": "three", "count": 2.5, "vector": [1, 2], "pair": [1, 99], "word": "green",
            "words": ["red", 3], "object": [], "pairs": [[1, 2], 3]})",
        "a.json");
    JsonObject object(json, "a.json", "");
    double number = 0;
    std::uint32_t count = 0;
    Vec3d vector;
    std::array<std::uint32_t, 2> pair{};
    std::vector<std::array<std::uint32_t, 2>> pairs;
    const std::vector<std::string_view> colours{"red", "blue"};
    const auto expect = [&](const std::string& sentence, const std::function<void()>& action) {
        EXPECT_EQ(refusal(action), "a.json: " + sentence);
    };
    expect("number is \"three\"; it must be a number from 0 to 1", [&] {
        object.read("number", number, {0, 1});
    });
    expect("count is 2.5; it must be a whole number from 1 to 9", [&] {
        object.read("count", count, {1, 9});
    });
    expect("count is 2.5; it must be a whole number from 1 to 4000000000", [&] {
        object.read("count", count, {1, 4e9});
    });
    expect("vector is [1,2]; it must be an array of 3 elements, each a number from -1 to 9", [&] {
        object.read("vector", vector, {-1, 9});
    });
    expect("pair is [1,99]; it must be an array of 2 elements, each a whole number from 1 to 9", [&] {
        object.read("pair", pair, {1, 9});
    });
    expect("pairs is [[1,2],3]; it must be an array, each element an array of 2 elements, each a whole "
           "number from 0 to 9",
           [&] {
               object.read("pairs", pairs, {0, 9});
           });
    expect("word is \"green\"; it must be \"red\" or \"blue\"", [&] { object.read_word("word", colours); });
    expect("words is [\"red\",3]; it must be an array of \"red\" or \"blue\"",
           [&] { object.read_words("words", colours); });
    expect("object is []; it must be an object", [&] { object.object("object"); });
    expect("count is 2.5; it must be a string", [&] { object.read_string("count"); });
    expect("the key colour is missing", [&] { object.require("colour"); });
}

TEST(JsonObject, RefusesWhatIsNoUnsignedNumber) {
    const nlohmann::json json = parse_json(R"({"a": -1, "b": 4294967296, "c": true, "d": null})", "a.json");
    JsonObject object(json, "a.json", "");
    std::uint32_t count = 7;
    for (const char* key : {"a", "b", "c", "d"})
        EXPECT_NE(refusal([&] { object.read(key, count, {0, 4294967295.0}); }), "") << key;
    EXPECT_EQ(count, 7u);
}
