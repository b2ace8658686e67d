#include "mesh_io/line_scanner.hpp"
#include "support/expectations.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

using Lines = std::vector<std::vector<std::string>>;
constexpr auto kJoins = LineScanner::Continuation::Backslash;

Lines words_of(std::string_view text, LineScanner::Continuation continuation = {}) {
    const MeshSource source{"text", text};
    LineScanner scanner(source, continuation);
    Lines lines;
    while (scanner.next_line()) {
        lines.emplace_back();
        while (!scanner.at_end_of_line()) lines.back().emplace_back(scanner.next_word());
    }
    return lines;
}

double exact_coordinate(const std::string& word) {
    const MeshSource source{"text", word};
    LineScanner scanner(source);
    scanner.next_line();
    return scanner.next_coordinate();
}

float coordinate(const std::string& word) {
    return static_cast<float>(exact_coordinate(word));
}

/// The zeros that a C string cannot hold.
const std::string kZeros(600, '\0');

} // namespace

TEST(LineScanner, SplitsLinesIntoWordsWhateverEndsTheLines) {
    const Lines expected{{"v", "1", "2"}, {"f", "3"}};
    for (const char* text :
         {"v 1 2\nf 3\n", "v 1 2\r\nf 3\r\n", "v 1 2\rf 3\r", "v 1 2\nf 3", "\n\n  v\t1  2 \n\n\tf 3\n "})
        EXPECT_EQ(words_of(text), expected) << text;
}

TEST(LineScanner, PassesOverComments) {
    EXPECT_EQ(words_of("# head\nv 1 # one\n  # nothing\nf#2\n1.#INFinite\n21.#\n"),
              (Lines{{"v", "1"}, {"f"}, {"1.#INFinite"}, {"21."}}));
}

TEST(LineScanner, TakesNoHashInsideOfANumberForAComment) {
    for (const std::string number :
         {"1.#QNAN", "-1.#IND", "1.#INF00", "+1.#SNAN", "-1.#J", "1.#R", "1.#QO"}) {
        EXPECT_EQ(words_of("v " + number + "#x\n"), (Lines{{"v", number}}));
        expect_error(ErrorCode::InvalidMesh, "text: line 1: the coordinate '" + number + "' is not finite",
                     [&] { coordinate(number); });
    }
}

TEST(LineScanner, JoinsLinesAtABackslashWhereTheFormatDoes) {
    EXPECT_EQ(words_of("f 1 \\\n 2\\\r\n3 \\\r4\nv", kJoins), (Lines{{"f", "1", "2", "3", "4"}, {"v"}}));
    EXPECT_EQ(words_of("f 1\\", kJoins), (Lines{{"f", "1"}}));
    EXPECT_EQ(words_of("f 1\\\n", kJoins), (Lines{{"f", "1"}}));
    EXPECT_EQ(words_of("f 1\\\n\\\n\n2", kJoins), (Lines{{"f", "1"}, {"2"}}));
    EXPECT_EQ(words_of("a\\b c\\ \n", kJoins), (Lines{{"a\\b", "c\\"}}));
    EXPECT_EQ(words_of("f 1\\\n2"), (Lines{{"f", "1\\"}, {"2"}}));
}

TEST(LineScanner, JoinsNoLineToAComment) {
    EXPECT_EQ(words_of("# a \\\nv 1 # b\\\nf \\\n2 #\\\n3", kJoins), (Lines{{"v", "1"}, {"f", "2"}, {"3"}}));
}

TEST(LineScanner, CountsLinesAlsoWhereTheyAreJoined) {
    const MeshSource source{"text", "a\n\nb \\\n c\r\nd"};
    LineScanner scanner(source, kJoins);
    for (std::size_t expected : {1U, 3U, 5U}) {
        ASSERT_TRUE(scanner.next_line());
        EXPECT_EQ(scanner.line_number(), expected);
    }
    EXPECT_FALSE(scanner.next_line());
}

TEST(LineScanner, RefusesControlCharacters) {
    expect_error(ErrorCode::WrongFormat, "text: line 2: the line has control characters",
                 [] { words_of(std::string_view("a\nb\0c\n", 6)); });
    for (const std::string& text :
         {kZeros, "\x1a" + kZeros, std::string("a\n\x1a\nb\n"), "a\n" + kZeros + "b", std::string("a \x1b")})
        expect_error(ErrorCode::WrongFormat, "the line has control characters", [&] { words_of(text); });
}

TEST(LineScanner, EndsWhereZerosOrControlZFillUpTheFile) {
    for (const std::string& padding :
         {std::string("\x1a"), "\n\x1a" + kZeros, std::string(kZeros), "\r\n\x1a\r\n\x1a \n" + kZeros})
        EXPECT_EQ(words_of("a\nb" + padding), (Lines{{"a"}, {"b"}}));
}

