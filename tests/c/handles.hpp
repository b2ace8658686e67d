#pragma once

#include <echinus/echinus.h>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <string>

/// Handles of the C interface that destroy themselves, and what its tests expect of a status.
namespace echinus::test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <typename T, void (*destroy)(T*)>
struct Destroyer {
    void operator()(T* handle) const { destroy(handle); }
};
template <typename T, void (*destroy)(T*)>
using Handle = std::unique_ptr<T, Destroyer<T, destroy>>;

using CArray = Handle<echinus_array, echinus_array_destroy>;
using CMesh = Handle<echinus_mesh, echinus_mesh_destroy>;
using CMap = Handle<echinus_map, echinus_map_destroy>;
using CBuilder = Handle<echinus_map_builder, echinus_map_builder_destroy>;
using CTetrahedra = Handle<echinus_tetrahedra, echinus_tetrahedra_destroy>;
using CEmbedding = Handle<echinus_embedding, echinus_embedding_destroy>;
using CVertexCache = Handle<echinus_vertex_cache, echinus_vertex_cache_destroy>;
using CDeformable = Handle<echinus_deformable, echinus_deformable_destroy>;
using CSimulation = Handle<echinus_simulation, echinus_simulation_destroy>;
using CParticleCollision = Handle<echinus_particle_collision, echinus_particle_collision_destroy>;
using CSurfaceCollision = Handle<echinus_surface_collision, echinus_surface_collision_destroy>;
using CScene = Handle<echinus_scene, echinus_scene_destroy>;

/// The place for a result of a call; the handle owns it after the full expression.
template <typename H>
class Out {
  public:
    explicit Out(H& handle) : handle_(handle) {}
    Out(const Out&) = delete;
    Out& operator=(const Out&) = delete;
    ~Out() { handle_.reset(made_); }
    operator typename H::pointer *() { return &made_; }

  private:
    H& handle_;
    typename H::pointer made_ = nullptr;
};
template <typename H>
Out<H> out(H& handle) {
    return Out<H>(handle);
}

inline void expect_ok(echinus_status status) {
    EXPECT_EQ(status, ECHINUS_OK) << echinus_status_name(status) << ": " << echinus_last_error();
}

/// The call must have failed with this status and a sentence that contains these words.
inline void expect_refused(echinus_status status, echinus_status expected, const std::string& words) {
    EXPECT_EQ(status, expected) << echinus_status_name(status);
    EXPECT_NE(std::string(echinus_last_error()).find(words), std::string::npos)
        << "expected \"" << words << "\" in: " << echinus_last_error();
}

inline CMesh c_mesh_of(const TriangleMesh& mesh) {
    CMesh result;
    expect_ok(echinus_mesh_create(&mesh.vertices.data()->x, mesh.vertices.size(), 0,
                                  mesh.faces.data()->data(), mesh.faces.size(), out(result)));
    return result;
}
inline CMesh c_torus() {
    CMesh mesh;
    expect_ok(echinus_mesh_torus(1.0, 0.4, 60, 24, out(mesh)));
    return mesh;
}
inline CMap c_map(const CMesh& mesh) {
    CMap map;
    expect_ok(echinus_map_build_exact(mesh.get(), nullptr, out(map)));
    return map;
}
inline CMap c_distance_map(const CMesh& mesh) {
    CMap map;
    expect_ok(echinus_map_build_distance(mesh.get(), nullptr, out(map)));
    return map;
}

template <typename T>
std::span<const T> values_of(const CArray& array) {
    return {static_cast<const T*>(echinus_array_data(array.get())), echinus_array_count(array.get())};
}

template <typename A, typename B>
bool same_bits(std::span<const A> a, std::span<const B> b) {
    static_assert(std::is_trivially_copyable_v<A> && std::is_trivially_copyable_v<B>);
    return a.size_bytes() == b.size_bytes() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

/// A vector in the layout of C.
template <typename T>
struct Numbers {
    explicit Numbers(const Vec3<T>& v) : values{v.x, v.y, v.z} {}
    operator const T*() const { return values; }
    T values[3];
};

} // namespace echinus::test
