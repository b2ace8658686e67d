// Public reports about mesh files that were refused, misread or fatal, most of them of other programs: each
// with bytes that were made anew from the description, and the right answer.

#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh.hpp>
#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <variant>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

using Corner = std::array<int, 3>;

/// The unit cube, whose corners' numbers have the coordinates as bits.
const std::vector<Corner> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
const std::vector<std::vector<int>> kFaces{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                           {1, 3, 7}, {1, 7, 5}, {3, 2, 6}, {3, 6, 7}, {2, 0, 4}, {2, 4, 6}};
const std::vector<std::vector<int>> kSquares{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                             {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};

/// A line for each list of numbers.
template <typename Lists>
std::string lines(const std::string& before, const Lists& lists, const std::string& after = "",
                  int more = 0) {
    std::string text;
    for (const auto& list : lists) {
        text += before;
        for (const int number : list) text += " " + std::to_string(number + more);
        text += after + "\n";
    }
    return text;
}

std::string replaced(std::string text, const std::string& old, const std::string& with) {
    for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos; at += with.size())
        text.replace(at, old.size(), with);
    return text;
}

const std::string kObj = lines("v", kCorners) + lines("f", kFaces, "", 1);
const std::string kMark = "\xef\xbb\xbf"; ///< the byte order mark in UTF-8

std::string capitals(std::string text) {
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
}
std::string utf16(const std::string& text) {
    std::string bytes = "\xff\xfe";
    for (const char c : text) bytes += {c, '\0'};
    return bytes;
}

const std::string kOffBody = lines("", kCorners) + lines("3", kFaces);
const std::string kOff = "OFF\n8 12 0\n" + kOffBody;

std::string ply_head(const std::string& format, const std::string& of_vertex = "",
                     const std::string& list = "property list uchar int vertex_indices\n",
                     const std::string& between = "") {
    return "ply\nformat " + format + " 1.0\nelement vertex 8\nproperty float x\nproperty float y\n" +
           "property float z\n" + of_vertex + between + "element face 12\n" + list + "end_header\n";
}
const std::string kPly = ply_head("ascii") + kOffBody;

