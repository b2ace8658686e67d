#include "arrays.hpp"
#include "colliders.hpp"
#include "interface.hpp"
#include "options.hpp"
#include "values.hpp"

#include <echinus/particle_collision.hpp>
#include <echinus/surface_collision.hpp>

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace echinus::python {

namespace {

using Indices = std::vector<std::uint32_t>;

/// A collision that several threads may call: one at a time computes, without Python's lock.
template <typename Collision>
class Shared {
  public:
    explicit Shared(Collision collision) : collision_(std::move(collision)) {}

    /// Calls work(collision) while no other thread does.
    template <typename Work>
    auto alone(const Work& work) {
        const py::gil_scoped_release released; // first, as in SharedSimulation
        const std::lock_guard guard(mutex_);
        return work(collision_);
    }
    std::size_t collider_at(std::int64_t index) const {
        return index_below(collision_.colliders().size(), index, "collider");
    }

  private:
    std::mutex mutex_;
    Collision collision_;
};

std::vector<Collider> colliders_of(const std::vector<ColliderArguments>& arguments) {
    std::vector<Collider> colliders;
    for (const ColliderArguments& collider : arguments) colliders.push_back(collider_of(collider));
    return colliders;
}

/// Vectors [n, 3] that are changed in place; empty for None.
std::span<Vec3f> changed_in_place(const py::object& object, const char* name) {
    if (object.is_none()) return {};
    using Floats = py::array_t<float, py::array::c_style>;
    if (!py::isinstance<Floats>(object))
        throw py::type_error(std::string(name) +
                             " must be a contiguous array of float32, as it is corrected in place");
    auto array = py::reinterpret_borrow<Floats>(object);
    if (array.ndim() != 2 || array.shape(1) != 3 || !array.writeable())
        throw py::value_error(std::string(name) + " must have the shape (n, 3) and be writeable");
    return {reinterpret_cast<Vec3f*>(array.mutable_data()), static_cast<std::size_t>(array.shape(0))};
}

std::vector<Vec3f> copied_points(const py::object& object, const char* name) {
    const Points points(object, name);
    if (points.shape().size() != 1) throw py::value_error(std::string(name) + " must have the shape (n, 3)");
    std::vector<Vec3f> copy(points.size());
    for (std::size_t i = 0; i < copy.size(); ++i) copy[i] = points.span()[i];
    return copy;
}

/// [n] numbers; empty for None.
std::vector<float> copied_numbers(const py::object& object, const char* name) {
    if (object.is_none()) return {};
    const py::array_t<float> numbers(number_array(object, name));
    if (numbers.ndim() != 1) throw py::value_error(std::string(name) + " must have the shape (n,)");
    std::vector<float> copy;
    for (py::ssize_t i = 0; i < numbers.shape(0); ++i) copy.push_back(numbers.at(i));
    return copy;
}

py::array_t<std::uint32_t> to_array(const Indices& indices) {
    return py::array_t<std::uint32_t>(static_cast<py::ssize_t>(indices.size()), indices.data());
}

using Particles = Shared<ParticleCollision>;
using Surfaces = Shared<SurfaceCollision>;

std::unique_ptr<Particles> particles_of(const std::vector<ColliderArguments>& colliders, double thickness,
                                        const py::dict& options) {
    return std::make_unique<Particles>(
        ParticleCollision(colliders_of(colliders), thickness, options_of<ParticleCollisionOptions>(options)));
}

std::unique_ptr<Surfaces> surfaces_of(const py::array_t<float>& positions,
                                      const py::array_t<std::uint32_t>& faces,
                                      const std::vector<ColliderArguments>& colliders, double thickness,
                                      const py::dict& options) {
    TriangleMesh mesh = mesh_of(positions, faces);
    const auto chosen = options_of<SurfaceCollisionOptions>(options);
    return unlocked([&] {
        return std::make_unique<Surfaces>(SurfaceCollision(std::move(mesh.vertices), std::move(mesh.faces),
                                                           colliders_of(colliders), thickness, chosen));
    });
}

py::array_t<std::uint32_t> correct_particles(Particles& shared, const py::object& previous,
                                             const py::object& positions, const py::object& velocities,
                                             const py::object& inverse_masses, double seconds) {
    if (py::isinstance<py::array>(previous) && py::isinstance<py::array>(positions)) {
        const py::array before(previous), after(positions);
        if (after.size() > 0 && before.data() == after.data())
            throw py::value_error("previous_positions and positions must be different arrays: "
                                  "copy the positions before the step");
    }
    const std::vector<Vec3f> began = copied_points(previous, "previous_positions");
    const std::vector<float> masses = copied_numbers(inverse_masses, "inverse_masses");
    const SolverStep step{.previous_positions = began,
                          .positions = changed_in_place(positions, "positions"),
                          .velocities = changed_in_place(velocities, "velocities"),
                          .inverse_masses = masses};
    return to_array(shared.alone([&](ParticleCollision& collision) {
        const auto corrected = collision.correct(step, seconds);
        return Indices(corrected.begin(), corrected.end());
    }));
}

py::array_t<std::uint32_t> correct_surfaces(Surfaces& shared, const py::object& positions,
                                            const py::object& velocities, double seconds) {
    const std::span<Vec3f> moved = changed_in_place(positions, "positions"),
                           with = changed_in_place(velocities, "velocities");
    return to_array(shared.alone([&](SurfaceCollision& collision) {
        const auto corrected = collision.correct(moved, with, seconds);
        return Indices(corrected.begin(), corrected.end());
    }));
}

template <typename Collision>
void set_collider_pose(Shared<Collision>& shared, std::int64_t index, const Vector& position,
                       const Quaternion& rotation) {
    const std::size_t collider = shared.collider_at(index);
    shared.alone([&](Collision& c) { c.set_collider_pose(collider, pose_of(position, rotation)); });
}

} // namespace

void bind_collisions(py::module_& module) {
    py::class_<Particles>(module, "ParticleCollision")
        .def(py::init(&particles_of))
        .def("set_collider_pose", &set_collider_pose<ParticleCollision>)
        .def("place_collider",
             [](Particles& shared, std::int64_t index, const Vector& position, const Quaternion& rotation) {
                 const std::size_t collider = shared.collider_at(index);
                 shared.alone(
                     [&](ParticleCollision& c) { c.place_collider(collider, pose_of(position, rotation)); });
             })
        .def("set_collider_friction",
             [](Particles& shared, std::int64_t index, double friction) {
                 const std::size_t collider = shared.collider_at(index);
                 shared.alone([&](ParticleCollision& c) { c.set_collider_friction(collider, friction); });
             })
        .def("correct", &correct_particles)
        .def_property_readonly("lost_count", [](Particles& shared) {
            return shared.alone([](ParticleCollision& c) { return c.lost_count(); });
        });
    py::class_<Surfaces>(module, "SurfaceCollision")
        .def(py::init(&surfaces_of))
        .def("set_collider_pose", &set_collider_pose<SurfaceCollision>)
        .def("correct", &correct_surfaces)
        .def_property_readonly("unresolved_count", [](Surfaces& shared) {
            return shared.alone([](SurfaceCollision& c) { return c.unresolved_count(); });
        });
}

} // namespace echinus::python
