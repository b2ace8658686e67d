#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

/// Which side of the comparison a system is on.
enum class Role {
    Ours,
    Rival,
    Floor, ///< no answer at all, only what every answer costs at least
};

/// A structure around a mesh that questions are put to, in one way or several. The task's interface adds the
/// question.
class Structure {
  public:
    virtual ~Structure() = default;
    /// What must be known before build() and is no part of it.
    virtual void plan(const echinus::TriangleMesh& /*mesh*/) {}
    /// @param mesh  outlives the structure
    virtual void build(const echinus::TriangleMesh& mesh) = 0;
    /// All that queries read, where the library tells; what it took from the heap otherwise. After build().
    virtual std::size_t byte_count() const = 0;
};

/// An entry of a task's list of systems.
template <typename System>
struct Listed {
    std::string name;
    Role role;
    bool joins_large; ///< is it asked about meshes of 50 000 faces and more?
    std::function<std::unique_ptr<System>()> make;
};

/// The entry of a type that is made from these arguments.
template <typename Derived, typename System, typename... Arguments>
Listed<System> listed(std::string name, Role role, bool joins_large, Arguments... arguments) {
    return {std::move(name), role, joins_large, [=] { return std::make_unique<Derived>(arguments...); }};
}