template <typename Number>
std::string bytes_of(Number value) {
    return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

/// @param first_x  replaces the x of the first corner, bit for bit
std::string binary_ply(const std::string& line_end, std::uint32_t first_x = 0) {
    std::string bytes = replaced(ply_head("binary_little_endian"), "\n", line_end);
    for (const Corner& corner : kCorners)
        for (const int c : corner) bytes += bytes_of(static_cast<float>(c));
    const std::size_t data = bytes.size() - kCorners.size() * 12;
    std::memcpy(bytes.data() + data, &first_x, 4);
    for (const auto& face : kFaces) {
        bytes += '\3';
        for (const int corner : face) bytes += bytes_of(std::int32_t{corner});
    }
    return bytes;
}

/// @param number  writes a coordinate, which is 0 or 1
std::string text_stl(const std::string& name, const std::function<std::string(int)>& number) {
    std::string text = "solid" + name + "\n";
    for (const auto& face : kFaces) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const int corner : face) {
            text += "vertex";
            for (const int c : kCorners[static_cast<std::size_t>(corner)]) text += " " + number(c);
            text += "\n";
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid" + name + "\n";
}
std::string text_stl(const std::string& name = "") {
    return text_stl(name, [](int c) { return std::to_string(c); });
}

std::string binary_stl(std::string head, std::uint16_t attribute = 0) {
    head.resize(80, ' ');
    std::string bytes = head + bytes_of(static_cast<std::uint32_t>(kFaces.size()));
    for (const auto& face : kFaces) {
        bytes += std::string(12, '\0');
        for (const int corner : face)
            for (const int c : kCorners[static_cast<std::size_t>(corner)])
                bytes += bytes_of(static_cast<float>(c));
        bytes += bytes_of(attribute);
    }
    return bytes;
}

template <typename Index>
std::string index_bytes(const std::vector<std::vector<int>>& lists) {
    std::string bytes;
    for (const auto& list : lists)
        for (const int index : list) bytes += bytes_of(static_cast<Index>(index));
    return bytes;
}

/// A GLB file of one mesh. The first view has the corners of the cube and the second the indices.
struct Glb {
    std::string indices = index_bytes<std::uint16_t>(kFaces);
    std::string index_accessors = R"({"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"})";
    std::string primitives = R"({"attributes":{"POSITION":0},"indices":1})";
    std::string nodes = R"({"mesh":0})";
    std::string more = {}; ///< members of the whole
    std::size_t missing_bytes = 0;

    std::string bytes() const {
        std::string binary;
        for (const Corner& corner : kCorners)
            for (const int c : corner) binary += bytes_of(static_cast<float>(c));
        binary += indices;
        std::string roots = "0";
        for (std::size_t i = 1; i <= std::size_t(std::count(nodes.begin(), nodes.end(), '|')); ++i)
            roots += "," + std::to_string(i);
        std::string json =
            R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" +
            replaced(nodes, "|", ",") + R"(],"meshes":[{"primitives":[)" + primitives +
            R"(]}],"buffers":[{"byteLength":)" + std::to_string(binary.size()) +
            R"(}],"bufferViews":[{"buffer":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":)" +
            std::to_string(indices.size()) +
            R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3",)" +
            R"("min":[0,0,0],"max":[1,1,1]},)" + index_accessors + "]" + more + "}";
        json.resize((json.size() + 3) / 4 * 4, ' ');
        binary.resize(binary.size() - missing_bytes);
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        const auto size_of = [](const std::string& s) {
            return bytes_of(static_cast<std::uint32_t>(s.size()));
        };
        const std::string chunks =
            size_of(json) + "JSON" + json + size_of(binary) + std::string("BIN\0", 4) + binary;
        return "glTF" + bytes_of(std::uint32_t{2}) +
               bytes_of(static_cast<std::uint32_t>(chunks.size() + 12)) + chunks;
    }
};

std::string strips(int mode, const std::vector<std::vector<int>>& lists,
                   std::string nodes = R"({"mesh":0})") {
    Glb glb{.indices = index_bytes<std::uint16_t>(lists),
            .index_accessors = "",
            .primitives = "",
            .nodes = nodes};
    std::size_t offset = 0;
    for (std::size_t i = 0; i < lists.size(); ++i) {
        const std::string comma = i == 0 ? "" : ",";
        glb.index_accessors += comma + R"({"bufferView":1,"byteOffset":)" + std::to_string(offset) +
                               R"(,"componentType":5123,"count":)" + std::to_string(lists[i].size()) +
                               R"(,"type":"SCALAR"})";
        glb.primitives += comma + R"({"attributes":{"POSITION":0},"indices":)" + std::to_string(i + 1) +
                          R"(,"mode":)" + std::to_string(mode) + "}";
        offset += 2 * lists[i].size();
    }
    return glb.bytes();
}

/// Read as a closed solid.
struct Solid {
    std::size_t face_count = 12;
    double volume = 1;
};
/// Read, though it is not closed.
struct Open {
    std::size_t face_count;
};
/// Refused in a sentence with these words.
struct Refused {
    std::string words;
};

struct FileReport {
    const char* thread;
    std::string name;
    std::string content;
    std::variant<Solid, Open, Refused> right = Solid{};
};

