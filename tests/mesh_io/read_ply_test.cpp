#include "mesh_io/readers.hpp"
#include "support/expectations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

using Indices = std::vector<std::uint32_t>;

PolygonMesh read_ply_text(const std::string& bytes) {
    return read_ply({"a.ply", bytes});
}

void expect_ply_error(ErrorCode code, const std::string& words, const std::string& bytes) {
    expect_error(code, words, [&] { read_ply_text(bytes); });
}

const std::string kElements = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                              "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kText = "ply\nformat ascii 1.0\n" + kElements;
const std::string kThreeVertices = "0 0 0\n1 0 0\n0 1 0\n";

/// Puts numbers together as bytes of either order.
class Bytes {
  public:
    explicit Bytes(bool big_endian) : big_endian_(big_endian) {}

    template <typename Number>
    Bytes& add(Number value) {
        auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
        if (big_endian_ == (std::endian::native == std::endian::little)) std::reverse(raw.begin(), raw.end());
        text_.append(raw.data(), raw.size());
        return *this;
    }
    const std::string& text() const { return text_; }

  private:
    bool big_endian_;
    std::string text_;
};

std::string binary_triangle(bool big_endian, float last_coordinate = 0, std::int32_t last_index = 2) {
    Bytes bytes(big_endian);
    for (float c : {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, last_coordinate}) bytes.add(c);
    bytes.add(std::uint8_t{3}).add(std::int32_t{0}).add(std::int32_t{1}).add(last_index);
    return std::string("ply\nformat binary_") + (big_endian ? "big" : "little") + "_endian 1.0\n" +
           kElements + bytes.text();
}

} // namespace

