#include "mesh_io/readers.hpp"
#include "support/expect_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

using Indices = std::vector<std::uint32_t>;

PolygonMesh read(const std::string& bytes) {
    return read_ply({"a.ply", bytes});
}

void expect_ply_error(ErrorCode code, const std::string& words, const std::string& bytes) {
    expect_error(code, words, [&] { read(bytes); });
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
        const PolygonMesh mesh = read(bytes);
        EXPECT_EQ(mesh.vertices, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
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
        const PolygonMesh mesh = read(bytes);
        EXPECT_EQ(mesh.vertices, (std::vector<Vec3f>{{1.5F, 2.5F, -7}}));
        EXPECT_EQ(mesh.corners, (Indices{0, 0, 0}));
    }
}

TEST(ReadPly, ReadsFacesThatPrecedeTheirVertices) {
    EXPECT_EQ(read("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement "
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
    expect_ply_error(ErrorCode::Damaged, "a.ply: line 13: the line goes on with '5'",
                     kText + kThreeVertices + "3 0 1 2 5\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: the file goes on",
                     kText + kThreeVertices + "3 0 1 2\n3 0 1 2\n");
    const std::string binary = binary_triangle(false);
    expect_ply_error(ErrorCode::Damaged, "a.ply: the file ends at byte " + std::to_string(binary.size() - 1),
                     binary.substr(0, binary.size() - 1));
    expect_ply_error(ErrorCode::Damaged, "a.ply: the file goes on", binary + "x");
    EXPECT_NO_THROW(read(binary + "\n"));
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
    expect_ply_error(ErrorCode::Damaged, "a.ply: line 4: 'quad' is no type",
                     "ply\nformat ascii 1.0\nelement vertex 3\nproperty quad x\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: line 4: the length of a list",
                     "ply\nformat ascii 1.0\nelement vertex 3\nproperty list float int x\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: line 3: there cannot be -3",
                     "ply\nformat ascii 1.0\nelement vertex -3\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: the vertices have no property z",
                     "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
                     "list uchar float z\nend_header\n");
    expect_ply_error(ErrorCode::Damaged, "a.ply: the element 'ghost' has no properties",
                     "ply\nformat binary_little_endian 1.0\nelement ghost 4000000000\nend_header\n");
}