std::vector<FileReport> obj_reports() {
    std::string blocks;
    for (int block = 0; block < 3; ++block) {
        for (const Corner& c : kCorners)
            blocks += lines("v", std::vector<Corner>{{c[0] + 2 * block, c[1], c[2]}});
        blocks += lines("f", kSquares, "", -8);
    }
    std::string long_face = lines("v", kCorners) + "f";
    for (int i = 0; i < 300; ++i) long_face += " 1 2 4 3";
    return {
        {"mikedh/trimesh#2364: blocks of vertices and faces that count back", "a.obj", blocks, Solid{36, 3}},
        {"tinyobjloader/tinyobjloader#140: faces that count from 0", "a.obj",
         lines("v", kCorners) + lines("f", kFaces), Refused{"line 9: there is no vertex 0"}},
        {"thisistherk/fast_obj#41, assimp/assimp#1018, Twinklebear/tobj#78: a fourth coordinate", "a.obj",
         lines("v", kCorners, " 1.00000") + lines("f", kFaces, "", 1)},
        {"mrdoob/three.js#15171, NVIDIAGameWorks/kaolin#300: colours behind coordinates", "a.obj",
         lines("v", kCorners, " 0.5 0.25 1") + lines("f", kFaces, "", 1)},
        {"thisistherk/fast_obj#2: the file ends with an empty group", "a.obj", kObj + "g"},
        {"mrdoob/three.js#11795: smoothing groups without or with strange numbers", "a.obj",
         "s\ns off off\ns -1\n" + kObj},
        {"LiangliangNan/Easy3D#101: a line of 2 KB, whose face goes around 300 times", "a.obj",
         long_face + "\n", Open{1198}},
        {"Dezinater/osrscachereader#16: commas between coordinates", "a.obj", "v 0, 0, 0\n" + kObj,
         Refused{"line 1"}},
        {"WesUnwin/obj-file-parser#19: tabs, and blanks at the ends of lines", "a.obj",
         replaced(replaced(kObj, " ", "\t"), "\n", "  \n")},
        {"thisistherk/fast_obj#10: lines that go on", "a.obj", replaced(kObj, " 1", " \\\n1")},
        {"the lines of an old Macintosh", "a.obj", replaced(kObj, "\n", "\r")},
        {"humu2009/jsc3d#4: a face of two corners", "a.obj", kObj + "f 1 2\n", Refused{"line 21"}},
        {"assimp/assimp#1453, mikedh/trimesh#548: points only", "a.obj", lines("v", kCorners),
         Refused{"the file has no faces"}},
        {"assimp/assimp#3532: a backslash within a comment", "a.obj", "# C:\\parts\\cube.max\n" + kObj},
        {"a backslash at the end of a comment", "a.obj", "# D:\\models\\\n" + kObj},
        {"tinyobjloader/tinyobjloader#394: a byte order mark", "a.obj", kMark + kObj},
        {"assimp/assimp#2930, #2063: UTF-16", "a.obj", utf16(kObj), Refused{"UTF-16"}},
        {"Ctrl-Z at the end, as of DOS", "a.obj", kObj + "\x1a"},
        {"zeros at the end", "a.obj", kObj + std::string(100, '\0')},
        {"assimp/assimp#5890: comments behind numbers", "a.obj", replaced(kObj, "\n", " # here\n")},
        {"assimp/assimp#538: what Microsoft's libraries print for NaN", "a.obj", "v 0 0 1.#QNAN\n" + kObj,
         Refused{"line 1"}},
        {"assimp/assimp#538: the same in a normal", "a.obj", "vn 0 0 -1.#IND\n" + kObj},
        {"NVlabs/instant-ngp#1391, assimp/assimp#2428: NaN in a texture coordinate", "a.obj",
         "vt nan -nan(ind)\n" + kObj},
        {"shurans/SUNCGtoolbox#27: a coordinate that is no number", "a.obj", "v nan 0 0\n" + kObj,
         Refused{"line 1"}},
    };
}

