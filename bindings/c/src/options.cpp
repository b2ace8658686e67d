// Converts the options of C to those of C++ and back; options.hpp relates their members.

#include "options.hpp"

#include "handles.hpp"

#include <algorithm>
#include <optional>
#include <type_traits>

namespace echinus::c {

namespace {

/// Copies the members of C++ to those of C.
struct ToC {
    template <typename T, typename Value, typename... Unused>
    requires std::is_arithmetic_v<T>
    void operator()(const char*, T& c, const Value& o, Unused...) const { c = static_cast<T>(o); }

    template <typename CEnum, typename Enum>
    requires std::is_enum_v<CEnum>
    void operator()(const char*, CEnum& c, Enum o, Enum) const { c = static_cast<CEnum>(o); }

    void operator()(const char*, double& c, const std::optional<double>& o, Limits) const {
        c = o.value_or(ECHINUS_THICKNESS_CHOSEN);
    }
    template <std::size_t kCount>
    void operator()(const char*, double (&c)[kCount], const std::array<double, kCount>& o, Limits) const {
        std::copy(o.begin(), o.end(), c);
    }
    void operator()(const char*, double (&c)[3], const Vec3d& o, Limits) const { put_vector(o, c); }
    void operator()(const char*, echinus_pose& c, const RigidTransform& o) const { c = pose_to_c(o); }

    /// Lists are empty by default, and no function returns those of a caller.
    template <typename T, typename List>
    void operator()(const char*, const T*& first, std::size_t& count, const List&) const {
        first = nullptr;
        count = 0;
    }
    void reserved(auto& c) const { c = 0; }
};

/// Copies the members of C to those of C++. Ranges are checked by the library.
struct FromC {
    template <typename T, typename Value, typename... Unused>
    requires std::is_arithmetic_v<T>
    void operator()(const char* name, const T& c, Value& o, Unused...) const {
        if constexpr (std::is_same_v<Value, bool>)
            o = flag(c, ("options." + std::string(name)).c_str());
        else if constexpr (std::is_floating_point_v<T>)
            o = c;
        else // a number of threads always fits into an unsigned
            o = static_cast<Value>(std::min<std::uint64_t>(c, std::numeric_limits<Value>::max()));
    }
    template <typename CEnum, typename Enum>
    requires std::is_enum_v<CEnum>
    void operator()(const char* name, const CEnum& c, Enum& o, Enum last) const {
        o = enumerator(c, last, ("options." + std::string(name)).c_str());
    }
    void operator()(const char*, const double& c, std::optional<double>& o, Limits) const {
        o = c == ECHINUS_THICKNESS_CHOSEN ? std::nullopt : std::optional(c);
    }
    template <std::size_t kCount>
    void operator()(const char*, const double (&c)[kCount], std::array<double, kCount>& o, Limits) const {
        o = std::to_array(c);
    }
    void operator()(const char*, const double (&c)[3], Vec3d& o, Limits) const { o = vector_of(c); }
    void operator()(const char*, const echinus_pose& c, RigidTransform& o) const { o = pose_from(c); }

    template <typename T, typename List>
    void operator()(const char* name, const T* first, std::size_t count, List& o) const {
        read(first, count, o, "options." + std::string(name));
    }
    void reserved(const auto& c) const { require_unused(c); }

  private:
    static void read(const std::uint32_t* first, std::size_t count, std::vector<std::uint32_t>& o,
                     const std::string& name) {
        const std::span<const std::uint32_t> values = values_at(first, count, name.c_str());
        o.assign(values.begin(), values.end());
    }
    static void read(const std::uint32_t* first, std::size_t count,
                     std::vector<std::array<std::uint32_t, 2>>& o, const std::string& name) {
        const std::span<const std::uint32_t> ends =
            values_at(first, times(count, 2, name.c_str()), name.c_str());
        o.resize(count);
        for (std::size_t i = 0; i < count; ++i) o[i] = {ends[2 * i], ends[2 * i + 1]};
    }
    static void read(const float* first, std::size_t count, std::vector<Vec3f>& o, const std::string& name) {
        o = points_from(first, count, 0, name.c_str());
    }
    static void read(const echinus_attachment* first, std::size_t count, std::vector<Attachment>& o,
                     const std::string& name) {
        for (const echinus_attachment& a : values_at(first, count, name.c_str()))
            o.push_back({a.particle, a.collider});
    }
};

template <typename C, typename Options>
C to_c(const Options& options) {
    C result{};
    for_each_option(result, options, ToC{});
    return result;
}

/// @param options  null for the defaults
template <typename C, typename Options>
Options from_c(const C* options) {
    Options result;
    if (options == nullptr) return result;
    const C given = read_struct(options, to_c<C>(result), "options");
    for_each_option(given, result, FromC{});
    return result;
}

} // namespace

} // namespace echinus::c

#define ECHINUS_OPTIONS(C, OPTIONS)                                                                          \
    C echinus::c::as_c(const OPTIONS& options) {                                                             \
        return to_c<C>(options);                                                                             \
    }                                                                                                        \
    echinus::OPTIONS echinus::c::options_from(const C* options) {                                            \
        return from_c<C, OPTIONS>(options);                                                                  \
    }                                                                                                        \
    void C##_init(C* options, size_t size) {                                                                 \
        echinus::c::init_struct(options, size, echinus::c::as_c(echinus::OPTIONS{}));                        \
    }

ECHINUS_OPTIONS(echinus_repair_options, RepairOptions)
ECHINUS_OPTIONS(echinus_exact_map_options, ExactMapOptions)
ECHINUS_OPTIONS(echinus_distance_map_options, DistanceMapOptions)
ECHINUS_OPTIONS(echinus_tetrahedralize_options, TetrahedralizeOptions)
ECHINUS_OPTIONS(echinus_cloth_options, ClothOptions)
ECHINUS_OPTIONS(echinus_mesh_cloth_options, MeshClothOptions)
ECHINUS_OPTIONS(echinus_soft_body_options, SoftBodyOptions)
ECHINUS_OPTIONS(echinus_simulation_options, SimulationOptions)
ECHINUS_OPTIONS(echinus_particle_collision_options, ParticleCollisionOptions)
ECHINUS_OPTIONS(echinus_surface_collision_options, SurfaceCollisionOptions)
