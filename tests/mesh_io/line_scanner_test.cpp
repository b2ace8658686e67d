#include "mesh_io/line_scanner.hpp"
#include "support/expect_error.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

std::vector<std::vector<std::string>> words_of(std::string_view text) {
    const MeshSource source{"text", text};
    LineScanner scanner(source);
    std::vector<std::vector<std::string>> lines;
    while (scanner.next_line()) {
        lines.emplace_back();
        while (!scanner.at_end_of_line()) lines.back().emplace_back(scanner.next_word());
    }
    return lines;
}

using Lines = std::vector<std::vector<std::string>>;

float coordinate(const std::string& word) {
    const MeshSource source{"text", word};
    LineScanner scanner(source);
    scanner.next_line();
    return scanner.next_coordinate();
}

} // namespace

TEST(LineScanner, SplitsLinesIntoWordsWhateverEndsTheLines) {
    const Lines expected{{"v", "1", "2"}, {"f", "3"}};
    for (const char* text :
         {"v 1 2\nf 3\n", "v 1 2\r\nf 3\r\n", "v 1 2\rf 3\r", "v 1 2\nf 3", "\n\n  v\t1  2 \n\n\tf 3\n "})
        EXPECT_EQ(words_of(text), expected) << text;
}

TEST(LineScanner, PassesOverComments) {
    EXPECT_EQ(words_of("# head\nv 1 # one\n  # nothing\nf#2\n"), (Lines{{"v", "1"}, {"f"}}));
}

TEST(LineScanner, JoinsLinesAtABackslash) {
    EXPECT_EQ(words_of("f 1 \\\n 2 \\\r\n 3\nv"), (Lines{{"f", "1", "2", "3"}, {"v"}}));
    EXPECT_EQ(words_of("f 1\\"), (Lines{{"f", "1"}}));
    EXPECT_EQ(words_of("f 1\\\n"), (Lines{{"f", "1"}}));
}

TEST(LineScanner, CountsLinesAlsoWhereTheyAreJoined) {
    const MeshSource source{"text", "a\n\nb \\\n c\r\nd"};
    LineScanner scanner(source);
    for (std::size_t expected : {1U, 3U, 5U}) {
        ASSERT_TRUE(scanner.next_line());
        EXPECT_EQ(scanner.line_number(), expected);
    }
    EXPECT_FALSE(scanner.next_line());
}

TEST(LineScanner, RefusesControlCharacters) {
    expect_error(ErrorCode::WrongFormat, "text: line 2: the line has control characters",
                 [] { words_of(std::string_view("a\nb\0c\n", 6)); });
}

TEST(LineScanner, RoundsCoordinatesToTheNearestFloatAsTheLibraryDoes) {
    std::mt19937 random(1);
    for (int i = 0; i < 20'000; ++i) {
        const auto any_float = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (!std::isfinite(any_float)) continue;
        char digits[64];
        const auto shortest = std::to_chars(digits, digits + sizeof(digits), any_float);
        EXPECT_EQ(coordinate(std::string(digits, shortest.ptr)), any_float);
        // More digits than a float has, off the float's own value.
        const std::string longer = std::to_string(double(any_float) * 1.000000037);
        if (const float expected = std::strtof(longer.c_str(), nullptr); std::isfinite(expected)) {
            EXPECT_EQ(coordinate(longer), expected) << longer;
        }
    }
}

TEST(LineScanner, TakesTheUsualSpellingsOfNumbers) {
    EXPECT_EQ(coordinate("+1.5"), 1.5F);
    EXPECT_EQ(coordinate("-.5"), -0.5F);
    EXPECT_EQ(coordinate("2."), 2.0F);
    EXPECT_EQ(coordinate("1e9"), 1e9F);
    EXPECT_EQ(coordinate("1E-9"), 1e-9F);
    EXPECT_EQ(coordinate("1e-60"), 0.0F);
    EXPECT_EQ(coordinate("1e-42"), 1e-42F); // denormal
}

TEST(LineScanner, RefusesWhatIsNoFiniteNumber) {
    for (const char* word : {"nan", "inf", "-infinity", "1e39", "1e999", "NaN"})
        expect_error(ErrorCode::InvalidMesh, "is not finite", [&] { coordinate(word); });
    for (const char* word : {"x", "1.5x", "1,5", "0x10", "--1", "+-1", "1e", "#"})
        expect_error(ErrorCode::Damaged, "a coordinate was expected", [&] { coordinate(word); });
}
