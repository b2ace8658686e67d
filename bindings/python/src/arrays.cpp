#include "arrays.hpp"

#include "mesh/local_frame.hpp"

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace echinus::python {

namespace {

std::string text_of(const py::handle& object) {
    return py::str(object);
}

/// @param kinds  NumPy's letters for the accepted types of numbers
py::array array_of(const py::object& object, const char* name, std::string_view kinds, const char* wanted) {
    py::array array = py::array::ensure(object);
    if (!array)
        throw py::type_error(std::string(name) + " must be an array of " + wanted + ", not " +
                             text_of(py::type::of(object).attr("__name__")));
    if (kinds.find(array.dtype().kind()) == std::string_view::npos)
        throw py::type_error(std::string(name) + " must be an array of " + wanted + ", not of type " +
                             text_of(array.dtype()));
    return array;
}

std::string shape_text(const py::array& array) {
    return text_of(array.attr("shape"));
}

bool is_aligned(const py::array& array) {
    return py::detail::check_flags(array.ptr(), py::detail::npy_api::NPY_ARRAY_ALIGNED_);
}

template <typename T, typename Row>
py::array read_only(std::span<const Row> rows, const py::object& owner) {
    constexpr py::ssize_t kWidth = sizeof(Row) / sizeof(T);
    py::array_t<T> array({static_cast<py::ssize_t>(rows.size()), kWidth},
                         reinterpret_cast<const T*>(rows.data()), owner);
    array.attr("setflags")(false);
    return array;
}

bool is_index(std::int64_t value) {
    return value >= 0 && value <= std::numeric_limits<std::uint32_t>::max();
}

void require_rows_of(py::ssize_t width, const py::array& array, const char* name, const char* remedy) {
    if (array.ndim() != 2 || array.shape(1) != width)
        throw py::value_error(std::string(name) + " must have the shape (n, " + std::to_string(width) +
                              "), not " + shape_text(array) + remedy);
}

/// [n, width]
/// @param row  the name of a row
py::array_t<std::uint32_t> index_array(const py::object& indices, py::ssize_t width, const char* name,
                                       const char* row, const char* remedy) {
    const py::array array = array_of(indices, name, "iu", "whole numbers");
    require_rows_of(width, array, name, remedy);
    if (py::array_t<std::uint32_t, py::array::c_style>::check_(array) && is_aligned(array)) return array;
    const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> numbers(array);
    py::array_t<std::uint32_t> result({numbers.shape(0), width});
    const std::int64_t* from = numbers.data();
    std::uint32_t* to = result.mutable_data();
    for (py::ssize_t i = 0; i < numbers.size(); ++i) {
        if (!is_index(from[i]))
            throw py::value_error(std::string(row) + " " + std::to_string(i / width) + " names the vertex " +
                                  py::str(array[py::make_tuple(i / width, i % width)]).cast<std::string>());
        to[i] = static_cast<std::uint32_t>(from[i]);
    }
    return result;
}

py::array in_file(const std::vector<Vec3f>& vertices, const Vec3d& origin) {
    py::array_t<double> array({static_cast<py::ssize_t>(vertices.size()), py::ssize_t{3}});
    auto* to = reinterpret_cast<Vec3d*>(array.mutable_data());
    for (const Vec3f& vertex : vertices) *to++ = Vec3d(vertex) + origin;
    return array;
}

template <typename Mesh, typename Cells>
py::tuple shared_arrays(Mesh mesh, Cells Mesh::*cells) {
    auto kept = std::make_unique<Mesh>(std::move(mesh));
    const Mesh& m = *kept;
    const py::capsule owner(kept.get(), [](void* p) { delete static_cast<Mesh*>(p); });
    kept.release();
    return py::make_tuple(m.origin == Vec3d{} ? view_of(m.vertices, owner) : in_file(m.vertices, m.origin),
                          view_of(m.*cells, owner));
}

std::span<const Vec3d> doubles_of(const py::array& vertices) {
    return {static_cast<const Vec3d*>(vertices.data()), static_cast<std::size_t>(vertices.shape(0))};
}

bool holds_doubles(const py::array& vertices) {
    return py::array_t<double>::check_(vertices);
}

template <typename Cell>
std::vector<Cell> cells_of(const py::array_t<std::uint32_t>& cells) {
    const auto* first = reinterpret_cast<const Cell*>(cells.data());
    return {first, first + cells.shape(0)};
}

// ---- Memory of large answers
//
// The system provides new memory page by page and clears each page first; for the contacts of a million
// points this takes a tenth of the time of the query. So the block that was released last is kept for the
// next call.

constexpr py::ssize_t kLarge = 1 << 20, kMostKept = 64 << 20; // bytes

/// The block that is kept, an array of bytes, or nothing. It is never destroyed, since Python may have ended
/// when C++ destroys its static objects.
py::object& waiting_block() {
    static auto* block = new py::object;
    return *block;
}

py::array block_of(py::ssize_t size) {
    py::object& waiting = waiting_block();
    if (waiting) {
        const auto block = py::reinterpret_borrow<py::array>(waiting);
        if (block.nbytes() >= size && block.nbytes() / 2 <= size) {
            waiting = py::object();
            return block;
        }
    }
    return py::array_t<std::uint8_t>(size); // from NumPy, which requests large pages
}

/// A new array whose memory is kept for another one after this array and its views have been destroyed.
py::array array_in_block(const py::dtype& type, const std::vector<py::ssize_t>& shape, py::ssize_t size) {
    py::array block = block_of(size);
    const void* data = block.data();
    const void* const kept = block.release().ptr();
    const py::capsule owner(kept, [](void* p) {
        waiting_block() = py::reinterpret_steal<py::object>(static_cast<PyObject*>(p));
    });
    return {type, shape, data, owner};
}

} // namespace

py::array number_array(const py::object& object, const char* name) {
    return array_of(object, name, "fiu", "real numbers");
}

Points::Points(const py::object& points, const char* name, const Vec3d& origin) {
    const py::array array = number_array(points, name);
    if (array.ndim() == 0 || array.shape(array.ndim() - 1) != 3)
        throw py::value_error(std::string(name) + " must have the shape (..., 3), not " + shape_text(array));
    shape_.assign(array.shape(), array.shape() + array.ndim() - 1);
    if (origin != Vec3d{} || !read_in_place(array)) convert(array, origin);
}

bool Points::read_in_place(const py::array& points) {
    const auto last = points.ndim() - 1;
    if (!py::array_t<float, 0>::check_(points) || !is_aligned(points) ||
        points.strides(last) != sizeof(float))
        return false;
    std::size_t size = 1;
    py::ssize_t stride = sizeof(Vec3f);
    for (auto axis = last - 1; axis >= 0; --axis) { // do the dimensions before the last form one row?
        if (axis == last - 1)
            stride = points.strides(axis);
        else if (points.strides(axis) != points.strides(axis + 1) * points.shape(axis + 1))
            return false;
        size *= static_cast<std::size_t>(points.shape(axis));
    }
    if (stride < 0) return false;
    owner_ = points;
    span_ = {static_cast<const Vec3f*>(points.data()), size, static_cast<std::size_t>(stride)};
    return true;
}

void Points::convert(const py::array& points, const Vec3d& origin) {
    // Converted from double by a loop of our own, because NumPy would warn about numbers beyond the range of
    // float, which become infinite and are outside.
    const py::array_t<double, py::array::c_style | py::array::forcecast> numbers(points);
    py::array_t<float> floats(numbers.size());
    const auto count = static_cast<std::size_t>(numbers.size()) / 3;
    const auto* from = reinterpret_cast<const Vec3d*>(numbers.data());
    auto* to = reinterpret_cast<Vec3f*>(floats.mutable_data());
    for (std::size_t i = 0; i < count; ++i) to[i] = to_local(from[i], origin);
    span_ = {to, count};
    owner_ = std::move(floats);
}

void Points::keep_apart_from(const py::array& answers) {
    if (size() == 0) return;
    const auto* first = reinterpret_cast<const std::byte*>(&span_[0]);
    const auto* end = reinterpret_cast<const std::byte*>(&span_[size() - 1] + 1);
    const auto* first_answer = static_cast<const std::byte*>(answers.data());
    const std::less<> before; // also compares addresses in different arrays
    if (before(first, first_answer + answers.nbytes()) && before(first_answer, end))
        convert(py::array(owner_), {}); // read in place, so without an origin
}

py::array new_array(const py::dtype& type, const std::vector<py::ssize_t>& shape) {
    py::ssize_t size = type.itemsize();
    for (const py::ssize_t length : shape) size *= length;
    return size < kLarge || size > kMostKept ? py::array(type, shape) : array_in_block(type, shape, size);
}

py::array answers(const py::dtype& type, const std::vector<py::ssize_t>& shape, const py::object& out,
                  Points& read) {
    if (out.is_none()) return new_array(type, shape);
    const auto fits = [&](const py::array& array) {
        return array.dtype().equal(type) && array.writeable() && (array.flags() & py::array::c_style) &&
               is_aligned(array) &&
               std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()) == shape;
    };
    if (!py::isinstance<py::array>(out) || !fits(py::array(out)))
        throw py::value_error("out must be a writeable, contiguous array of type " + text_of(type) +
                              " with one element for each point");
    read.keep_apart_from(py::array(out));
    return out;
}

