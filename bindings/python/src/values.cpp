#include "values.hpp"

#include <cmath>
#include <string>

namespace echinus::python {

Vec3d finite_vector_of(const Vector& v, const char* name) {
    if (!is_finite(vector_of(v))) throw py::value_error(std::string(name) + " must be finite");
    return vector_of(v);
}

std::tuple<double, double, double> to_python(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

std::tuple<double, double, double, double> to_python(const Rotation& rotation) {
    return {rotation.w, rotation.x, rotation.y, rotation.z};
}

std::size_t index_below(std::size_t count, std::int64_t index, const char* what) {
    if (index < 0 || static_cast<std::size_t>(index) >= count)
        throw py::index_error("there is no " + std::string(what) + " " + std::to_string(index) +
                              "; there are " + std::to_string(count));
    return static_cast<std::size_t>(index);
}

} // namespace echinus::python
