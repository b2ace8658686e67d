// Every argument of every function and every member of every options struct, spoilt in each way that its type
// allows: refused by its name, and nothing is read or written where there is nothing.

#include "handles.hpp"
#include "options.hpp" // of bindings/c/src: which members there are, and their ranges

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <string_view>
#include <tuple>
#include <type_traits>

using namespace echinus;
using namespace echinus::test;

namespace {

echinus_deformable_arrays one_particle(const float* position) {
    echinus_deformable_arrays arrays{};
    arrays.size = sizeof arrays;
    arrays.particle_count = 1;
    arrays.positions = position;
    return arrays;
}

// ---- Arguments

/// The place for a result, which owns it.
template <typename Handle, void (*destroy)(Handle*)>
struct Place {
    ~Place() { destroy(handle); }
    Handle** fresh() {
        destroy(handle);
        handle = nullptr;
        return &handle;
    }
    Handle* handle = nullptr;
};

/// One value for each type of argument, fit for all functions: indices, counts and arrays suit each other.
class Samples {
  public:
    Samples() {
        expect_ok(echinus_map_builder_create(kIndices, 1, nullptr, out(builder_)));
        expect_ok(echinus_tetrahedra_create(floats_, 4, 0, kIndices, 1, out(body_)));
        expect_ok(echinus_embedding_create(body_.get(), floats_, 1, 0, 1, out(embedding_)));
        expect_ok(echinus_deformable_cloth(nullptr, out(deformable_)));
        expect_ok(echinus_vertex_cache_create(floats_, 1, 4, 0, 1, out(cache_)));
        expect_ok(echinus_scene_parse(R"({"model": {"torus": {}}, "cloth": {"size": [1, 1]}})", "name",
                                      out(scene_)));
        echinus_collider_init(&collider_, sizeof collider_, map_.get());
        echinus_simulation_options options;
        echinus_simulation_options_init(&options, sizeof options);
        options.solver = ECHINUS_SOLVER_JAKOBSEN;
        expect_ok(echinus_simulation_create(deformable_.get(), &collider_, 1, &options, out(simulation_)));
        expect_ok(echinus_particle_collision_create(&collider_, 1, 0.01, nullptr, out(particles_)));
        expect_ok(echinus_surface_collision_create(kFarTriangle, 3, kIndices, 1, &collider_, 1, 0.01, nullptr,
                                                   out(surfaces_)));
        custom_.contains = [](void*, const float*, std::size_t, std::uint8_t*) {};
        custom_.contacts = [](void*, const float*, std::size_t, float, echinus_contact*) {};
    }

    template <typename T>
    T of(std::string_view name) {
        if constexpr (std::is_same_v<T, const char*>)
            return "none/such.obj";
        else if constexpr (std::is_same_v<T, const char* const*>)
            return kTexts;
        else if constexpr (std::is_integral_v<T>)
            return whole(name);
        else if constexpr (std::is_floating_point_v<T>)
            return 1;
        else if constexpr (std::is_pointer_v<std::remove_pointer_t<T>>)
            return list_or_place(T{});
        else if constexpr (std::is_function_v<std::remove_pointer_t<T>>)
            return nullptr;
        else
            return address(T{});
    }

    bool wants_distance_map = false;

  private:
    static std::uint32_t whole(std::string_view name) {
        if (name.ends_with("stride") || name == "index" || name == "number" || name == "particle") return 0;
        if (name == "vertex_count" || name == "position_count") return 4;
        return name == "byte_count" ? 8 : 1;
    }