std::vector<FileReport> ply_reports() {
    const std::string texcoord =
        "property list ushort uint vertex_indices\nproperty list uchar float texcoord\n";
    return {
        {"cnr-isti-vclab/meshlab#290: other types of counts, and lists of floats", "a.ply",
         ply_head("ascii", "", texcoord) + lines("", kCorners) + lines("3", kFaces, " 6 0 0 0.5 0 1 1")},
        {"mikedh/trimesh#138: float32, uint8 and int32", "a.ply",
         replaced(replaced(kPly, "float", "float32"), "list uchar int", "list uint8 int32")},
        {"assimp/assimp#2534, #3711: \\r\\n at the ends of the head's lines, then bytes", "a.ply",
         binary_ply("\r\n")},
        {"assimp/assimp#5341, #4755: the first byte is a line feed", "a.ply", binary_ply("\n", 0x0a)},
        {"assimp/assimp#5341: the first bytes are \\r\\n or \\n\\r", "a.ply", binary_ply("\r\n", 0x0d0a)},
        {"the same, and the head's lines end with \\n", "a.ply", binary_ply("\n", 0x0a0d)},
        {"PyMesh/PyMesh#13: a property of vertices and of faces with one name", "a.ply",
         ply_head("ascii", "property uchar red\n",
                  "property list uchar int vertex_indices\nproperty uchar red\n") +
             lines("", kCorners, " 255") + lines("3", kFaces, " 128")},
        {"scier/MetalSplatter#56: elements that are neither vertices nor faces", "a.ply",
         ply_head(
             "ascii", "", "property list uchar int vertex_indices\n",
             "element extrinsic 4\nproperty float extrinsic\nelement image_size 2\nproperty uint size\n") +
             lines("", kCorners) + "1\n0\n0\n0.5\n640\n480\n" + lines("3", kFaces)},
        {"assimp/assimp#6296, #2337, vilya/miniply#1: triangle strips, as of Stanford", "a.ply",
         replaced(ply_head("ascii", "", "property list int int vertex_indices\n"), "element face 12",
                  "element tristrips 1") +
             lines("", kCorners) + "47 0 2 3 -1 0 3 1 -1 4 5 7 -1 4 7 6 -1 0 1 5 -1 0 5 4 -1 " +
             "1 3 7 -1 1 7 5 -1 3 2 6 -1 3 6 7 -1 2 0 4 -1 2 4 6\n"},
        {"numbers that are wrapped at will", "a.ply",
         ply_head("ascii") + replaced(replaced(kOffBody, "\n", " "), " 1 ", "\n1 ") + "\n"},
        {"mikedh/trimesh's fuze_ascii.ply: more numbers on the lines of faces than the head says", "a.ply",
         ply_head("ascii") + lines("", kCorners) + lines("3", kFaces, " 0.5 0.5")},
        {"a byte order mark", "a.ply", kMark + kPly},
        {"nmwsharp/happly#45, PointCloudLibrary/pcl#5033: a property of doubles among floats", "a.ply",
         ply_head("ascii", "property double quality\n") + lines("", kCorners, " 0.125") + lines("3", kFaces)},
        {"assimp/assimp#538: what Microsoft's libraries print for NaN, in a normal", "a.ply",
         ply_head("ascii", "property float nx\n") + lines("", kCorners, " -1.#IND") + lines("3", kFaces)},
        {"the same in a coordinate", "a.ply", replaced(kPly, " 1 1 1\n", " 1 1 1.#QNAN\n"),
         Refused{"line 17"}},
        {"dranjan/python-plyfile#32: a byte order mark where the data begin", "a.ply",
         replaced(kPly, "end_header\n", "end_header\n\xef\xbb\xbf"), Refused{"line 10"}},
        {"fewer faces than the head says", "a.ply", kPly.substr(0, kPly.size() - 9), Refused{"a.ply"}},
    };
}

