#include "commands/verdict.hpp"

#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;

namespace {

/// Moves every particle to where these factors of its coordinates lead.
Deformable stretched(Deformable deformable, const Vec3d& factors) {
    deformable.rest_positions = deformable.positions;
    for (Vec3f& place : deformable.positions)
        place = Vec3f(Vec3d{place.x * factors.x, place.y * factors.y, place.z * factors.z});
    return deformable;
}

} // namespace

TEST(Strain, OfAMembraneIsThePrincipalStretchThatIsFarthestFromOne) {
    const Deformable sheet = stretched(make_cloth({.column_count = 5, .row_count = 4}), {1.1, 0.95, 1});
    const Strain strain = material_strain(sheet).value();
    EXPECT_NEAR(strain.mean, 0.1, 1e-6);
    EXPECT_NEAR(strain.largest, 0.1, 1e-6);
    EXPECT_NEAR(material_strain(stretched(sheet, {1, 0.8, 1}))->largest, 0.2, 1e-6);
}

TEST(Strain, OfAShearedMembraneIsThatOfItsDiagonalsThoughItsEdgesKeepTheirLengths) {
    Deformable sheet = make_cloth({.column_count = 2, .row_count = 2});
    sheet.rest_positions = sheet.positions;
    // A square whose sides enclose 60 degrees: its stretches are the square roots of 1 +- cos 60.
    for (Vec3f& place : sheet.positions)
        place = Vec3f(Vec3d{double{place.x} + place.y * 0.5, place.y * std::sqrt(0.75), 0});
    sheet.faces = {{0, 1, 3}, {0, 3, 2}};
    EXPECT_NEAR(material_strain(sheet)->mean, 1 - std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(edge_strain(sheet)->largest, std::sqrt(1.5) - 1, 1e-6); // of the diagonal between the faces
    EXPECT_NEAR(edge_strain(sheet)->mean, (std::sqrt(1.5) - 1) / 5, 1e-6);
}

TEST(Strain, OfASoftBodyIsThatOfItsTetrahedraAndNotOfItsFaces) {
    const Deformable body = make_soft_body(make_solid_box({1, 1, 1}, {2, 2, 2}), {});
    EXPECT_NEAR(material_strain(body)->largest, 0, 1e-5);
    EXPECT_NEAR(material_strain(stretched(body, {1, 1, 0.9}))->mean, 0.1, 1e-5);
    EXPECT_NEAR(material_strain(stretched(body, {1, 1.3, 0.9}))->largest, 0.3, 1e-5);
    EXPECT_NEAR(material_strain(stretched(body, {1, 1, -1}))->largest, 2, 1e-5); // inside out
}

TEST(Strain, OfAThreadIsThatOfItsPieces) {
    MeshClothOptions options;
    options.threads = {{0, 1}, {1, 2}};
    const Deformable thread = make_cloth({{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, {}}, options);
    EXPECT_NEAR(material_strain(stretched(thread, {1.5, 1, 1}))->mean, 0.5, 1e-6);
    EXPECT_NEAR(edge_strain(stretched(thread, {1.5, 1, 1}))->mean, 0.5, 1e-6);
}

TEST(Strain, OfNothingIsNone) {
    const Deformable particle{.positions = {{}}, .inverse_masses = {1}, .constraints = {}, .faces = {}};
    EXPECT_FALSE(material_strain(particle));
    EXPECT_FALSE(edge_strain(particle));
}
