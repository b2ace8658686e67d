#include <echinus/collider.hpp>
#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/mesh.hpp>
#include <echinus/particle_collision.hpp>
#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

using namespace echinus;

namespace {

std::string last_violation;

void note_violation(const char* sentence) {
    last_violation = sentence;
}

/// Notes violations while it lives.
class NotedViolations {
  public:
    NotedViolations() : previous_(set_precondition_handler(note_violation)) { last_violation.clear(); }
    ~NotedViolations() { set_precondition_handler(previous_); }
    NotedViolations(const NotedViolations&) = delete;
    NotedViolations& operator=(const NotedViolations&) = delete;

  private:
    PreconditionHandler previous_;
};

Simulation small_simulation() {
    return Simulation(make_cloth({.column_count = 3, .row_count = 3}), {}, {});
}

} // namespace

TEST(Precondition, CallsTheHandlerAndLeavesTheOutputAsItWasWhereSizesDiffer) {
    const NotedViolations noted;
    const ExactMap map = ExactMap::build(make_box({1, 1, 1}));
    const std::vector<Vec3f> points(3);
    std::array<std::uint8_t, 2> inside{7, 7};
    contains_batch(map, points, inside);
    EXPECT_EQ(last_violation, "contains_batch: the number of answers differs from the number of points");
    EXPECT_EQ(inside[0], 7);
    std::array<Containment, 4> answers;
    classify_batch(map, points, answers);
    EXPECT_EQ(last_violation, "classify_batch: the number of answers differs from the number of points");
    contains_batch(Collider{.map = map}, points, inside);
    EXPECT_EQ(inside[1], 7);
}

TEST(Precondition, NamesTheIndexThatIsOutOfRangeAndTheCount) {
    const NotedViolations noted;
    Simulation simulation = small_simulation();
    simulation.set_particle_velocity(9, {1, 0, 0});
    EXPECT_EQ(last_violation, "there is no particle 9; there are 9");
    (void)simulation.load_on(2);
    EXPECT_EQ(last_violation, "there is no collider 2; there are 0");
    ParticleCollision particles({{.map = ExactMap::build(make_box({1, 1, 1}))}}, 0.01);
    particles.set_collider_friction(1, 0.5);
    EXPECT_EQ(last_violation, "there is no collider 1; there is 1");
}

TEST(Precondition, ThrowsALogicErrorByDefaultAndChangesNothing) {
    Simulation simulation = small_simulation();
    const std::uint64_t before = simulation.state_hash();
    EXPECT_THROW(simulation.set_particle_velocity(9, {1, 0, 0}), std::logic_error);
    EXPECT_THROW(simulation.set_collider_velocity(0, {1, 0, 0}, {}), std::logic_error);
    EXPECT_THROW((void)simulation.load_on(0), std::logic_error);
    EXPECT_EQ(simulation.state_hash(), before);
}

TEST(Precondition, GivesThePreviousHandlerBack) {
    const NotedViolations noted;
    EXPECT_EQ(set_precondition_handler(nullptr), note_violation);
    EXPECT_EQ(set_precondition_handler(note_violation), nullptr);
}