std::vector<FileReport> stl_reports() {
    const auto numbers = [](const char* zero, const char* one) {
        return [=](int c) { return std::string(c == 0 ? zero : one); };
    };
    return {
        {"cnr-isti-vclab/meshlab#734: a name of 500 characters", "a.stl",
         text_stl(" 2STL_V_1_0" + std::string(500, '/') + "BYE")},
        {"mrdoob/three.js#13612, Innoptech/OpenSTL#25, johannesboyne/node-stl#8: exponents without a point",
         "a.stl", text_stl("", numbers("-2e-38", "1E0"))},
        {"nschloe/meshio#745, christopherpoole/CADMesh#2, slic3r/Slic3r#912: exponents of many digits",
         "a.stl", text_stl("", numbers("-0.000000e+00", "1.000000e+000"))},
        {"wolph/numpy-stl#52: blanks of every length", "a.stl", replaced(text_stl(), " ", "   ")},
        {"openscad/openscad#258, assimp/assimp#102, sreiter/stl_reader#3: bytes that begin with solid",
         "a.stl", binary_stl("solid")},
        {"aslze/minirender#2, compas-dev/compas#179: a head as of a text", "a.stl",
         binary_stl("solid base\nfacet normal 0 0 0\n")},
        {"slic3r/Slic3r#2971: capitals", "a.stl", capitals(text_stl(" Untitled1"))},
        {"wolph/numpy-stl#154, #155, enspiral-cherubi/three-stl-loader#7: some capitals", "a.stl",
         replaced(replaced(text_stl(), "endsolid", "ENDSOLID"), "solid", "Solid")},
        {"wolph/numpy-stl#206, cnr-isti-vclab/meshlab#194: end solid and end loop", "a.stl",
         replaced(replaced(text_stl(), "endsolid", "end solid"), "endloop", "end loop")},
        {"a byte order mark", "a.stl", kMark + text_stl()},
        {"InsightSoftwareConsortium/ITK#6289, BlueQuartzSoftware/simplnx#1696: spare bytes at the end",
         "a.stl", binary_stl("exported") + std::string(2, '\0')},
        {"the same behind a head that begins with solid", "a.stl",
         binary_stl("solid") + std::string(2, '\0')},
        {"colours in the attributes, as of Magics", "a.stl",
         binary_stl("COLOR=\xff\x7f\x1f\xff,MATERIAL=...", 0x8421)},
        {"two solids in one text", "a.stl",
         text_stl(" a") + replaced(text_stl(" b"), "vertex 1", "vertex -1"), Open{24}},
        {"mikedh/trimesh#95, wolph/numpy-stl#191: no faces", "a.stl",
         binary_stl("solid").substr(0, 80) + std::string(4, '\0'), Refused{"no faces"}},
        {"a file that was cut off", "a.stl", binary_stl("").substr(0, 600), Refused{"12 faces"}},
    };
}

std::vector<FileReport> off_reports() {
    return {
        {"CGAL/cgal#4501: the head says colours and normals, and there are none", "a.off",
         replaced(kOff, "OFF", "CNOFF")},
        {"CGAL/cgal#9034: colours of faces", "a.off",
         "OFF\n8 12 0\n" + lines("", kCorners) + lines("3", kFaces, " 3 255 0 0")},
        {"CGAL/cgal#9034: the same as shares, with a comment", "a.off",
         "OFF\n8 12 0\n" + lines("", kCorners) + lines("3", kFaces, "  0.5 0.25 0 1 # red")},
        {"cnr-isti-vclab/meshlab#292: colours of vertices that the head does not say", "a.off",
         "OFF\n8 12 0\n" + lines("", kCorners, " 255 0 0 255") + lines("3", kFaces)},
        {"MeshInspector/MeshLib#2431, isl-org/Open3D#1035: faces of many corners", "a.off",
         "OFF\n10 7 0\n" +
             lines("", std::vector<Corner>{{0, 0, 0},
                                           {2, 0, 0},
                                           {2, 0, 1},
                                           {1, 0, 2},
                                           {0, 0, 1},
                                           {0, 3, 0},
                                           {2, 3, 0},
                                           {2, 3, 1},
                                           {1, 3, 2},
                                           {0, 3, 1}}) +
             "5 0 1 2 3 4\n5 9 8 7 6 5\n4 1 0 5 6\n4 2 1 6 7\n4 3 2 7 8\n4 4 3 8 9\n4 0 4 9 5\n",
         Solid{16, 9}},
        {"mikedh/trimesh#753, PyMesh/PyMesh#162, facebookresearch/pytorch3d#663: counts glued to the keyword",
         "a.off", "OFF8 12 0\n" + kOffBody},
        {"no keyword", "a.off", "8 12 0\n" + kOffBody},
        {"a byte order mark", "a.off", kMark + kOff},
        {"assimp/assimp#2228, alextsui05/blender-off-addon#10: numbers wrapped at will", "a.off",
         replaced(kOff, " ", "\n")},
        {"nschloe/meshio#998: a comment between keyword and counts", "a.off",
         replaced(kOff, "OFF\n", "OFF\n# Created by meshio\n\n")},
        {"fougue/mayo#258, mikedh/trimesh#542: counts beside the keyword, comments and empty lines", "a.off",
         "OFF 8 12 0 # counts\n\n# corners\n" + kOffBody},
    };
}