    const echinus_array* address(const echinus_array*) { return nullptr; }
    const echinus_mesh* address(const echinus_mesh*) { return mesh_.get(); }
    const echinus_map* address(const echinus_map*) {
        return (wants_distance_map ? distance_map_ : map_).get();
    }
    echinus_map_builder* address(echinus_map_builder*) { return builder_.get(); }
    const echinus_tetrahedra* address(const echinus_tetrahedra*) { return body_.get(); }
    const echinus_embedding* address(const echinus_embedding*) { return embedding_.get(); }
    const echinus_vertex_cache* address(const echinus_vertex_cache*) { return cache_.get(); }
    const echinus_deformable* address(const echinus_deformable*) { return deformable_.get(); }
    const echinus_simulation* address(const echinus_simulation*) { return simulation_.get(); }
    echinus_simulation* address(echinus_simulation*) { return simulation_.get(); }
    echinus_particle_collision* address(echinus_particle_collision*) { return particles_.get(); }
    const echinus_particle_collision* address(const echinus_particle_collision*) { return particles_.get(); }
    echinus_surface_collision* address(echinus_surface_collision*) { return surfaces_.get(); }
    const echinus_surface_collision* address(const echinus_surface_collision*) { return surfaces_.get(); }
    const echinus_scene* address(const echinus_scene*) { return scene_.get(); }
    const echinus_collider* address(const echinus_collider*) { return &collider_; }
    const echinus_custom_map* address(const echinus_custom_map*) { return &custom_; }
    const echinus_deformable_arrays* address(const echinus_deformable_arrays*) { return &arrays_; }
    const echinus_pose* address(const echinus_pose*) { return &collider_.pose; }
    const echinus_pose_key* address(const echinus_pose_key*) { return &key_; }
    const float* address(const float*) { return floats_; }
    const double* address(const double*) { return doubles_; }
    const std::uint32_t* address(const std::uint32_t*) { return kIndices; }
    const void* address(const void*) { return doubles_; }
    void* address(void*) { return doubles_; }

    template <typename Struct>
    requires requires(Struct s) { s.size; }
    Struct* address(Struct*) { return &with_size<std::remove_const_t<Struct>>(); }
    /// Out: contacts, hits, numbers.
    template <typename T>
    T* address(T*) {
        return reinterpret_cast<T*>(written_);
    }

    /// Options have their defaults, but for those that leave no choice.
    template <typename Struct>
    static Struct& with_size() {
        static Struct result;
        result = {};
        result.size = sizeof result;
        if constexpr (requires { result.lattice_size, result.most_tetrahedra; }) {
            echinus_tetrahedralize_options_init(&result, sizeof result);
            result.lattice_size = 0.3;
        }
        if constexpr (std::is_same_v<Struct, echinus_simulation_options>)
            echinus_simulation_options_init(&result, sizeof result);
        return result;
    }

    const echinus_deformable* const* list_or_place(const echinus_deformable* const*) {
        part_ = deformable_.get();
        return &part_;
    }
    const echinus_mesh* const* list_or_place(const echinus_mesh* const*) {
        checked_ = mesh_.get();
        return &checked_;
    }
    echinus_array** list_or_place(echinus_array**) {
        return array_places_[++array_turn_ % std::size(array_places_)].fresh();
    }
    echinus_mesh** list_or_place(echinus_mesh**) { return mesh_place_.fresh(); }
    echinus_map** list_or_place(echinus_map**) { return map_place_.fresh(); }
    echinus_map_builder** list_or_place(echinus_map_builder**) { return builder_place_.fresh(); }
    echinus_tetrahedra** list_or_place(echinus_tetrahedra**) { return body_place_.fresh(); }
    echinus_embedding** list_or_place(echinus_embedding**) { return embedding_place_.fresh(); }
    echinus_vertex_cache** list_or_place(echinus_vertex_cache**) { return cache_place_.fresh(); }
    echinus_deformable** list_or_place(echinus_deformable**) { return deformable_place_.fresh(); }
    echinus_simulation** list_or_place(echinus_simulation**) { return simulation_place_.fresh(); }
    echinus_particle_collision** list_or_place(echinus_particle_collision**) {
        return particles_place_.fresh();
    }
    echinus_surface_collision** list_or_place(echinus_surface_collision**) { return surfaces_place_.fresh(); }
    const std::uint32_t** list_or_place(const std::uint32_t**) { return &corrected_; }
    echinus_scene** list_or_place(echinus_scene**) { return scene_place_.fresh(); }

