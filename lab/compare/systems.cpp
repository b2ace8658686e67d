#include "compare/systems.hpp"

#include "compare/turns.hpp"
#include "rivals/classified_grid/classified_grid.hpp"
#include "rivals/dense_grid/dense_grid.hpp"
#include "rivals/maps/maps.hpp"
#ifdef ECHINUS_HAS_BULLET_MESH
#include "rivals/bullet_mesh/bullet_mesh.hpp"
#endif
#ifdef ECHINUS_HAS_EMBREE_TREE
#include "rivals/embree_tree/embree_tree.hpp"
#endif
#ifdef ECHINUS_HAS_SPARSE_FIELD
#include "rivals/sparse_field/sparse_field.hpp"
#endif
#ifdef ECHINUS_HAS_SUPERQUADRIC_MAP
#include "rivals/superquadric_map/superquadric_map.hpp"
#endif

#include <echinus/distance_map.hpp>
#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace echinus::comparison {

namespace {

/// A function that builds, and returns its structure by value.
template <typename Build>
Builder builder(Build build) {
    return {[build] {
                using Structure = decltype(build());
                return std::make_unique<const Structure>(build());
            },
            0};
}

/// A system that keeps nothing but the mesh.
/// @param within  Builder (const TriangleMesh&, std::size_t byte_budget)
template <typename Within>
decltype(SystemType::on) plain(Within within) {
    class Plain final : public Sizes {
      public:
        Plain(const TriangleMesh& mesh, const Within& within) : mesh_(mesh), within_(within) {}
        Builder within(std::size_t byte_budget) override { return within_(mesh_, byte_budget); }

      private:
        const TriangleMesh& mesh_;
        Within within_;
    };
    return [within](const TriangleMesh& mesh, const SystemOptions&, const Progress&) {
        return std::make_unique<Plain>(mesh, within);
    };
}

class ExactSizes final : public Sizes {
  public:
    explicit ExactSizes(const TriangleMesh& mesh) : mesh_(mesh) {}
    Builder within(std::size_t byte_budget) override {
        const ExactMapOptions options{.byte_budget = byte_budget, .thread_count = 1};
        const ExactMap map = ExactMap::build(mesh_, options);
        return of(map.view().divisions);
    }
    std::optional<Builder> usual() override { return of(0); }

  private:
    Builder of(std::uint32_t divisions) const {
        return {[&mesh = mesh_, divisions] {
                    return rivals::exact_map(mesh, {.divisions = divisions, .thread_count = 1});
                },
                0};
    }

    const TriangleMesh& mesh_;
};

decltype(SystemType::on) exact() {
    return [](const TriangleMesh& mesh, const SystemOptions&, const Progress&) {
        return std::make_unique<ExactSizes>(mesh);
    };
}

decltype(SystemType::on) distance(DirectionGrid grid) {
    return plain([grid](const TriangleMesh& mesh, std::size_t byte_budget) -> Builder {
        DistanceMapOptions options;
        options.grid = grid;
        options.thread_count = 1;
        options = rivals::finest_within(mesh, byte_budget, options);
        return {[&mesh, options] { return rivals::distance_map(mesh, options); }, 0};
    });
}

decltype(SystemType::on) dense(rivals::SampleFormat format) {
    return plain([format](const TriangleMesh& mesh, std::size_t byte_budget) {
        return builder([&mesh, byte_budget, format] {
            return rivals::DenseGrid::with_bytes(mesh, byte_budget, {.format = format});
        });
    });
}

Builder classified(const TriangleMesh& mesh, std::size_t byte_budget) {
    const std::int32_t steps = rivals::ClassifiedGrid::build(mesh, byte_budget).cell_steps();
    return builder([&mesh, steps] { return rivals::ClassifiedGrid::build_with_cells(mesh, steps); });
}

#ifdef ECHINUS_HAS_SUPERQUADRIC_MAP
/// Segments and fits take nearly all the time, so they are made once for all sizes.
class SuperquadricSizes final : public Sizes {
  public:
    SuperquadricSizes(const TriangleMesh& mesh, const SystemOptions& options, Progress progress)
        : mesh_(mesh), progress_(std::move(progress)) {
        options_.segment_count = options.segment_count;
        options_.thread_count = 1;
    }
    Builder within(std::size_t byte_budget) override {
        if (!segments_) {
            const double start = process_seconds();
            segments_ = rivals::SuperquadricSegments::fit(mesh_, options_, progress_);
            fit_seconds_ = process_seconds() - start;
        }
        options_.byte_budget = byte_budget;
        Builder result = builder([segments = *segments_, options = options_] {
            return rivals::SuperquadricMap::sample(segments, options);
        });
        result.shared_seconds = fit_seconds_;
        return result;
    }