std::vector<FileReport> gltf_reports() {
    const std::string two_views =
        R"({"bufferView":1,"componentType":5123,"count":18,"type":"SCALAR"},)"
        R"({"bufferView":1,"byteOffset":36,"componentType":5123,"count":18,"type":"SCALAR"})";
    const std::string two =
        R"({"attributes":{"POSITION":0},"indices":1},{"attributes":{"POSITION":0},"indices":2})";
    std::string quantised = R"(,"extensionsRequired":["KHR_mesh_quantization"])";
    // A tetrahedron of the corners 0, 1, 2 and 4.
    const std::vector<int> strip{0, 2, 1, 4, 0, 2};
    return {
        {"Moguri/panda3d-gltf#33: indices that begin within a view", "a.glb",
         Glb{.index_accessors = two_views, .primitives = two}.bytes()},
        {"assimp/assimp#2077, atteneder/glTFast#707: triangle strips", "a.glb", strips(5, {strip}),
         Solid{4, 1.0 / 6}},
        {"assimp/assimp#2077: triangle fans", "a.glb", strips(6, {{4, 0, 1, 2, 0}, {0, 2, 1}}),
         Solid{4, 1.0 / 6}},
        {"Genesis-Embodied-AI/genesis-world#3335: strips of two nodes", "a.glb",
         strips(5, {strip}, R"({"mesh":0}|{"mesh":0,"translation":[5,0,0]})"), Solid{8, 1.0 / 3}},
        {"bevyengine/bevy#8859, google/filament#1520, warrenm/GLTFKit2#26: a mirrored node", "a.glb",
         Glb{.nodes = R"({"mesh":0,"scale":[-1,2,1]})"}.bytes(), Solid{12, 2}},
        {"facebookincubator/FBX2glTF#31: a matrix that mirrors, in a node that mirrors", "a.glb",
         Glb{.nodes =
                 R"({"children":[1],"scale":[1,1,-1]},{"mesh":0,"matrix":[-2,0,0,0,0,1,0,0,0,0,3,0,9,0,0,1]})"}
             .bytes(),
         Solid{12, 6}},
        {"jkuhlmann/cgltf#38: the bytes end before the buffer does", "a.glb",
         Glb{.missing_bytes = 40}.bytes(), Refused{"a.glb"}},
        {"godotengine/godot#109666: indices that are no multiple of three", "a.glb",
         Glb{.index_accessors = R"({"bufferView":1,"componentType":5123,"count":35,"type":"SCALAR"})"}
             .bytes(),
         Refused{"a.glb"}},
        {"assimp/assimp#6746, #6856: a strip of one index", "a.glb", strips(5, {{0}}), Refused{"a.glb"}},
        {"assimp/assimp#6746, #6856: a strip of two indices", "a.glb", strips(5, {{0, 1}}), Refused{"a.glb"}},
        {"assimp/assimp#6746, #6856: a fan of one index", "a.glb", strips(6, {{0}}), Refused{"a.glb"}},
        {"assimp/assimp#6746, #6856: a fan of two indices", "a.glb", strips(6, {{0, 1}}), Refused{"a.glb"}},
        {"assimp/assimp#6634: a line loop of one index", "a.glb", strips(2, {{0}}), Refused{"a.glb"}},
        {"a node that is its own child", "a.glb", Glb{.nodes = R"({"mesh":0,"children":[0]})"}.bytes(),
         Refused{"a.glb"}},
        {"KhronosGroup/glTF-Blender-IO#1865: every face twice, once turned over", "a.glb",
         Glb{.indices = index_bytes<std::uint16_t>(kFaces) +
                        [] {
                            std::vector<std::vector<int>> turned = kFaces;
                            for (auto& face : turned) std::swap(face[1], face[2]);
                            return index_bytes<std::uint16_t>(turned);
                        }(),
             .index_accessors = R"({"bufferView":1,"componentType":5123,"count":72,"type":"SCALAR"})"}
             .bytes(),
         Solid{24, 0}},
        {"assimp/assimp#6765, mrdoob/three.js#12551: positions that are quantised", "a.glb",
         Glb{.more = quantised}.bytes()},
    };
}