TEST(ReadPly, ReadsTextAndBothByteOrders) {
    for (const std::string& bytes :
         {kText + kThreeVertices + "3 0 1 2\n", binary_triangle(false), binary_triangle(true)}) {
        const PolygonMesh mesh = read_ply_text(bytes);
        EXPECT_EQ(mesh.vertices, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
        EXPECT_EQ(mesh.corners, (Indices{0, 1, 2}));
        EXPECT_EQ(mesh.corner_counts, (Indices{3}));
    }
}

TEST(ReadPly, PassesOverOtherPropertiesAndElementsOfEveryType) {
    const std::string header =
        "element vertex 1\nproperty double y\nproperty uchar red\nproperty int16 z\n"
        "property list ushort double weights\nproperty float32 x\n"
        "element edge 1\nproperty int a\nproperty list char int8 b\n"
        "element face 1\nproperty uint32 flags\nproperty list uint ushort vertex_index\n"
        "property int8 c\nend_header\n";
    Bytes binary(false);
    binary.add(2.5)
        .add(std::uint8_t{200})
        .add(std::int16_t{-7})
        .add(std::uint16_t{2})
        .add(0.5)
        .add(0.25)
        .add(1.5F);
    binary.add(std::int32_t{9}).add(std::int8_t{1}).add(std::int8_t{-1});
    binary.add(std::uint32_t{4000000000U})
        .add(std::uint32_t{3})
        .add(std::uint16_t{0})
        .add(std::uint16_t{0})
        .add(std::uint16_t{0})
        .add(std::int8_t{-1});
    const std::string text = "2.5 200 -7 2 0.5 0.25 1.5\n9 1 -1\n4000000000 3 0 0 0 -1\n";
    for (const std::string& bytes : {"ply\nformat ascii 1.0\ncomment # hello\nobj_info x\n" + header + text,
                                     "ply\r\nformat binary_little_endian 1.0\r\n" + header + binary.text()}) {
        const PolygonMesh mesh = read_ply_text(bytes);
        EXPECT_EQ(mesh.vertices, (std::vector<Vec3d>{{1.5, 2.5, -7}}));
        EXPECT_EQ(mesh.corners, (Indices{0, 0, 0}));
    }
}

TEST(ReadPly, ReadsFacesThatPrecedeTheirVertices) {
    EXPECT_EQ(read_ply_text(
                  "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement "
                  "vertex 3\n"
                  "property float x\nproperty float y\nproperty float z\nend_header\n3 2 1 0\n" +
                  kThreeVertices)
                  .corners,
              (Indices{2, 1, 0}));
}

TEST(ReadPly, NoticesMissingAndSurplusData) {
    expect_ply_error(ErrorCode::Damaged, "a.ply: the file ends where vertex 3 of 3 was expected",
                     kText + "0 0 0\n1 0 0\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: the file ends where face 1 of 1 was expected",
                     kText + kThreeVertices);
    expect_ply_error(ErrorCode::Damaged, "a.ply: line 13: an integer was expected, not the end of the line",
                     kText + kThreeVertices + "3 0 1\n");
    expect_ply_error(ErrorCode::Damaged,
                     "a.ply: line 14: the file continues after the elements that its header declares",
                     kText + kThreeVertices + "3 0 1 2\n3 0 1 2\n");
    const std::string binary = binary_triangle(false);
    expect_ply_error(ErrorCode::Damaged, "a.ply: the file ends at byte " + std::to_string(binary.size() - 1),
                     binary.substr(0, binary.size() - 1));
    expect_ply_error(ErrorCode::Damaged, "a.ply: the file continues", binary + "x");
    EXPECT_NO_THROW(read_ply_text(binary + "\n"));
    EXPECT_NO_THROW(read_ply_text(binary + "\r\n\x1a" + std::string(100, '\0')));
}

TEST(ReadPly, PassesOverFurtherNumbersOfALine) {
    for (const std::string lines : {"0 0 0 7\n1 0 0\n0 1 0 1 1 1 # c\n3 0 1 2 6 0.5 0.5 0 0 0 0\n",
                                    "0 0 0 x\n1 0 0\n0 1 0\n3 0 1 2 comment\n"}) {
        const PolygonMesh mesh = read_ply_text(kText + lines);
        EXPECT_EQ(mesh.vertices, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
        EXPECT_EQ(mesh.corners, (Indices{0, 1, 2}));
    }
}

TEST(ReadPly, ReadsNumbersAcrossLinesWhereTheLinesAreNotAsManyAsTheElements) {
    for (const std::string lines : {"0 0 0 1 0 0 0 1 0 3 0 1 2", "0\n0\n0\n1\n0\n0\n0\n1\n0\n3\n0\n1\n2\n",
                                    "0 0 0 1\n0 0 0 1 0 3 0\n\n1 2\n\x1a"}) {
        const PolygonMesh mesh = read_ply_text(kText + lines);
        EXPECT_EQ(mesh.vertices, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << lines;
        EXPECT_EQ(mesh.corners, (Indices{0, 1, 2})) << lines;
    }
    expect_ply_error(
        ErrorCode::Damaged,
        "a.ply: line 10: the file continues after the elements that its header declares, where "
        "numbers are read across lines, as 1 lines follow the header, but it declares 4 elements",
        kText + "0 0 0 1 0 0 0 1 0 3 0 1 2 5\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: the file ends where an integer was expected",
                     kText + "0 0 0 1 0 0 0 1 0 3 0 1\n");
}

TEST(ReadPly, IgnoresNumbersThatAreNoneWhereTheyDoNotMatter) {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float nx\nproperty float x\nproperty float y\n"
        "property float z\nproperty float u\nelement face 1\nproperty list uchar int vertex_indices\n"
        "property float quality\nend_header\n";
    EXPECT_EQ(read_ply_text(head +
                            "-1.#IND 0 0 0 nan\n1.#QNAN0 1 0 0 -inf\n-nan(ind) 0 1 0 1e999\n3 0 1 2 1.#INF\n")
                  .vertices,
              (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    expect_ply_error(ErrorCode::InvalidMesh, "a.ply: line 13: the coordinate '-1.#IND' is not finite",
                     head + "0 0 0 -1.#IND 0\n0 1 0 0 0\n0 0 1 0 0\n3 0 1 2 0\n");
    expect_ply_error(ErrorCode::Damaged,
                     "a.ply: line 13: a number was expected, not '0,5'; numbers have a decimal point",
                     head + "0,5 0 0 0 0\n0 1 0 0 0\n0 0 1 0 0\n3 0 1 2 0\n");
}

TEST(ReadPly, CutsStripsIntoTrianglesThatAllTurnTheSameWay) {
    const std::string elements = "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
                                 "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";
    const auto read_strips = [&](const std::string& strips) {
        return read_ply_text("ply\nformat ascii 1.0\n" + elements + vertices + strips + "\n");
    };
    EXPECT_EQ(read_strips("5 0 1 2 3 4").corners, (Indices{0, 1, 2, 2, 1, 3, 2, 3, 4}));
    EXPECT_EQ(read_strips("9 -1 0 1 2 -1 1 3 2 -1").corners, (Indices{0, 1, 2, 1, 3, 2}));
    EXPECT_EQ(read_strips("5 0 1 -1 2 3").corners, (Indices{}));
    EXPECT_EQ(read_strips("0").corners, (Indices{}));
    // A corner twice turns the strip round without a triangle.
    EXPECT_EQ(read_strips("6 0 1 2 2 1 3").corners, (Indices{0, 1, 2, 1, 2, 3}));
    EXPECT_EQ(read_strips("6 0 1 2 1 1 3").corners, (Indices{0, 1, 2}));
    EXPECT_EQ(read_strips("5 0 1 2 3 4").corner_counts, (Indices{3, 3, 3}));
    for (const bool big_endian : {false, true}) {
        Bytes bytes(big_endian);
        for (const float c : {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}) bytes.add(c);
        for (const std::int32_t i : {6, 0, 1, 2, -1, 3, 4}) bytes.add(i);
        EXPECT_EQ(read_ply_text(std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                                "_endian 1.0\n" + elements + bytes.text())
                      .corners,
                  (Indices{0, 1, 2}));
    }
    expect_ply_error(ErrorCode::InvalidMesh, "a.ply: line 15: face 1 refers to vertex 5, but there are 5",
                     "ply\nformat ascii 1.0\n" + elements + vertices + "4 0 1 2 5\n");
    expect_ply_error(ErrorCode::InvalidMesh, "a.ply: line 15: face 0 refers to vertex -2",
                     "ply\nformat ascii 1.0\n" + elements + vertices + "4 0 1 -2 3\n");
}

TEST(ReadPly, ReadsHeadsWithAMarkCommentsAnywhereAndEveryEndOfLine) {
    std::string head = "ply\ncomment C:\\a\\\nobj_info \\\nformat ascii 1.0\ncomment\n" + kElements;
    EXPECT_EQ(read_ply_text("\xef\xbb\xbf" + head + kThreeVertices + "3 0 1 2\n").corners,
              (Indices{0, 1, 2}));
    // A byte that looks like half of an end of line begins the data.
    const std::string binary =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\n"
        "property uchar z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
    const std::string data("\n\0\0\1\0\0\0\1\0\3\0\1\2", 13);
    for (const std::string end : {"\r", "\n", "\r\n"}) {
        std::string bytes;
        for (const char c : binary) bytes += c == '\n' ? end : std::string(1, c);
        EXPECT_EQ(read_ply_text(bytes + data).vertices[0], (Vec3d{10, 0, 0}));
    }
}

TEST(ReadPly, RefusesIndicesOutOfRangeAndCoordinatesThatAreNotFinite) {
    expect_ply_error(ErrorCode::InvalidMesh, "a.ply: line 13: face 0 refers to vertex 3, but there are 3",
                     kText + kThreeVertices + "3 0 1 3\n");
    expect_ply_error(ErrorCode::InvalidMesh, "face 0 refers to vertex -1", binary_triangle(false, 0, -1));
    expect_ply_error(ErrorCode::InvalidMesh, "not finite",
                     binary_triangle(true, std::numeric_limits<float>::quiet_NaN()));
    expect_ply_error(ErrorCode::InvalidMesh, "not finite",
                     binary_triangle(false, std::numeric_limits<float>::infinity()));
    expect_ply_error(ErrorCode::InvalidMesh, "a.ply: line 11: the coordinate 'nan'",
                     kText + "0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n");
}

TEST(ReadPly, RefusesAHeadThatMakesNoSense) {
    expect_ply_error(ErrorCode::WrongFormat, "a.ply: line 1: the word ply", "OFF\n");
    expect_ply_error(ErrorCode::WrongFormat, "a.ply: line 2: 'format'", "ply\nformat ascii 2.0\n");
    expect_ply_error(ErrorCode::WrongFormat, "a.ply: line 2: 'format'", "ply\nelement vertex 3\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: the file ends where 'end_header'",
                     "ply\nformat ascii 1.0\nelement vertex 3\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: line 3: 'property' has no meaning here",
                     "ply\nformat ascii 1.0\nproperty float x\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: line 4: 'quad' is not a type",
                     "ply\nformat ascii 1.0\nelement vertex 3\nproperty quad x\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: line 4: the length of a list",
                     "ply\nformat ascii 1.0\nelement vertex 3\nproperty list float int x\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: line 3: there cannot be -3",
                     "ply\nformat ascii 1.0\nelement vertex -3\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: the vertices have no property z",
                     "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
                     "list uchar float z\nend_header\n");
    expect_ply_error(
        ErrorCode::Damaged, "a.ply: the element 'face' has no list vertex_indices or vertex_index",
        "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int corners\nend_header\n3 0 1 2\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: the element 'ghost' has no properties",
                     "ply\nformat binary_little_endian 1.0\nelement ghost 4000000000\nend_header\n");
}
