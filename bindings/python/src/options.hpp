#pragma once

#include "arrays.hpp"
#include "option_names.hpp"
#include "values.hpp"

#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

/// Converts the options of Python, which are values of a dictionary by their names, to those of C++ and back;
/// option_names.hpp relates names and members. Wrong types are TypeErrors and wrong values ValueErrors, whose
/// sentences name the option; ranges are checked by the library.
namespace echinus::python {

/// Sets members from a dictionary that contains all of them.
class FromPython {
  public:
    explicit FromPython(const py::dict& values) : values_(values) {}

    void operator()(const char* name, bool& member) const;
    void operator()(const char* name, double& member) const;
    void operator()(const char* name, std::optional<double>& member) const;
    void operator()(const char* name, std::uint32_t& member) const;
    void operator()(const char* name, std::size_t& member) const;
    void operator()(const char* name, Vec3d& member) const;
    void operator()(const char* name, std::array<double, 3>& member) const;
    void operator()(const char* name, std::vector<std::uint32_t>& member) const;
    void operator()(const char* name, std::vector<std::array<std::uint32_t, 2>>& member) const;
    void operator()(const char* name, std::vector<Attachment>& member) const;
    void operator()(const char* name, std::vector<Vec3f>& member) const;
    template <typename Enum>
    void operator()(const char* name, Enum& member, std::initializer_list<const char*> words) const {
        member = static_cast<Enum>(word(name, words));
    }
    /// Set from "position" and "rotation".
    void operator()(RigidTransform& member) const;

    /// The same, but None keeps the default.
    void unless_none(const char* name, auto& member, auto... more) const {
        if (!values_[name].is_none()) (*this)(name, member, more...);
    }
    template <typename Enum>
    void unless_none(const char* name, Enum& member, std::initializer_list<const char*> words) const {
        if (!values_[name].is_none()) (*this)(name, member, words);
    }

  private:
    std::size_t word(const char* name, std::initializer_list<const char*> words) const;

    const py::dict& values_;
};

template <typename Options>
Options options_of(const py::dict& values) {
    Options options;
    for_each_option(options, FromPython(values));
    return options;
}

/// Members as a dictionary, without lists and poses.
class ToPython {
  public:
    explicit ToPython(py::dict& values) : values_(values) {}

    void operator()(const char* name, const auto& member) const { values_[name] = member; }
    void operator()(const char* name, const Vec3d& member) const { values_[name] = to_python(member); }
    void operator()(const char* name, const std::array<double, 3>& member) const {
        values_[name] = py::tuple(py::cast(member));
    }
    template <typename T>
    void operator()(const char*, const std::vector<T>&) const {}
    template <typename Enum>
    void operator()(const char* name, Enum member, std::initializer_list<const char*> words) const {
        values_[name] = words.begin()[static_cast<std::size_t>(member)];
    }
    void operator()(const RigidTransform&) const {}
    void unless_none(const char* name, const auto& member, auto... more) const {
        (*this)(name, member, more...);
    }
    template <typename Enum>
    void unless_none(const char* name, Enum member, std::initializer_list<const char*> words) const {
        (*this)(name, member, words);
    }

  private:
    py::dict& values_;
};

template <typename Options>
py::dict describe_options(const Options& options) {
    py::dict values;
    for_each_option(options, ToPython(values));
    return values;
}

} // namespace echinus::python