    static constexpr std::uint32_t kIndices[4] = {0, 1, 2, 3};
    static constexpr float kFarTriangle[9] = {9, 0, 0, 10, 0, 0, 9, 1, 0};
    static constexpr const char* kTexts[1] = {"none"};
    float floats_[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    double doubles_[12] = {1, 0.1, 0.2, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    alignas(8) std::byte written_[4096] = {};
    CMesh mesh_ = c_torus();
    CMap map_ = c_map(mesh_), distance_map_ = c_distance_map(mesh_);
    CBuilder builder_;
    CTetrahedra body_;
    CEmbedding embedding_;
    CVertexCache cache_;
    CDeformable deformable_;
    CSimulation simulation_;
    CScene scene_;
    CParticleCollision particles_;
    CSurfaceCollision surfaces_;
    const std::uint32_t* corrected_ = nullptr;
    echinus_collider collider_{};
    echinus_custom_map custom_ = [] {
        echinus_custom_map custom{};
        custom.size = sizeof custom;
        return custom;
    }();
    echinus_pose_key key_{.time = 0, .pose = {.rotation = {1, 0, 0, 0}, .translation = {}}};
    echinus_deformable_arrays arrays_ = one_particle(floats_);
    const echinus_deformable* part_ = nullptr;
    const echinus_mesh* checked_ = nullptr;
    Place<echinus_array, echinus_array_destroy> array_places_[3]; // one call may give three
    std::size_t array_turn_ = 0;
    Place<echinus_mesh, echinus_mesh_destroy> mesh_place_;
    Place<echinus_map, echinus_map_destroy> map_place_;
    Place<echinus_map_builder, echinus_map_builder_destroy> builder_place_;
    Place<echinus_tetrahedra, echinus_tetrahedra_destroy> body_place_;
    Place<echinus_embedding, echinus_embedding_destroy> embedding_place_;
    Place<echinus_vertex_cache, echinus_vertex_cache_destroy> cache_place_;
    Place<echinus_deformable, echinus_deformable_destroy> deformable_place_;
    Place<echinus_simulation, echinus_simulation_destroy> simulation_place_;
    Place<echinus_scene, echinus_scene_destroy> scene_place_;
    Place<echinus_particle_collision, echinus_particle_collision_destroy> particles_place_;
    Place<echinus_surface_collision, echinus_surface_collision_destroy> surfaces_place_;
};

bool is_named(std::string_view name) {
    return std::string_view(echinus_last_error()).find(name) != std::string_view::npos;
}

class CSweep : public ::testing::Test {
  protected:
    /// @param names  of the arguments; "?" after one that may be NULL, "!" after numbers that have to be
    /// finite
    template <typename... P, typename... Names>
    void sweep_status(const char* function, echinus_status (*call)(P...), Names... names) {
        SCOPED_TRACE(function);
        const std::array<std::string_view, sizeof...(P)> all{names...};
        samples_.wants_distance_map = std::string_view(function) == "echinus_map_distance_statistics";
        EXPECT_NE(status(call, all), ECHINUS_INVALID_ARGUMENT)
            << "the samples suit: " << echinus_last_error();
        spoil_each(function, call, all, std::index_sequence_for<P...>());
    }

    template <typename R, typename... P, typename... Names>
    void sweep_value(const char* function, R (*call)(P...), Names...) {
        SCOPED_TRACE(function);
        if constexpr (std::is_void_v<R>)
            call(P{}...);
        else if constexpr ((std::is_pointer_v<P> && ...))
            EXPECT_EQ(call(P{}...), R{});
    }

  private:
    static std::string_view plain(std::string_view name) { return name.substr(0, name.find_first_of("?!")); }

    template <typename... P, std::size_t... I>
    std::tuple<P...> samples(const std::array<std::string_view, sizeof...(P)>& names,
                             std::index_sequence<I...>) {
        return {samples_.of<P>(plain(names[I]))...};
    }
    template <typename... P>
    echinus_status status(echinus_status (*call)(P...),
                          const std::array<std::string_view, sizeof...(P)>& names) {
        return std::apply(call, samples<P...>(names, std::index_sequence_for<P...>()));
    }

    template <typename... P, std::size_t... I>
    void spoil_each(const char* function, echinus_status (*call)(P...),
                    const std::array<std::string_view, sizeof...(P)>& names, std::index_sequence<I...> all) {
        const auto spoil = [&]<std::size_t i>() {
            using T = std::tuple_element_t<i, std::tuple<P...>>;
            const std::string_view name = plain(names[i]);
            const auto with = [&](T wrong) {
                std::tuple<P...> given = samples<P...>(names, all);
                std::get<i>(given) = wrong;
                return std::apply(call, given);
            };
            if constexpr (std::is_pointer_v<T>) {
                if (names[i].ends_with('?')) {
                    EXPECT_NE(with(nullptr), ECHINUS_INVALID_ARGUMENT)
                        << name << ": " << echinus_last_error();
                } else {
                    EXPECT_EQ(with(nullptr), ECHINUS_INVALID_ARGUMENT) << name;
                    EXPECT_TRUE(is_named(function) && is_named("NULL"))
                        << name << ": " << echinus_last_error();
                }
            }
            if constexpr (std::is_same_v<T, const double*>) {
                const double wrong[4] = {1, kNan, 1, 1};
                if (names[i].ends_with('!')) EXPECT_NE(with(wrong), ECHINUS_OK) << name << " with NaN";
            }
            if constexpr (std::is_floating_point_v<T>)
                EXPECT_NE(with(static_cast<T>(kNan)), ECHINUS_OK) << name << " is NaN";
            if constexpr (std::is_same_v<T, float>) // lengths and tolerances
                EXPECT_EQ(with(-1.0F), ECHINUS_INVALID_ARGUMENT) << name << " is negative";
            if constexpr (std::is_same_v<T, std::size_t>) {
                if (name.ends_with("stride")) EXPECT_EQ(with(7), ECHINUS_INVALID_ARGUMENT) << name;
                if (name.ends_with("count")) EXPECT_NE(with(SIZE_MAX / 4), ECHINUS_OK) << name;
                if (name == "index" || name == "particle")
                    EXPECT_EQ(with(1U << 20U), ECHINUS_INVALID_ARGUMENT) << name;
            }
        };
        (spoil.template operator()<I>(), ...);
    }

    Samples samples_;
};

#define STATUS(FUNCTION, ...) sweep_status(#FUNCTION, FUNCTION, __VA_ARGS__);
#define VALUE(FUNCTION, ...) sweep_value(#FUNCTION, FUNCTION, __VA_ARGS__);

TEST_F(CSweep, RefusesEveryWrongArgumentOfEveryFunctionByName) {
#include "calls.inc"
}

// ---- Options

/// Spoils the members of an options struct of C, one after the other.
template <typename C>
class Spoiler {
  public:
    /// @param use  of the options
    Spoiler(C& options, std::function<echinus_status()> use) : options_(options), use_(std::move(use)) {}

    void operator()(const char* name, double& c, const double&, c::Limits limits) const {
        for (const double wrong : {kNan, limits.least - 2, -kInfinity})
            expect(ECHINUS_INVALID_OPTIONS, name, c, wrong);
        for (const double wrong : {2 * limits.most, kInfinity})
            if (limits.most < kInfinity) expect(ECHINUS_INVALID_OPTIONS, name, c, wrong);
    }
    void operator()(const char* name, double& c, const std::optional<double>&, c::Limits limits) const {
        (*this)(name, c, double{}, limits);
    }
    void operator()(const char* name, double& c, const double&) const { // positive, or not negative
        for (const double wrong : {kNan, -1.0, kInfinity}) expect(ECHINUS_INVALID_OPTIONS, name, c, wrong);
    }
    void operator()(const char* name, std::uint32_t& c, const std::uint32_t&, c::Limits limits) const {
        const auto least = static_cast<std::uint32_t>(limits.least),
                   most = static_cast<std::uint32_t>(limits.most);
        if (least > 0) expect(ECHINUS_INVALID_OPTIONS, name, c, least - 1);
        expect(ECHINUS_INVALID_OPTIONS, name, c, most + 1);
    }
    template <std::size_t kCount>
    void operator()(const char* name, double (&c)[kCount], const auto&, c::Limits) const {
        for (double& number : c)
            for (const double wrong : {kNan, kInfinity}) expect(ECHINUS_INVALID_OPTIONS, name, number, wrong);
    }
    template <typename Flag>
    void operator()(const char* name, Flag& c, const bool&) const {
        for (const int wrong : {2, -1}) expect(ECHINUS_INVALID_ARGUMENT, name, c, static_cast<Flag>(wrong));
    }
    template <typename CEnum, typename Enum>
    requires std::is_enum_v<CEnum>
    void operator()(const char* name, CEnum& c, const Enum&, Enum last) const {
        static_assert(sizeof c == sizeof(std::int32_t));
        for (const std::int32_t wrong : {static_cast<std::int32_t>(last) + 1, -1}) {
            const CEnum before = c;
            std::memcpy(&c, &wrong, sizeof wrong); // which is no enumerator
            expect_now(ECHINUS_INVALID_ARGUMENT, name);
            c = before;
        }
    }
    void operator()(const char* name, echinus_pose& c, const RigidTransform&) const {
        expect(ECHINUS_INVALID_OPTIONS, name, c.rotation[0], 2.0);
        for (double& number : c.rotation) expect(ECHINUS_INVALID_OPTIONS, name, number, kNan);
        for (double& number : c.translation) expect(ECHINUS_INVALID_OPTIONS, name, number, kInfinity);
    }
    template <typename T>
    void operator()(const char* name, const T*&, std::size_t& count, const auto&) const {
        expect(ECHINUS_INVALID_ARGUMENT, name, count, std::size_t{1}); // of an array that is NULL
    }
    void operator()(const char*, auto&, const std::size_t&) const {}            // any number
    void operator()(const char*, std::uint32_t&, const std::uint32_t&) const {} // of threads, any number
    void operator()(const char*, std::uint64_t&, const std::uint32_t&) const {}
    void reserved(auto& c) const {
        expect(ECHINUS_INVALID_ARGUMENT, "reserved", c, std::remove_reference_t<decltype(c)>(7));
    }

  private:
    template <typename T>
    void expect(echinus_status expected, const char* name, T& member, T wrong) const {
        const T before = member;
        member = wrong;
        expect_now(expected, name);
        member = before;
    }
    void expect_now(echinus_status expected, const char* name) const {
        EXPECT_EQ(use_(), expected) << name << ": " << echinus_last_error();
        if (expected == ECHINUS_INVALID_ARGUMENT)
            EXPECT_TRUE(is_named(std::string("options.") + name)) << echinus_last_error();
    }

    C& options_;
    std::function<echinus_status()> use_;
};

/// Compares members of C with those of C++.
struct Same {
    void operator()(const char* name, const auto& c, const auto& o, auto...) const {
        EXPECT_EQ(static_cast<double>(c), static_cast<double>(o)) << name;
    }
    void operator()(const char* name, double c, const std::optional<double>& o, c::Limits) const {
        EXPECT_EQ(c, o.value_or(ECHINUS_THICKNESS_CHOSEN)) << name;
    }
    template <std::size_t kCount>
    void operator()(const char* name, const double (&c)[kCount], const auto& o, c::Limits) const {
        EXPECT_EQ(std::memcmp(&c, &o, sizeof c), 0) << name;
    }
    void operator()(const char* name, const echinus_pose& c, const RigidTransform& o) const {
        EXPECT_EQ(std::memcmp(&c, &o, sizeof c), 0) << name;
    }
    void operator()(const char* name, const auto* const& first, std::size_t count, const auto& list) const {
        EXPECT_TRUE(first == nullptr && count == 0 && list.empty()) << name;
    }
    void reserved(const auto& c) const { EXPECT_EQ(c, 0); }
};

/// @param use  makes something with options
template <typename Options, typename C, typename Use>
void sweep_options(void (*init)(C*, std::size_t), const Use& use,
                   const std::function<void(C&)>& prepare = {}) {
    C options;
    init(&options, sizeof options);
    const Options defaults;
    c::for_each_option(std::as_const(options), defaults, Same());
    if (prepare) prepare(options);
    EXPECT_EQ(use(options), ECHINUS_OK) << echinus_last_error();
    c::for_each_option(options, defaults, Spoiler<C>(options, [&] { return use(options); }));
}

TEST(COptions, HaveTheDefaultsOfCppAndAreRefusedWithAnyMemberOutOfItsRange) {
    const CMesh mesh = c_mesh_of(make_box({1, 1, 1}));
    const CMap map = c_map(mesh);
    const std::uint32_t one[3] = {1, 1, 1};
    const double size[3] = {1, 1, 1};
    CTetrahedra body;
    expect_ok(echinus_tetrahedra_box(size, one, out(body)));
    const float position[3] = {};
    const echinus_deformable_arrays arrays = one_particle(position);
    CDeformable particle;
    expect_ok(echinus_deformable_create(&arrays, out(particle)));

    CMesh made_mesh;
    CMap made_map;
    CTetrahedra made_body;
    CDeformable made_deformable;
    CSimulation made_simulation;
    sweep_options<RepairOptions>(echinus_repair_options_init, [&](const echinus_repair_options& o) {
        return echinus_mesh_repair(mesh.get(), &o, out(made_mesh), nullptr, nullptr);
    });
    sweep_options<ExactMapOptions>(echinus_exact_map_options_init, [&](const echinus_exact_map_options& o) {
        return echinus_map_build_exact(mesh.get(), &o, out(made_map));
    });
    // Either grid has members of its own.
    sweep_options<DistanceMapOptions>(echinus_distance_map_options_init, [&](echinus_distance_map_options o) {
        o.longitude_count = o.longitude_count == 200 ? 8 : o.longitude_count;
        o.colatitude_count = o.colatitude_count == 200 ? 8 : o.colatitude_count;
        const echinus_status first = echinus_map_build_distance(mesh.get(), &o, out(made_map));
        if (first != ECHINUS_OK) return first;
        o.grid = ECHINUS_GRID_CUBE;
        return echinus_map_build_distance(mesh.get(), &o, out(made_map));
    });
    sweep_options<TetrahedralizeOptions, echinus_tetrahedralize_options>(
        echinus_tetrahedralize_options_init,
        [&](const echinus_tetrahedralize_options& o) {
            return echinus_tetrahedralize(map.get(), &o, out(made_body), nullptr);
        },
        [](echinus_tetrahedralize_options& o) { o.lattice_size = 0.3; });
    sweep_options<ClothOptions>(echinus_cloth_options_init, [&](const echinus_cloth_options& o) {
        return echinus_deformable_cloth(&o, out(made_deformable));
    });
    sweep_options<MeshClothOptions>(
        echinus_mesh_cloth_options_init, [&](const echinus_mesh_cloth_options& o) {
            return echinus_deformable_cloth_of_mesh(mesh.get(), &o, out(made_deformable));
        });
    sweep_options<SoftBodyOptions>(echinus_soft_body_options_init, [&](const echinus_soft_body_options& o) {
        return echinus_deformable_soft_body(body.get(), &o, out(made_deformable));
    });
    sweep_options<SimulationOptions>(
        echinus_simulation_options_init, [&](const echinus_simulation_options& o) {
            return echinus_simulation_create(particle.get(), nullptr, 0, &o, out(made_simulation));
        });
    CParticleCollision made_particles;
    sweep_options<ParticleCollisionOptions>(
        echinus_particle_collision_options_init, [&](const echinus_particle_collision_options& o) {
            return echinus_particle_collision_create(nullptr, 0, 0.01, &o, out(made_particles));
        });
    CSurfaceCollision made_surfaces;
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::uint32_t face[3] = {0, 1, 2};
    sweep_options<SurfaceCollisionOptions>(
        echinus_surface_collision_options_init, [&](const echinus_surface_collision_options& o) {
            return echinus_surface_collision_create(corners, 3, face, 1, nullptr, 0, 0.01, &o,
                                                    out(made_surfaces));
        });
}

} // namespace
