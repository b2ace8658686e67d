#pragma once

#include "mesh_io/line_scanner.hpp"
#include "mesh_io/mesh_source.hpp"

#include <echinus/mesh.hpp>
#include <echinus/mesh_io.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace echinus {

/// The contents of a file: vertices, and polygons with any number of corners; those with two corners are
/// edges.
struct PolygonMesh {
    std::vector<Vec3d> vertices;              ///< finite as floats, too
    std::vector<std::uint32_t> corners;       ///< vertex indices, in range, polygon after polygon
    std::vector<std::uint32_t> corner_counts; ///< [polygon_count]
};

/// Concave polygons with more corners are refused: the time for cutting them into triangles grows with a
/// power of that number.
inline constexpr std::uint32_t kMaxConcaveCorners = 4096;

/// Moves the vertices to a local origin if needed (mesh/local_frame.hpp), and cuts each polygon of k corners
/// into k - 2 triangles, in order; points and lines are left out. Strictly convex polygons become fans around
/// their first corner, from others ears are cut (Meisters, "Polygons have ears", 1975), as seen along their
/// normal. If a polygon intersects itself and has no ear left, the rest becomes a fan.
/// @throws Error InvalidMesh, in the name of `source`
TriangleMesh triangulate(const PolygonMesh& polygons, const MeshSource& source);

// One reader per kind of file.
//
// All of them throw Error WrongFormat, Damaged or InvalidMesh; vertices are finite, and indices are in range.

PolygonMesh read_obj(const MeshSource& source);
PolygonMesh read_off(const MeshSource& source);
PolygonMesh read_ply(const MeshSource& source);
PolygonMesh read_stl(const MeshSource& source);

/// glTF, GLB and 3DS. The buffers of a glTF file are searched in its folder.
PolygonMesh read_scene(const MeshSource& source);

/// Parts of require_beginning() below. The head of a binary STL file states its size.
void require_beginning_of_stl(const MeshSource& beginning);
void require_beginning_of_gltf(const MeshSource& beginning);
void require_beginning_of_glb(const MeshSource& beginning);
void require_beginning_of_3ds(const MeshSource& beginning);

/// read_mesh() for the bytes of a file; the extension of the source's name determines the format.
TriangleMesh read_mesh(const MeshSource& source);
MeshAndEdges read_mesh_and_edges(const MeshSource& source);

/// Refuses the first bytes of a stream if read_mesh() would refuse it independently of what follows, so that
/// an endless stream is not read up to a limit.
/// @pre beginning.bytes.size() >= 84, the head of a binary STL file
/// @throws Error WrongFormat or Damaged
void require_beginning(const MeshSource& beginning);

enum class NumberType { Int32, Int64, Float32, Float64 };

/// A file of lines of words and, between them, of numbers: as words separated by blanks and line breaks, or
/// as bytes.
class NumberSource {
  public:
    explicit NumberSource(const MeshSource& source) : source_(source) {}
    virtual ~NumberSource() = default;

    /// The words of the next line that has any; none at the end.
    virtual std::vector<std::string_view> next_line() = 0;
    /// @throws Error Damaged if there is none
    virtual std::int64_t integer(NumberType type, const char* what) = 0;
    /// @throws Error Damaged if there is none; InvalidMesh if it is not finite as a float
    virtual double coordinate(NumberType type) = 0;
    /// The next three numbers as a position.
    Vec3d position(NumberType type);
    /// Skips this many numbers, which may be infinite or NaN. @param size  of each in bytes, if they are
    /// stored as bytes
    /// @throws Error Damaged if there are fewer
    virtual void skip(std::size_t count, std::size_t size) = 0;
    /// Skips to the end of a line that begins with this word.
    /// @throws Error Damaged if there is none
    virtual void skip_to_line(const std::string& word) = 0;
    /// Adds the place in the file to the sentence.
    [[noreturn]] void fail(ErrorCode code, const std::string& what) const {
        source_.fail(code, place() + ": " + what);
    }

    /// A count, which may be up to 2^32 - 2.
    std::size_t count(NumberType type, const char* what);
    /// next_line(), if the format requires a line.
    std::vector<std::string_view> require_line(const std::string& what);

  protected:
    /// "line 5", or "byte 70".
    virtual std::string place() const = 0;

    const MeshSource& source_;
};

/// Numbers in words. Errors name the line.
class TextNumbers final : public NumberSource {
  public:
    TextNumbers(const MeshSource& source, LineScanner& scanner) : NumberSource(source), scanner_(scanner) {
        scanner_.read_across_lines();
    }

    std::vector<std::string_view> next_line() override;
    std::int64_t integer(NumberType type, const char* what) override;
    double coordinate(NumberType type) override;
    void skip(std::size_t count, std::size_t size) override;
    void skip_to_line(const std::string& word) override;

  private:
    std::string place() const override { return "line " + std::to_string(scanner_.line_number()); }

    LineScanner& scanner_;
};

/// Numbers in bytes. Errors name the byte.
class BinaryNumbers final : public NumberSource {
  public:
    BinaryNumbers(const MeshSource& source, std::size_t offset, ByteOrder order)
        : NumberSource(source), bytes_(source, offset, order) {}

    std::vector<std::string_view> next_line() override;
    std::int64_t integer(NumberType type, const char* what) override;
    double coordinate(NumberType type) override;
    void skip(std::size_t count, std::size_t size) override;
    void skip_to_line(const std::string& word) override;

  private:
    std::string place() const override { return "byte " + std::to_string(bytes_.offset()); }

    ByteReader bytes_;
};

// One reader per kind of file of tetrahedra.
//
// All of them throw Error WrongFormat, Damaged or InvalidMesh. Vertices are finite and indices in range;
// other faults of the tetrahedra are reported by finish_tetrahedra().

/// The contents of a file.
struct TetrahedraInFile {
    std::vector<Vec3d> vertices; ///< finite as floats, too
    std::vector<Tetrahedron> tetrahedra;
};

TetrahedraInFile read_msh(const MeshSource& source);
TetrahedraInFile read_vtk(const MeshSource& source);
/// Reads a pair of files.
TetrahedraInFile read_tetgen(const MeshSource& nodes, const MeshSource& elements);

/// Moves the vertices to a local origin if needed (mesh/local_frame.hpp), reverses negative tetrahedra, drops
/// unused vertices, and refuses the same faults as require_valid_tetrahedra(), in the name of `source`.
TetrahedraFile finish_tetrahedra(TetrahedraInFile read, const MeshSource& source);

/// read_tetrahedra() for the bytes of a .msh or .vtk file.
TetrahedraFile read_tetrahedra(const MeshSource& source);

} // namespace echinus
