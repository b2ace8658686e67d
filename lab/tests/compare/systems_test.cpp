#include "compare/systems.hpp"
#include "support/expectations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

using namespace echinus;
using namespace echinus::comparison;

namespace {

SystemOptions few_segments() {
    return {.segment_count = 3};
}

} // namespace

TEST(Systems, HaveNamesOfOneWordThatNoTwoShare) {
    std::set<std::string_view> names;
    for (const SystemType& system : all_systems()) {
        EXPECT_TRUE(names.insert(system.name).second) << system.name;
        EXPECT_EQ(system.name.find_first_of(" ,"), std::string_view::npos) << system.name;
        EXPECT_EQ(&system_named(system.name) == &system, true) << system.name;
        EXPECT_EQ(system.available() || !system.package.empty(), true) << system.name;
    }
    for (const char* part : {"superquadric", "dense", "openvdb", "embree", "exact", "distance"})
        EXPECT_TRUE(std::ranges::any_of(names, [&](std::string_view name) {
            return name.find(part) != std::string_view::npos;
        })) << part;
}

TEST(Systems, ThatDoNotExistAreRefusedByNameWithThoseThatDo) {
    test::expect_error(ErrorCode::InvalidOptions, "exact, distance", [] { (void)system_named("octree"); });
}

TEST(Systems, KeepWithinTheirBudgetAndUseMostOfIt) {
    const TriangleMesh torus = make_torus(1, 0.4, 30, 12);
    constexpr std::size_t kBudget = 400'000;
    for (const SystemType& system : all_systems()) {
        if (!system.available()) continue;
        const auto sizes = system.on(torus, few_segments(), {});
        const Built built = sizes->within(kBudget).build();
        EXPECT_LE(built->byte_count(), kBudget) << system.name;
        if (system.has_sizes && system.name != "exact") // whose cells come in few sizes
            EXPECT_GE(built->byte_count(), kBudget * 8 / 10) << system.name;
    }
}

TEST(Systems, BuildTheSameAgain) {
    const TriangleMesh torus = make_torus(1, 0.4, 20, 10);
    for (const SystemType& system : all_systems()) {
        if (!system.available()) continue;
        const Builder builder = system.on(torus, few_segments(), {})->within(350'000);
        EXPECT_EQ(builder.build()->byte_count(), builder.build()->byte_count()) << system.name;
    }
}

TEST(Systems, RefuseABudgetBelowTheirCoarsestButForThoseWithoutSizes) {
    const TriangleMesh torus = make_torus(1, 0.4, 20, 10);
    for (const SystemType& system : all_systems()) {
        if (!system.available()) continue;
        const auto sizes = system.on(torus, few_segments(), {});
        EXPECT_EQ(sizes->usual().has_value(), system.name == "exact");
        if (!system.has_sizes)
            EXPECT_GT(sizes->within(15).build()->byte_count(), 15U) << system.name;
        else
            test::expect_error(ErrorCode::InvalidOptions, "", [&] { (void)sizes->within(15).build(); });
    }
}
