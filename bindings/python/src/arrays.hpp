#pragma once

#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>
#include <echinus/tetrahedra.hpp>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Converts NumPy's arrays to the types of the library and back. Wrong shapes are ValueErrors and wrong types
/// TypeErrors, whose sentences name the argument.
namespace echinus::python {

namespace py = pybind11;

/// The object as an array of real numbers of any type.
py::array number_array(const py::object& object, const char* name);

/// Points [..., 3], read in place if they are float32 and aligned, and the three coordinates of each point
/// are contiguous, with any distance between the points. Everything else is converted to float32 once. For a
/// map with an origin, points are always converted, after the origin is subtracted in double.
class Points {
  public:
    Points(const py::object& points, const char* name, const Vec3d& origin = {});

    StridedSpan<const Vec3f> span() const { return span_; }
    std::size_t size() const { return span_.size(); }
    /// The shape without the last dimension.
    const std::vector<py::ssize_t>& shape() const { return shape_; }
    /// Copies the points if they share memory with answers, which would otherwise overwrite them.
    void keep_apart_from(const py::array& answers);

  private:
    bool read_in_place(const py::array& points);
    void convert(const py::array& points, const Vec3d& origin);

    py::object owner_;
    std::vector<py::ssize_t> shape_;
    StridedSpan<const Vec3f> span_;
};

py::array new_array(const py::dtype& type, const std::vector<py::ssize_t>& shape);

/// A new array for one answer to each point, or `out` if that is not None and fits. As in NumPy, points that
/// `out` overlaps are read from a copy.
py::array answers(const py::dtype& type, const std::vector<py::ssize_t>& shape, const py::object& out,
                  Points& read);

/// A read-only array in memory that belongs to `owner`.
py::array view_of(std::span<const Vec3f> points, const py::object& owner);
py::array view_of(std::span<const Triangle> faces, const py::object& owner);
py::array view_of(std::span<const Tetrahedron> tetrahedra, const py::object& owner);
/// The particles of the tetrahedra, [n, 4].
py::array view_of(std::span<const ElasticTetrahedron> tetrahedra, const py::object& owner);
py::array view_of(std::span<const float> numbers, const py::object& owner);

/// [n, 3] float32, contiguous; the same array if it already is one. Numbers that float32 could not hold
/// (mesh/local_frame.hpp) are copied in float64.
/// @param cells  [m, 3] faces, or [m, 4] tetrahedra, which determine the vertices that matter
py::array vertex_array(const py::object& vertices, const py::array_t<std::uint32_t>& cells);
/// [n, 3] float32, contiguous; the same array if it already is one.
py::array_t<float> float_array(const py::object& points, const char* name);
/// [n, 3] uint32, contiguous; the same array if it already is one.
py::array_t<std::uint32_t> face_array(const py::object& faces);
/// [n, 4] uint32, contiguous; the same array if it already is one.
py::array_t<std::uint32_t> tetrahedron_array(const py::object& tetrahedra);

/// The elements of an array of any shape, which must be non-negative whole numbers, as one row.
std::vector<std::uint32_t> whole_numbers(const py::object& numbers, const char* name);

/// Conversions of arrays that the functions above returned.
std::vector<Vec3f> points_of(const py::array_t<float>& vertices);
TriangleMesh mesh_of(const py::array& vertices, const py::array_t<std::uint32_t>& faces);
TetrahedralMesh body_of(const py::array& vertices, const py::array_t<std::uint32_t>& tetrahedra);
/// (vertices, faces) or (vertices, tetrahedra), which share the mesh's memory. The vertices of a mesh with an
/// origin are a new array of float64, in the frame of its file.
py::tuple arrays_of(TriangleMesh mesh);
py::tuple arrays_of(TetrahedralMesh mesh);

/// Calls work() without Python's lock.
template <typename Work>
auto unlocked(const Work& work) {
    const py::gil_scoped_release released;
    return work();
}

/// The number of threads in the form of the library: 0 for all cores.
unsigned thread_count(int threads);

/// Calls body(first, count) for consecutive pieces of a batch, without Python's lock. Ctrl-C ends the batch
/// between two pieces. The pieces are large, since neighbours in a batch share work on contacts.
template <typename Body>
void in_pieces(std::size_t count, const Body& body) {
    constexpr std::size_t kPiece = 1U << 20U;
    for (std::size_t first = 0; first < count; first += kPiece) {
        if (first != 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
        const py::gil_scoped_release unlocked;
        body(first, std::min(kPiece, count - first));
    }
}

} // namespace echinus::python