py::array view_of(std::span<const Vec3f> points, const py::object& owner) {
    return read_only<float>(points, owner);
}
py::array view_of(std::span<const Triangle> faces, const py::object& owner) {
    return read_only<std::uint32_t>(faces, owner);
}
py::array view_of(std::span<const Tetrahedron> tetrahedra, const py::object& owner) {
    return read_only<std::uint32_t>(tetrahedra, owner);
}
py::array view_of(std::span<const ElasticTetrahedron> tetrahedra, const py::object& owner) {
    const auto* first = reinterpret_cast<const std::byte*>(tetrahedra.data());
    py::array_t<std::uint32_t> array(
        {static_cast<py::ssize_t>(tetrahedra.size()), py::ssize_t{4}},
        {static_cast<py::ssize_t>(sizeof(ElasticTetrahedron)), py::ssize_t{sizeof(std::uint32_t)}},
        reinterpret_cast<const std::uint32_t*>(first + offsetof(ElasticTetrahedron, particles)), owner);
    array.attr("setflags")(false);
    return array;
}
py::array view_of(std::span<const float> numbers, const py::object& owner) {
    py::array_t<float> array(static_cast<py::ssize_t>(numbers.size()), numbers.data(), owner);
    array.attr("setflags")(false);
    return array;
}

