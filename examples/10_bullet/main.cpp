// Bullet's cloth falls on a torus: through Bullet's own mesh shape, and on an exact map in its place.

#include <echinus/bullet.hpp>
#include <echinus/mesh.hpp>

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <cstdio>

namespace {

constexpr int kSide = 24, kFrames = 120;

btTriangleMesh triangles_of(const echinus::TriangleMesh& mesh) {
    btTriangleMesh triangles;
    const auto corner = [&](std::uint32_t v) { return echinus::bullet::to_bullet(mesh.vertices[v]); };
    for (const auto& [a, b, c] : mesh.faces) triangles.addTriangle(corner(a), corner(b), corner(c));
    return triangles;
}

struct Outcome {
    int inside = 0; ///< nodes, after two seconds
    float lowest = 0;
};

Outcome drop_cloth_on(btCollisionShape& shape, const echinus::ExactMap& judge) {
    btSoftBodyRigidBodyCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver rigid_solver;
    echinus::bullet::Solver solver(dispatcher);
    btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &rigid_solver, &configuration, &solver);
    world.setGravity({0, 0, -9.81F});
    world.getWorldInfo().m_gravity = world.getGravity();

    btRigidBody torus(0, nullptr, &shape);
    world.addRigidBody(&torus);
    btSoftBody& cloth =
        *btSoftBodyHelpers::CreatePatch(world.getWorldInfo(), {-1.2F, -1.2F, 0.5F}, {1.2F, -1.2F, 0.5F},
                                        {-1.2F, 1.2F, 0.5F}, {1.2F, 1.2F, 0.5F}, kSide, kSide, 0, true);
    cloth.getCollisionShape()->setMargin(0.02F);
    cloth.setTotalMass(1);
    cloth.m_cfg.piterations = 10;
    world.addSoftBody(&cloth);

    for (int frame = 0; frame < kFrames; ++frame) world.stepSimulation(1.0F / 60, 0);
    Outcome outcome;
    for (int i = 0; i < cloth.m_nodes.size(); ++i) {
        const echinus::Vec3f place(echinus::bullet::to_echinus(cloth.m_nodes[i].m_x));
        outcome.inside += contains(judge, place) ? 1 : 0;
        outcome.lowest = btMin(outcome.lowest, place.z);
    }
    world.removeSoftBody(&cloth);
    world.removeRigidBody(&torus);
    delete &cloth;
    return outcome;
}

} // namespace

int main() {
    const echinus::TriangleMesh torus = echinus::make_torus(1.0, 0.4, 60, 24);
    const echinus::ExactMap map = echinus::ExactMap::build(torus);
    btTriangleMesh triangles = triangles_of(torus);
    btBvhTriangleMeshShape mesh_shape(&triangles, true);
    echinus::bullet::MapShape map_shape(map);

    const Outcome stock = drop_cloth_on(mesh_shape, map);
    const Outcome ours = drop_cloth_on(map_shape, map);
    std::printf("Bullet's own mesh: %d of %d nodes inside, the lowest at height %.1f\n", stock.inside,
                kSide * kSide, stock.lowest);
    std::printf("an exact map: %d of %d nodes inside, the lowest at height %.1f\n", ours.inside,
                kSide * kSide, ours.lowest);
}
