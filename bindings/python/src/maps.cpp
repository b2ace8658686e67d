#include "geometry/parallel.hpp"
#include "interface.hpp"
#include "values.hpp"

#include <echinus/map_file.hpp>
#include <echinus_scene/scene.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <vector>

namespace echinus::python {

namespace {

struct Field {
    const char* name;
    const char* format; ///< as in NumPy
    std::size_t offset;
};

/// A structured type of NumPy that is laid out like the C++ struct, so that answers need no copy.
py::dtype struct_type(std::size_t size, const std::vector<Field>& fields) {
    py::list names, formats, offsets;
    for (const Field& field : fields) {
        names.append(field.name);
        formats.append(py::dtype(field.format));
        offsets.append(field.offset);
    }
    return {names, formats, offsets, static_cast<py::ssize_t>(size)};
}

// Never destroyed, since Python may have ended when C++ destroys its static objects.

const py::dtype& contact_type() {
    static const auto* type =
        new py::dtype(struct_type(sizeof(Contact), {
                                                       {"point", "3f4", offsetof(Contact, point)},
                                                       {"normal", "3f4", offsetof(Contact, normal)},
                                                       {"depth", "f4", offsetof(Contact, depth)},
                                                       {"face", "i4", offsetof(Contact, face)},
                                                       {"inside", "?", offsetof(Contact, inside)},
                                                       {"certain", "?", offsetof(Contact, certain)},
                                                       {"feature", "u1", offsetof(Contact, feature)},
                                                   }));
    return *type;
}

const py::dtype& hit_type() {
    static const auto* type =
        new py::dtype(struct_type(sizeof(SweepHit), {
                                                        {"fraction", "f4", offsetof(SweepHit, fraction)},
                                                        {"point", "3f4", offsetof(SweepHit, point)},
                                                        {"normal", "3f4", offsetof(SweepHit, normal)},
                                                        {"face", "i4", offsetof(SweepHit, face)},
                                                        {"entering", "?", offsetof(SweepHit, entering)},
                                                    }));
    return *type;
}

template <typename T>
std::span<T> elements_of(py::array& array) {
    return {static_cast<T*>(array.mutable_data()), static_cast<std::size_t>(array.size())};
}

template <typename Map>
py::array contains_points(const Map& map, const py::object& points, const py::object& out, int threads) {
    const unsigned workers = thread_count(threads);
    Points taken(points, "points", map.view().origin);
    py::array inside = answers(py::dtype::of<bool>(), taken.shape(), out, taken);
    const std::span<std::uint8_t> flags = elements_of<std::uint8_t>(inside);
    in_pieces(taken.size(), [&](std::size_t first, std::size_t count) {
        contains_batch(map.view(), taken.span().subspan(first, count), flags.subspan(first, count), workers);
    });
    return inside;
}

template <typename Map>
py::array contacts_of_points(const Map& map, const py::object& points, float margin, const py::object& out,
                             int threads) {
    const unsigned workers = thread_count(threads);
    if (!(margin >= 0)) throw py::value_error("margin must be 0 or more, not " + std::to_string(margin));
    Points taken(points, "points", map.view().origin);
    py::array result = answers(contact_type(), taken.shape(), out, taken);
    const std::span<Contact> contacts = elements_of<Contact>(result);
    in_pieces(taken.size(), [&](std::size_t first, std::size_t count) {
        contacts_batch(map.view(), taken.span().subspan(first, count), margin, contacts.subspan(first, count),
                       workers);
    });
    return result;
}

/// The distances, or (distances, gradients).
py::object signed_distances(const ExactMap& map, const py::object& points, bool gradient,
                            const py::object& out, int threads) {
    const unsigned workers = thread_count(threads);
    Points taken(points, "points", map.view().origin);
    py::array distances = answers(py::dtype::of<float>(), taken.shape(), out, taken), gradients;
    const std::span<float> lengths = elements_of<float>(distances);
    std::span<Vec3f> directions;
    if (gradient) {
        std::vector<py::ssize_t> shape = taken.shape();
        shape.push_back(3);
        gradients = new_array(py::dtype::of<float>(), shape);
        directions = {static_cast<Vec3f*>(gradients.mutable_data()), taken.size()};
    }
    in_pieces(taken.size(), [&](std::size_t first, std::size_t count) {
        signed_distance_batch(map.view(), taken.span().subspan(first, count), lengths.subspan(first, count),
                              gradient ? directions.subspan(first, count) : directions, workers);
    });
    if (gradient) return py::make_tuple(distances, gradients);
    return distances;
}

py::array winding_numbers(const ExactMap& map, const py::object& points, float tolerance,
                          const py::object& out, int threads) {
    const unsigned workers = thread_count(threads);
    if (!(tolerance >= 0))
        throw py::value_error("tolerance must be 0 or more, not " + std::to_string(tolerance));
    Points taken(points, "points", map.view().origin);
    py::array result = answers(py::dtype::of<float>(), taken.shape(), out, taken);
    const std::span<float> numbers = elements_of<float>(result);
    in_pieces(taken.size(), [&](std::size_t first, std::size_t count) {
        winding_number_batch(map.view(), taken.span().subspan(first, count), numbers.subspan(first, count),
                             tolerance, workers);
    });
    return result;
}

py::array sweep_points(const ExactMap& map, const py::object& start, const py::object& end, int threads) {
    const unsigned workers = thread_count(threads);
    const Vec3d& origin = map.view().origin;
    const Points from(start, "start", origin), to(end, "end", origin);
    if (from.shape() != to.shape()) throw py::value_error("start and end must have the same shape");
    py::array result = new_array(hit_type(), from.shape());
    const std::span<SweepHit> hits = elements_of<SweepHit>(result);
    in_pieces(from.size(), [&](std::size_t first, std::size_t count) {
        sweep_batch(map.view(), from.span().subspan(first, count), to.span().subspan(first, count),
                    hits.subspan(first, count), workers);
    });
    return result;
}

py::bytes bytes_of(const AnyMap& map) {
    std::vector<std::byte> bytes;
    {
        const py::gil_scoped_release unlocked;
        bytes = serialise(map);
    }
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The map reads a copy of the bytes, aligned as the reader requires.
AnyMap map_from_bytes(const py::bytes& bytes) {
    const std::string_view text = bytes;
    auto copy = std::make_shared<std::vector<std::uint64_t>>((text.size() + 7) / 8);
    text.copy(reinterpret_cast<char*>(copy->data()), text.size());
    const std::span<const std::byte> copied(reinterpret_cast<const std::byte*>(copy->data()), text.size());
    return load_map(copied, copy, "the bytes of a map");
}

py::dict describe(const ExactMapStatistics& s) {
    py::dict result;
    result["face_count"] = s.face_count;
    result["dropped_faces"] = s.dropped_faces;
    result["longest_list"] = s.longest_list;
    result["mean_list"] = s.mean_list;
    result["expected_tests"] = s.expected_tests;
    result["certain_share"] = s.certain_share;
    result["uncertain_directions"] = s.uncertain_directions;
    return result;
}

py::dict describe(const DistanceMapStatistics& s) {
    py::dict result;
    result["face_count"] = s.face_count;
    result["dropped_faces"] = s.dropped_faces;
    result["max_entries"] = s.max_entries;
    result["corrected_entries"] = s.corrected_entries;
    result["clamped_entries"] = s.clamped_entries;
    result["wrong_parity_share"] = s.wrong_parity_share;
    return result;
}

template <typename Map>
py::class_<Map> bind_map(py::module_& module, const char* name) {
    return py::class_<Map>(module, name)
        .def("contains", contains_points<Map>)
        .def("contacts", contacts_of_points<Map>)
        .def("save",
             [](const Map& map, const std::filesystem::path& path) {
                 const py::gil_scoped_release unlocked;
                 save(map, path);
             })
        .def("to_bytes", [](const Map& map) { return bytes_of(map); })
        .def_property_readonly("statistics", [](const Map& map) { return describe(map.statistics()); })
        .def_property_readonly("source_hash", &Map::source_hash)
        .def_property_readonly("byte_count", [](const Map& map) { return map.view().byte_count(); })
        .def_property_readonly("radius", [](const Map& map) { return map.view().radius; })
        .def_property_readonly("origin", [](const Map& map) { return to_python(map.view().origin); })
        .def_property_readonly(
            "centre", [](const Map& map) { return to_python(Vec3d(map.view().centre) + map.view().origin); });
}

} // namespace

void bind_maps(py::module_& module) {
    bind_map<DistanceMap>(module, "DistanceMap");
    bind_map<ExactMap>(module, "ExactMap")
        .def("signed_distance", signed_distances)
        .def("winding_number", winding_numbers)
        .def("sweep", sweep_points);
    module.def("build_map", [](const py::array& vertices, const py::array_t<std::uint32_t>& faces,
                               const std::string& options_json, int threads) {
        const unsigned workers = thread_count(threads);
        const MapOptions options = parse_map_options(options_json, "options");
        const TriangleMesh mesh = mesh_of(vertices, faces);
        const py::gil_scoped_release unlocked;
        return build_map(mesh, options, workers);
    });
    module.def("load_map", [](const std::filesystem::path& path) {
        const py::gil_scoped_release unlocked;
        return load_map(path);
    });
    module.def("map_from_bytes", map_from_bytes);
}

} // namespace echinus::python