py::array vertex_array(const py::object& vertices, const py::array_t<std::uint32_t>& cells) {
    const py::array array = number_array(vertices, "vertices");
    require_rows_of(3, array, "vertices", "");
    const bool holds_floats = array.dtype().kind() == 'f' && array.itemsize() <= py::ssize_t{sizeof(float)};
    if (holds_floats) return float_array(array, "vertices");
    const py::array_t<double, py::array::c_style | py::array::forcecast> numbers(array);
    const std::span<const std::uint32_t> used(cells.data(), static_cast<std::size_t>(cells.size()));
    if (to_local_frame(doubles_of(numbers), used).origin == Vec3d{}) return float_array(array, "vertices");
    return numbers.attr("copy")();
}

py::array_t<float> float_array(const py::object& points, const char* name) {
    const py::array array = number_array(points, name);
    require_rows_of(3, array, name, "");
    if (py::array_t<float, py::array::c_style>::check_(array) && is_aligned(array)) return array;
    const Points read(array, name);
    py::array_t<float> floats({static_cast<py::ssize_t>(read.size()), py::ssize_t{3}});
    auto* to = reinterpret_cast<Vec3f*>(floats.mutable_data());
    for (std::size_t i = 0; i < read.size(); ++i) to[i] = read.span()[i];
    return floats;
}

py::array_t<std::uint32_t> face_array(const py::object& faces) {
    return index_array(faces, 3, "faces", "face", "; cut polygons into triangles first");
}
py::array_t<std::uint32_t> tetrahedron_array(const py::object& tetrahedra) {
    return index_array(tetrahedra, 4, "tetrahedra", "tetrahedron", "");
}

std::vector<std::uint32_t> whole_numbers(const py::object& numbers, const char* name) {
    const py::array array = py::array::ensure(numbers);
    if (array && array.size() == 0) return {}; // an empty list has the type float64
    const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> values(
        array_of(numbers, name, "iu", "whole numbers"));
    std::vector<std::uint32_t> result;
    for (py::ssize_t i = 0; i < values.size(); ++i) {
        const std::int64_t value = values.data()[i];
        if (!is_index(value))
            throw py::value_error(std::string(name) + " has the number " + std::to_string(value) +
                                  ", which is not an index");
        result.push_back(static_cast<std::uint32_t>(value));
    }
    return result;
}

std::vector<Vec3f> points_of(const py::array_t<float>& vertices) {
    const auto* first = reinterpret_cast<const Vec3f*>(vertices.data());
    return {first, first + vertices.shape(0)};
}

TriangleMesh mesh_of(const py::array& vertices, const py::array_t<std::uint32_t>& faces) {
    std::vector<Triangle> triangles = cells_of<Triangle>(faces);
    if (holds_doubles(vertices)) return local_mesh(doubles_of(vertices), std::move(triangles));
    return {points_of(vertices), std::move(triangles)};
}

TetrahedralMesh body_of(const py::array& vertices, const py::array_t<std::uint32_t>& tetrahedra) {
    std::vector<Tetrahedron> cells = cells_of<Tetrahedron>(tetrahedra);
    if (holds_doubles(vertices)) return local_body(doubles_of(vertices), std::move(cells));
    return {points_of(vertices), std::move(cells)};
}

py::tuple arrays_of(TriangleMesh mesh) {
    return shared_arrays(std::move(mesh), &TriangleMesh::faces);
}
py::tuple arrays_of(TetrahedralMesh mesh) {
    return shared_arrays(std::move(mesh), &TetrahedralMesh::tetrahedra);
}

unsigned thread_count(int threads) {
    if (threads < 0)
        throw py::value_error("threads is " + std::to_string(threads) + "; it must be 0 (all cores) or more");
    return static_cast<unsigned>(threads);
}

} // namespace echinus::python
