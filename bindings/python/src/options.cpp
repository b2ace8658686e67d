#include "options.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace echinus::python {

namespace {

std::string sentence(const char* name, const std::string& wanted, const py::handle& given) {
    return std::string(name) + " must be " + wanted + ", not " + std::string(py::repr(given));
}

/// Is it a list of numbers, possibly with too few elements?
bool has_numbers(const py::handle& given) {
    if (!py::isinstance<py::tuple>(given) && !py::isinstance<py::list>(given)) return false;
    const auto entries = py::reinterpret_borrow<py::sequence>(given);
    return std::all_of(entries.begin(), entries.end(),
                       [](const py::handle& entry) { return PyNumber_Check(entry.ptr()) != 0; });
}

/// A number or several numbers.
template <typename T>
T numbers(const char* name, const std::string& wanted, const py::handle& given) {
    try {
        return given.cast<T>();
    } catch (const py::cast_error&) {
        if (!std::is_same_v<T, double> && has_numbers(given))
            throw py::value_error(sentence(name, wanted, given));
        throw py::type_error(sentence(name, wanted, given));
    }
}

/// Neither strings nor numbers with a decimal point are accepted as whole numbers.
template <typename T>
T whole(const char* name, const py::handle& given) {
    // No more than the largest difference of two sizes in C++.
    constexpr std::uint64_t kMost = std::min<std::uint64_t>(std::numeric_limits<T>::max(), INT64_MAX);
    const std::string wanted = "a whole number from 0 to " + std::to_string(kMost);
    if (PyIndex_Check(given.ptr()) == 0) throw py::type_error(sentence(name, wanted, given));
    const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
    const std::uint64_t value = index ? PyLong_AsUnsignedLongLong(index.ptr()) : 0;
    if (PyErr_Occurred() != nullptr)
        PyErr_Clear(); // negative, or too large
    else if (index && value <= kMost)
        return static_cast<T>(value);
    throw py::value_error(sentence(name, wanted, given));
}

/// Pairs of numbers, [n, 2].
std::vector<std::array<std::uint32_t, 2>> pairs_of(const py::object& numbers, const char* name) {
    const std::vector<std::uint32_t> row = whole_numbers(numbers, name);
    const py::array array = py::array::ensure(numbers);
    if (!row.empty() && (array.ndim() != 2 || array.shape(1) != 2))
        throw py::value_error(std::string(name) + " must have the shape (n, 2)");
    std::vector<std::array<std::uint32_t, 2>> pairs(row.size() / 2);
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {row[2 * i], row[2 * i + 1]};
    return pairs;
}

} // namespace

void FromPython::operator()(const char* name, bool& member) const {
    const py::object given = values_[name];
    const bool is_flag =
        py::isinstance<py::bool_>(given) || py::isinstance(given, py::module_::import("numpy").attr("bool_"));
    if (!is_flag) throw py::type_error(sentence(name, "True or False", given));
    member = given.cast<bool>();
}
void FromPython::operator()(const char* name, double& member) const {
    member = numbers<double>(name, "a number", values_[name]);
}
void FromPython::operator()(const char* name, std::optional<double>& member) const {
    if (!values_[name].is_none()) member = numbers<double>(name, "a number or None", values_[name]);
}
void FromPython::operator()(const char* name, std::uint32_t& member) const {
    member = whole<std::uint32_t>(name, values_[name]);
}
void FromPython::operator()(const char* name, std::size_t& member) const {
    member = whole<std::size_t>(name, values_[name]);
}
void FromPython::operator()(const char* name, Vec3d& member) const {
    member = vector_of(numbers<Vector>(name, "three numbers", values_[name]));
}
void FromPython::operator()(const char* name, std::array<double, 3>& member) const {
    member = numbers<Vector>(name, "three numbers", values_[name]);
}
void FromPython::operator()(const char* name, std::vector<std::uint32_t>& member) const {
    member = whole_numbers(values_[name], name);
}
void FromPython::operator()(const char* name, std::vector<std::array<std::uint32_t, 2>>& member) const {
    member = pairs_of(values_[name], name);
}
void FromPython::operator()(const char* name, std::vector<Attachment>& member) const {
    for (const auto& [vertex, collider] : pairs_of(values_[name], name)) member.push_back({vertex, collider});
}
void FromPython::operator()(const char* name, std::vector<Vec3f>& member) const {
    member = points_of(float_array(values_[name], name));
}
void FromPython::operator()(RigidTransform& member) const {
    member = pose_of(
        numbers<Vector>("position", "three numbers", values_["position"]),
        numbers<Quaternion>("rotation", "the four numbers w, x, y, z of a quaternion", values_["rotation"]));
}

std::size_t FromPython::word(const char* name, std::initializer_list<const char*> words) const {
    const py::object given = values_[name];
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string word = words.begin()[i];
        if (py::isinstance<py::str>(given) && given.cast<std::string>() == word) return i;
        if (i > 0) list += i + 1 < words.size() ? ", " : " or ";
        list += '"' + word + '"';
    }
    if (py::isinstance<py::str>(given)) throw py::value_error(sentence(name, list, given));
    throw py::type_error(sentence(name, list, given));
}

} // namespace echinus::python
