#include "engine.hpp"

#include <echinus/bullet.hpp>

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>

using namespace echinus;

namespace {

constexpr btScalar kTotalMass = 1;
/// pybullet's: its time step, and the margin of its deformables.
constexpr unsigned kRecommendedSubsteps = 4;
constexpr btScalar kRecommendedMargin = btScalar(0.02);

struct Links {
    std::vector<std::array<int, 2>> edges;   ///< of the faces
    std::vector<std::array<int, 2>> bending; ///< of every second particle of a row or column
};

Links links_of(const TriangleMesh& cloth) {
    Links links;
    std::set<std::array<int, 2>> edges;
    for (const Triangle& face : cloth.faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const int a = static_cast<int>(face[k]), b = static_cast<int>(face[(k + 1) % 3]);
            edges.insert({std::min(a, b), std::max(a, b)});
        }
    links.edges.assign(edges.begin(), edges.end());
    const int side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(cloth.vertices.size()))));
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const int node = row * side + column;
            if (column + 2 < side) links.bending.push_back({node, node + 2});
            if (row + 2 < side) links.bending.push_back({node, node + 2 * side});
        }
    return links;
}

class BulletEngine : public Engine {
  public:
    explicit BulletEngine(const Task& task)
        : with_echinus_(task.with_echinus), is_matched_(task.is_matched),
          world_(&dispatcher_, &broadphase_, &rigid_solver_, &configuration_, soft_solver(task)),
          shape_(shape_of(task)), model_(0, nullptr, shape_.get()), cloth_(nodes_of(task.cloth)) {
        const btVector3 gravity(0, btScalar(-kGravity), 0);
        world_.setGravity(gravity);
        world_.getWorldInfo().m_gravity = gravity;
        world_.getWorldInfo().m_sparsesdf.Initialize();
        model_.setFriction(btScalar(kFriction));
        world_.addRigidBody(&model_);
        make_cloth(task.cloth);
        world_.addSoftBody(&cloth_);
    }
    ~BulletEngine() override {
        world_.removeSoftBody(&cloth_);
        world_.removeRigidBody(&model_);
    }
    BulletEngine(const BulletEngine&) = delete;
    BulletEngine& operator=(const BulletEngine&) = delete;

    std::string name() const override { return "Bullet"; }
    std::string version() const override {
        return fmt::format("{}.{}", btGetVersion() / 100, btGetVersion() % 100);
    }
    std::string configuration() const override { return with_echinus_ ? "with Echinus" : "alone"; }
    unsigned substeps() const override { return is_matched_ ? 1 : kRecommendedSubsteps; }
    std::map<std::string, std::string> settings() const override {
        return {{"world", "btSoftRigidDynamicsWorld"},
                {"collider", with_echinus_ ? "echinus::bullet::MapShape" : "btBvhTriangleMeshShape"},
                {"piterations", fmt::format("{}", cloth_.m_cfg.piterations)},
                {"margin", fmt::format("{:.3g} R", margin())},
                {"kKHR", fmt::format("{:.3g}", cloth_.m_cfg.kKHR)},
                {"kDF", fmt::format("{:.3g}", cloth_.m_cfg.kDF)},
                {"links", "edges, and every second particle of rows and columns"}};
    }
    void run_frame() override {
        for (unsigned i = 0; i < substeps(); ++i)
            world_.stepSimulation(static_cast<btScalar>(kFrameSeconds / substeps()), 0);
    }
    std::vector<Vec3f> positions() const override {
        std::vector<Vec3f> result;
        for (int i = 0; i < cloth_.m_nodes.size(); ++i)
            result.emplace_back(bullet::to_echinus(cloth_.m_nodes[i].m_x));
        return result;
    }

  private:
    btScalar margin() const { return is_matched_ ? btScalar(kMatchedThickness) : kRecommendedMargin; }

    btSoftBodySolver* soft_solver(const Task& task) {
        if (!task.with_echinus) return nullptr;
        solver_ = std::make_unique<bullet::Solver>(dispatcher_);
        return solver_.get();
    }

    std::unique_ptr<btConcaveShape> shape_of(const Task& task) {
        if (task.with_echinus) return std::make_unique<bullet::MapShape>(ExactMap::build(task.model));
        for (const Triangle& f : task.model.faces)
            triangles_.addTriangle(bullet::to_bullet(task.model.vertices[f[0]]),
                                   bullet::to_bullet(task.model.vertices[f[1]]),
                                   bullet::to_bullet(task.model.vertices[f[2]]));
        return std::make_unique<btBvhTriangleMeshShape>(&triangles_, true);
    }

    btSoftBody nodes_of(const TriangleMesh& mesh) {
        std::vector<btVector3> places;
        for (const Vec3f& vertex : mesh.vertices) places.push_back(bullet::to_bullet(vertex));
        const std::vector<btScalar> masses(places.size(), 1);
        return {&world_.getWorldInfo(), static_cast<int>(places.size()), places.data(), masses.data()};
    }

    /// As btSoftBodyHelpers::CreateFromTriMesh() and generateBendingConstraints(2) do, whose tables of n^2
    /// entries are too large for a fine cloth.
    void make_cloth(const TriangleMesh& mesh) {
        btSoftBody::Material* bending = cloth_.appendMaterial();
        if (is_matched_) {
            bending->m_kLST = btScalar(0.3);
            cloth_.m_cfg.kKHR = btScalar(0.3); // less does not keep the margin, and more lets cloth hop
        }
        const Links links = links_of(mesh);
        for (const auto& [a, b] : links.edges) cloth_.appendLink(a, b, cloth_.m_materials[0]);
        for (const auto& [a, b] : links.bending) cloth_.appendLink(a, b, bending);
        for (const Triangle& f : mesh.faces)
            cloth_.appendFace(static_cast<int>(f[0]), static_cast<int>(f[1]), static_cast<int>(f[2]),
                              cloth_.m_materials[0]);
        cloth_.randomizeConstraints();
        cloth_.setTotalMass(kTotalMass);
        cloth_.getCollisionShape()->setMargin(margin());
        cloth_.m_cfg.piterations = kMatchedIterations;
        cloth_.m_cfg.kDF = 1; // times the model's friction
        cloth_.setActivationState(DISABLE_DEACTIVATION);
    }

    bool with_echinus_, is_matched_;
    btSoftBodyRigidBodyCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver rigid_solver_;
    std::unique_ptr<bullet::Solver> solver_;
    btSoftRigidDynamicsWorld world_;
    btTriangleMesh triangles_;
    std::unique_ptr<btConcaveShape> shape_;
    btRigidBody model_;
    btSoftBody cloth_;
};

} // namespace

std::unique_ptr<Engine> make_bullet(const Task& task) {
    return std::make_unique<BulletEngine>(task);
}
