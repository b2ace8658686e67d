#include "mesh_io/readers.hpp"
#include "mesh_io/write_mesh.hpp"
#include "support/expectations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

PolygonMesh read_stl_text(const std::string& bytes) {
    return read_stl({"a.stl", bytes});
}

void expect_stl_error(ErrorCode code, const std::string& words, const std::string& bytes) {
    expect_error(code, "a.stl: " + words, [&] { read_stl_text(bytes); });
}

const std::string kFacet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n endloop\nendfacet\n";

std::string binary_box() {
    return encode_stl(make_box({1, 1, 1}));
}

} // namespace

TEST(ReadStl, ReadsTextWithSeveralSolids) {
    const PolygonMesh mesh =
        read_stl_text("solid a b c\n" + kFacet + kFacet + "endsolid a b c\nsolid\n" + kFacet + "endsolid\n");
    EXPECT_EQ(mesh.corner_counts, (std::vector<std::uint32_t>{3, 3, 3}));
    EXPECT_EQ(mesh.vertices.size(), 9U);
    EXPECT_EQ(mesh.vertices[4], (Vec3d{1, 0, 0}));
}

TEST(ReadStl, ReadsBinaryAlsoWhenItBeginsLikeText) {
    std::string bytes = binary_box();
    EXPECT_EQ(read_stl_text(bytes).corner_counts.size(), 12U);
    bytes.replace(0, 5, "solid");
    EXPECT_EQ(read_stl_text(bytes).corner_counts.size(), 12U);
}

TEST(ReadStl, ReadsTextInAnyCaseAndWithWordsApartOrTogether) {
    const std::string corners[] = {"0 0 0", "1 0 0", "0 1 0"};
    const auto facet = [&](const std::string& begin, const std::string& loop, const std::string& vertex,
                           const std::string& end_loop, const std::string& end) {
        std::string text = begin + "\n" + loop + "\n";
        for (const std::string& corner : corners) text += vertex + " " + corner + "\n";
        return text + end_loop + "\n" + end + "\n";
    };
    const std::string plain = facet("facet normal 0 0 1", "outer loop", "vertex", "endloop", "endfacet");
    std::string capitals = "solid a\n" + plain + "endsolid\n";
    for (char& c : capitals) c = static_cast<char>(std::toupper(c));
    for (const std::string& text :
         {capitals, "Solid\n" + plain + "ENDSOLID a\n", "solid a\n" + plain + "end solid a\n",
          "solid\n" + facet("Facet", "outerloop", "Vertex", "end loop", "End Facet") + "endsolid",
          "solid facet vertex\n" +
              facet("facet normal nan -1.#IND 1,5", "OuterLoop", "vertex", "endloop", "endfacet") +
              "endsolid endfacet\n",
          "\xef\xbb\xbf solid \\\r\n" + plain + "endsolid\x1a" + std::string(99, '\0')}) {
        const PolygonMesh mesh = read_stl_text(text);
        EXPECT_EQ(mesh.vertices, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << text;
    }
}

TEST(ReadStl, ReadsTextWhateverStandsOnOneLine) {
    std::string one_line = "solid a\n" + kFacet + kFacet + "endsolid\n";
    std::replace(one_line.begin() + 8, one_line.end(), '\n', ' ');
    EXPECT_EQ(read_stl_text(one_line).corner_counts.size(), 2U);
    std::string words = "solid a\n" + kFacet.substr(kFacet.find(" outer"));
    words.insert(8, "facet\n");
    for (std::size_t i = words.find("vertex"); i < words.size(); ++i)
        if (words[i] == ' ') words[i] = '\n';
    EXPECT_EQ(read_stl_text(words + "endsolid").corner_counts.size(), 1U);
    EXPECT_EQ(read_stl_text(
                  "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0 1 1 1\nvertex 1 0 0 # c\nvertex 0 "
                  "1 0\nendloop\n"
                  "endfacet\nendsolid\n")
                  .corner_counts.size(),
              1U);
}

TEST(ReadStl, PassesOverBytesAfterTheFacesThatCannotBeFaces) {
    std::string box = binary_box();
    for (const std::string& tail :
         {std::string("\0\0", 2), std::string("more"), std::string(100, '\0'), std::string(1001, 'x')})
        for (const char* begin : {"solid", "STLEX"})
            EXPECT_EQ(read_stl_text(box.replace(0, 5, begin) + tail).corner_counts.size(), 12U)
                << tail.size();
}

TEST(ReadStl, RefusesBytesAfterTheFacesThatCouldBeFaces) {
    const std::string box = binary_box();
    expect_stl_error(
        ErrorCode::Damaged,
        "the header of a binary STL declares 12 faces in 684 bytes, but 100 more follow, room for "
        "2 faces; write the file again",
        box + std::string(100, 'x'));
    expect_stl_error(
        ErrorCode::Damaged,
        "the header of a binary STL declares 12 faces in 684 bytes, but another binary STL follows",
        box + box);
    std::string fewer = box;
    fewer[80] = 11;
    expect_stl_error(ErrorCode::Damaged,
                     "the header of a binary STL declares 11 faces in 634 bytes, but 50 more follow", fewer);
    fewer[80] = 0;
    expect_stl_error(
        ErrorCode::Damaged,
        "the header of a binary STL declares 0 faces in 84 bytes, but 600 more follow, room for 12 faces",
        fewer);
    expect_stl_error(ErrorCode::Damaged,
                     "the header of a binary STL declares 0 faces in 84 bytes, but 602 more follow",
                     fewer + "xx");
}

TEST(ReadStl, NoticesMissingAndSurplusData) {
    const std::string box = binary_box();
    expect_stl_error(ErrorCode::Damaged,
                     "the header of a binary STL declares 12 faces in 684 bytes, but the file has 683",
                     box.substr(0, 683));
    expect_stl_error(ErrorCode::Damaged, "the file ends where 'facet' or 'endsolid' was expected",
                     "solid a\n" + kFacet);
    expect_stl_error(ErrorCode::Damaged, "the file ends where 'vertex' was expected",
                     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n");
    expect_stl_error(ErrorCode::Damaged, "line 5: 'vertex' was expected, not 'endloop'",
                     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n");
    expect_stl_error(ErrorCode::Damaged, "line 2: 'facet' or 'endsolid' was expected, not 'fact'",
                     "solid a\nfact\n");
}

TEST(ReadStl, RefusesCoordinatesThatAreNotFinite) {
    std::string bytes = binary_box();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + 84 + 3 * 50 + 12, &nan, sizeof(nan));
    expect_stl_error(ErrorCode::InvalidMesh, "face 3 has a coordinate that is not finite", bytes);
    expect_stl_error(ErrorCode::InvalidMesh, "line 4: the coordinate 'inf'",
                     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 inf 0\n");
}

TEST(ReadStl, IgnoresNormalsThatAreNotFinite) {
    std::string bytes = binary_box();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + 84, &nan, sizeof(nan));
    EXPECT_EQ(read_stl_text(bytes).corner_counts.size(), 12U);
}

TEST(ReadStl, RefusesOtherFormats) {
    for (const std::string& bytes :
         {std::string("\x89PNG\r\n\x1a\n"), std::string(200, 'x'), "<html>\n" + std::string(99, ' ')})
        expect_stl_error(ErrorCode::WrongFormat, "the file begins neither with 'solid'", bytes);
    expect_stl_error(ErrorCode::Damaged, "the header of a binary STL declares", std::string(200, '\1'));
    expect_stl_error(ErrorCode::WrongFormat, "the text is UTF-16",
                     std::string("\xff\xfes\0o\0l\0i\0d\0", 12));
}
