#include "directions/face_cone.hpp"
#include "directions/lattice.hpp"
#include "mesh/require_valid.hpp"
#include "support/expectations.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <vector>

using namespace echinus;

TEST(LatticeOnPosix, RefusesMoreFacesThanCanBeNumbered) {
    // Address space that nothing may read.
    const std::size_t count = kMostFaces + 1, bytes = count * sizeof(Triangle);
    void* space = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (space == MAP_FAILED) GTEST_SKIP() << "no room for so many addresses";
    LatticeSnapper snapper({static_cast<const Triangle*>(space), count});
    LatticeMesh lattice;
    test::expect_error(ErrorCode::InvalidMesh, "1073741825 faces",
                       [&] { snapper.snap(std::vector<Vec3f>(3), lattice); });
    munmap(space, bytes);
    test::expect_error(ErrorCode::InvalidMesh, "3221225473 vertices",
                       [] { require_numberable(1, 3 * kMostFaces + 1); });
}