TEST(LineScanner, PassesOverAByteOrderMarkAndNamesUtf16) {
    EXPECT_EQ(words_of("\xef\xbb\xbf"
                       "a\n"),
              (Lines{{"a"}}));
    for (const std::string& text : {std::string("\xff\xfe"
                                                "a\0\n\0",
                                                6),
                                    std::string("\xfe\xff"
                                                "\0a\0\n",
                                                6)})
        expect_error(ErrorCode::WrongFormat, "text: the text is UTF-16; save it as UTF-8",
                     [&] { words_of(text); });
    expect_error(ErrorCode::WrongFormat, "text: the text is UTF-32; save it as UTF-8",
                 [&] { words_of(std::string("\xff\xfe\0\0a\0\0\0", 8)); });
    for (const std::string& text : {std::string("a\0b\0\n\0", 6), std::string("\0a\0\n", 4)})
        expect_error(ErrorCode::WrongFormat, "or it is UTF-16, which must be saved as UTF-8",
                     [&] { words_of(text); });
}

TEST(LineScanner, ReadsNumbersAcrossLinesOnlyWhenToldTo) {
    const MeshSource source{"text", "1 2\n# c\n\n3\n4 5\n"};
    LineScanner scanner(source);
    ASSERT_TRUE(scanner.next_line());
    EXPECT_EQ(scanner.count_lines_left(), 2U);
    scanner.read_across_lines(", for a reason");
    EXPECT_EQ(scanner.next_position(), (Vec3d{1, 2, 3}));
    EXPECT_EQ(scanner.next_integer("a number"), 4);
    expect_error(ErrorCode::InvalidMesh,
                 "text: line 5: the face refers to vertex 5, but there are 2 vertices, "
                 "numbered from 0, for a reason",
                 [&] { scanner.next_vertex_index(2); });
    scanner.read_within_lines();
    expect_error(ErrorCode::Damaged, "text: line 5: a number was expected, not the end of the line",
                 [&] { scanner.skip_number(); });
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

TEST(LineScanner, ReadsCoordinatesAsTheNearestDouble) {
    for (const double number : {0.1, 5411932.40, -1e-300, 448262.25, 1e30 / 3})
        EXPECT_EQ(exact_coordinate(std::to_string(number)), std::stod(std::to_string(number)));
}

TEST(LineScanner, TakesTheUsualSpellingsOfNumbers) {
    EXPECT_EQ(coordinate("+1.5"), 1.5F);
    EXPECT_EQ(coordinate("-.5"), -0.5F);
    EXPECT_EQ(coordinate("2."), 2.0F);
    EXPECT_EQ(coordinate("1e9"), 1e9F);
    EXPECT_EQ(coordinate("1E-9"), 1e-9F);
    EXPECT_EQ(coordinate("1e-60"), 0.0F);
    EXPECT_EQ(coordinate("1e-42"), 1e-42F); // denormal
    EXPECT_EQ(coordinate("1e-400"), 0.0F);
}

TEST(LineScanner, RoundsATextNextToTheMiddleOfTwoFloatsOnlyOnce) {
    // 1 + 2^-24 is the middle of two floats, and the double that is nearest to all of these.
    EXPECT_EQ(coordinate("1.000000059604644775390625"), 1.0F);
    EXPECT_EQ(coordinate("1.0000000596046447753906250001"), std::nextafter(1.0F, 2.0F));
    EXPECT_EQ(coordinate("-1.0000000596046447753906250001"), -std::nextafter(1.0F, 2.0F));
    EXPECT_EQ(coordinate("1.0000000596046447753906249999"), 1.0F);
    // 2^-150, the middle of 0 and the smallest float, has 105 digits.
    const std::string middle = "7."
                               "00649232162408535461864791644958065640130970938257885878534141944895541342930"
                               "300743319094181060791015625";
    EXPECT_EQ(coordinate(middle + "e-46"), 0.0F);
    EXPECT_EQ(coordinate(middle + "1e-46"), std::numeric_limits<float>::denorm_min());
}

TEST(LineScanner, SaysHowNumbersAreWritten) {
    expect_error(ErrorCode::Damaged, "not '1,5'; numbers have a decimal point", [] { coordinate("1,5"); });
    expect_error(ErrorCode::Damaged, "not '1.5D+3'; exponents are written with an e",
                 [] { coordinate("1.5D+3"); });
    expect_error(ErrorCode::Damaged, "a coordinate was expected, not 'dd'", [] { coordinate("dd"); });
}

TEST(LineScanner, RefusesWhatIsNoFiniteNumber) {
    for (const char* word : {"nan", "inf", "-infinity", "1e39", "1e999", "NaN"})
        expect_error(ErrorCode::InvalidMesh, "is not finite", [&] { coordinate(word); });
    for (const char* word : {"x", "1.5x", "1,5", "0x10", "--1", "+-1", "1e", "#"})
        expect_error(ErrorCode::Damaged, "a coordinate was expected", [&] { coordinate(word); });
}