/// Files of two tetrahedra that share a face, of a volume of 1/2; a .node file has its .ele file behind a
/// '|'.
std::vector<FileReport> tetrahedra_reports() {
    const std::string head_4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n";
    const std::string head_vtk = "# vtk DataFile Version 5.1\nvtk output\nASCII\nDATASET UNSTRUCTURED_GRID\n";
    const std::string cells_5 = "CELLS 3 8\nOFFSETS vtktypeint64\n0 4 8\nCONNECTIVITY vtktypeint64\n"
                                "0 1 2 3\n1 2 3 4\nCELL_TYPES 2\n10\n10\n";
    const std::string nodes = "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 1 1\n";
    return {
        {"nschloe/meshio#388: MSH 4.1 whose nodes are not in the order of their numbers", "a.msh",
         head_4 + "$Nodes\n1 5 1 9\n3 1 0 5\n1\n9\n4\n2\n7\n" + points +
             "$EndNodes\n$Elements\n1 2 1 2\n3 1 4 2\n1 1 9 4 2\n2 9 4 2 7\n$EndElements\n"},
        {"nschloe/meshio#956, #644: names, entities and elements of other kinds", "a.msh",
         head_4 + "$PhysicalNames\n1\n3 1 \"o\"\n$EndPhysicalNames\n$Entities\n1 0 0 1\n1 0 0 0 1 1 \n" +
             "1 0 0 0 1 1 1 0 0\n$EndEntities\n$Nodes\n1 5 1 5\n3 1 0 5\n1\n2\n3\n4\n5\n" + points +
             "$EndNodes\n$Elements\n2 3 1 3\n0 1 15 1\n1 1 \n3 1 4 2\n2 1 2 3 4 \n3 2 3 4 5 "
             "\n$EndElements\n"},
        {"neperfepx/neper#781: entities of several lines", "a.msh",
         head_4 +
             "$Entities\n1 0 0 0\n1 0.1 0.0 0.0\n 0 \n$EndEntities\n$Nodes\n1 5 1 5\n3 1 0 "
             "5\n1\n2\n3\n4\n5\n" +
             points + "$EndNodes\n$Elements\n1 2 1 2\n3 1 4 2\n1 1 2 3 4\n2 2 3 4 5\n$EndElements\n"},
        {"mfem/mfem#1061, nschloe/meshio#907: MSH 2.2 with tags of 0, and without tags", "a.msh",
         "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 "
         "1\n$EndNodes\n"
         "$Elements\n3\n1 2 2 0 0 1 2 3\n2 4 2 0 0 1 2 3 4\n3 4 0 2 3 4 5\n$EndElements\n"},
        {"nschloe/meshio#877, #885, visit-dav/visit#5389: VTK 5.1 with offsets", "a.vtk",
         head_vtk + "POINTS 5 float\n" + points + cells_5},
        {"elrnv/vtkio#21: its metadata, fields and \\r\\n", "a.vtk",
         replaced(
             head_vtk + "FIELD FieldData 1\nTIME 1 1 double\n0\nPOINTS 5 double\n" + points +
                 "\nMETADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1.73\n\n" +
                 cells_5 + "\nPOINT_DATA 5\nFIELD FieldData 1\nindex 1 5 vtktypeint64\n0 1 2 3 4\n",
             "\n", "\r\n")},
        {"nschloe/meshio#1318, #900: attributes that are not whole, markers and comments", "a.node",
         "# of a trial\n" + replaced(nodes, "5 3 0 0", "5 3 0 0 # counts") +
             "# end\n|2 4 1\n0 0 1 2 3 0.5\n1 1 2 3 4 -1.25e-3\n# end\n"},
        {"libMesh/libmesh#1412: attributes and markers of nodes, from 1", "a.node",
         "5 3 2 1\n1 0 0 0 0.5 1 -1\n2 1 0 0 0 0 1\n3 0 1 0 1 1 1\n4 0 0 1 2 2 0\n5 1 1 1 3 3 0\n|2 4 0\n1 1 "
         "2 3 4\n2 2 3 4 5\n"},
    };
}