  private:
    const TriangleMesh& mesh_;
    Progress progress_;
    rivals::SuperquadricMapOptions options_;
    std::optional<rivals::SuperquadricSegments> segments_;
    double fit_seconds_ = 0;
};
#endif

/// Systems that this program may have been built without: `on` is empty then.
decltype(SystemType::on) superquadric_if_there() {
#ifdef ECHINUS_HAS_SUPERQUADRIC_MAP
    return [](const TriangleMesh& mesh, const SystemOptions& options, const Progress& progress) {
        return std::make_unique<SuperquadricSizes>(mesh, options, progress);
    };
#else
    return {};
#endif
}

decltype(SystemType::on) openvdb_if_there() {
#ifdef ECHINUS_HAS_SPARSE_FIELD
    return plain([](const TriangleMesh& mesh, std::size_t byte_budget) {
        const std::uint32_t samples = rivals::SparseField::with_bytes(mesh, byte_budget).sample_count();
        return builder([&mesh, samples] { return rivals::SparseField::with_samples(mesh, samples); });
    });
#else
    return {};
#endif
}

decltype(SystemType::on) embree_if_there() {
#ifdef ECHINUS_HAS_EMBREE_TREE
    return plain([](const TriangleMesh& mesh, std::size_t) {
        return builder([&mesh] { return rivals::EmbreeTree::build(mesh); });
    });
#else
    return {};
#endif
}

decltype(SystemType::on) bullet_if_there() {
#ifdef ECHINUS_HAS_BULLET_MESH
    return plain([](const TriangleMesh& mesh, std::size_t) {
        return builder([&mesh] { return rivals::BulletMesh::build(mesh); });
    });
#else
    return {};
#endif
}

} // namespace

const std::vector<SystemType>& all_systems() {
    using rivals::SampleFormat;
    static const std::vector<SystemType> systems{
        {"exact", "exact map", "", true, exact()},
        {"distance", "distance map", "", true, distance(DirectionGrid::Spherical)},
        {"distance-octahedral", "distance map, octahedral", "", true, distance(DirectionGrid::Octahedral)},
        {"distance-cube", "distance map, cube", "", true, distance(DirectionGrid::Cube)},
        {"distance-ellipsoidal", "distance map, ellipsoidal", "", true, distance(DirectionGrid::Ellipsoidal)},
        {"superquadric", "superquadric map", "libeigen3-dev, libbullet-dev and libbullet-extras-dev", true,
         superquadric_if_there()},
        {"dense", "dense grid", "", true, dense(SampleFormat::Float32)},
        {"dense-16bit", "dense grid, 16 bit", "", true, dense(SampleFormat::Snorm16)},
        {"openvdb", "OpenVDB's narrow band", "libopenvdb-dev", true, openvdb_if_there()},
        {"classified", "classified grid", "", true, plain(&classified)},
        {"embree", "Embree's tree", "libembree-dev", false, embree_if_there()},
        {"bullet", "Bullet's mesh", "libbullet-dev", false, bullet_if_there()},
    };
    return systems;
}

const SystemType& system_named(std::string_view name) {
    const auto& systems = all_systems();
    const auto found = std::ranges::find(systems, name, &SystemType::name);
    if (found == systems.end()) {
        std::string names;
        for (const SystemType& system : systems) (names += names.empty() ? "" : ", ") += system.name;
        throw Error(ErrorCode::InvalidOptions,
                    "there is no system '" + std::string(name) + "'; there are " + names);
    }
    if (!found->available())
        throw Error(ErrorCode::InvalidOptions, "this program was built without the system '" +
                                                   std::string(name) + "': install " +
                                                   std::string(found->package) + " and build it again");
    return *found;
}

} // namespace echinus::comparison