class FileReports : public TemporaryFolderTest {
  protected:
    void expect_right(const std::vector<FileReport>& reports) {
        for (const FileReport& report : reports) {
            SCOPED_TRACE(report.thread);
            const std::filesystem::path file = write(report.name, report.content);
            if (const auto* refused = std::get_if<Refused>(&report.right)) {
                EXPECT_THROW(expect_words(refused->words, file), Error);
                continue;
            }
            try {
                expect_read(report, inspect(read_mesh(file)));
            } catch (const Error& error) {
                ADD_FAILURE() << error.what();
            }
        }
    }

  private:
    static void expect_words(const std::string& words, const std::filesystem::path& file) {
        try {
            read_mesh(file);
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
            throw;
        }
    }
    static void expect_read(const FileReport& report, const MeshReport& found) {
        if (const auto* open = std::get_if<Open>(&report.right)) {
            EXPECT_EQ(found.face_count, open->face_count);
            return;
        }
        const auto& solid = std::get<Solid>(report.right);
        EXPECT_EQ(found.face_count, solid.face_count);
        EXPECT_TRUE(found.closed);
        EXPECT_NEAR(found.signed_volume, solid.volume, 1e-6);
    }
};

} // namespace

TEST_F(FileReports, OfObjAreAnswered) {
    expect_right(obj_reports());
}
TEST_F(FileReports, OfPlyAreAnswered) {
    expect_right(ply_reports());
}
TEST_F(FileReports, OfStlAreAnswered) {
    expect_right(stl_reports());
}
TEST_F(FileReports, OfOffAreAnswered) {
    expect_right(off_reports());
}
TEST_F(FileReports, OfGltfAreAnswered) {
    expect_right(gltf_reports());
}
TEST_F(FileReports, OfTetrahedraAreAnswered) {
    for (const FileReport& report : tetrahedra_reports()) {
        SCOPED_TRACE(report.thread);
        const std::size_t middle = report.content.find('|');
        if (middle != std::string::npos) write("a.ele", report.content.substr(middle + 1));
        const auto file = write(report.name, report.content.substr(0, middle));
        try {
            const TetrahedralMesh mesh = read_tetrahedra(file).mesh;
            EXPECT_EQ(mesh.tetrahedra.size(), 2u);
            EXPECT_NEAR(inspect_tetrahedra(mesh).volume, 0.5, 1e-6);
        } catch (const Error& error) {
            ADD_FAILURE() << error.what();
        }
    }
}
