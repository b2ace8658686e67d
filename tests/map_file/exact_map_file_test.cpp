#include "exact_map/layout.hpp"
#include "support/expectations.hpp"
#include "support/map_file_attack.hpp"
#include "support/meshes.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/map_file.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace echinus::test {

/// A copy of an exact map's arrays, to be changed before making a map of them again.
struct ExactMapParts {
    ExactMapView view; ///< its spans are unused
    ExactMapStatistics statistics;
    std::uint64_t source_hash = 0;
    std::vector<std::uint32_t> band_offsets;
    std::vector<std::uint16_t> outer_limits;
    std::vector<Band> bands;
    std::vector<std::int16_t> winding_below;
    std::vector<std::uint16_t> reference_parts;
    std::vector<Vec3<std::int32_t>> vertices;
    std::vector<TreeNode> nodes;
    std::vector<BorderEdge> border;
    struct Indices {
        std::vector<std::uint16_t> narrow;
        std::vector<std::uint32_t> wide;

        explicit Indices(const IndexArray& array)
            : narrow(array.narrow.begin(), array.narrow.end()), wide(array.wide.begin(), array.wide.end()) {}
        IndexArray view() const { return {narrow, wide}; }
        /// Stores the same numbers in 32 bits.
        void widen() {
            wide.insert(wide.begin(), narrow.begin(), narrow.end());
            narrow.clear();
        }
    } references, corners, face_numbers;

    explicit ExactMapParts(const ExactMap& map)
        : view(map.view()), statistics(map.statistics()), source_hash(map.source_hash()),
          band_offsets(view.band_offsets.begin(), view.band_offsets.end()),
          outer_limits(view.outer_limits.begin(), view.outer_limits.end()),
          bands(view.bands.begin(), view.bands.end()),
          winding_below(view.winding_below.begin(), view.winding_below.end()),
          reference_parts(view.reference_parts.begin(), view.reference_parts.end()),
          vertices(view.vertices.begin(), view.vertices.end()), nodes(view.nodes.begin(), view.nodes.end()),
          border(view.border.begin(), view.border.end()), references(view.references), corners(view.corners),
          face_numbers(view.face_numbers) {}

    void widen() {
        references.widen();
        corners.widen();
        face_numbers.widen();
    }

    /// A map over copies of the arrays, whether or not they make sense.
    ExactMap map() const {
        const auto storage = std::make_shared<const ExactMapParts>(*this);
        ExactMapView all = view;
        all.band_offsets = storage->band_offsets;
        all.outer_limits = storage->outer_limits;
        all.bands = storage->bands;
        all.winding_below = storage->winding_below;
        all.references = storage->references.view();
        all.reference_parts = storage->reference_parts;
        all.vertices = storage->vertices;
        all.corners = storage->corners.view();
        all.face_numbers = storage->face_numbers.view();
        all.nodes = storage->nodes;
        all.border = storage->border;
        all.winding_tree = nullptr; // made anew
        return {all, statistics, source_hash, storage};
    }
};

} // namespace echinus::test

namespace {

/// 80 faces in 10 leaves: there are two nodes below the root.
ExactMapParts torus_parts() {
    return ExactMapParts(ExactMap::build(make_torus(1, 0.4, 8, 5), {.divisions = 1}));
}

/// All indices in 32 bits.
ExactMapParts wide_box_parts() {
    ExactMapParts parts(ExactMap::build(make_box({2, 3, 4}), {.divisions = 1}));
    parts.widen();
    return parts;
}

/// A box without one face, so that it has gaps in which the answer is uncertain.
ExactMapParts open_box_parts() {
    TriangleMesh box = make_box({2, 3, 4});
    box.faces.pop_back();
    return ExactMapParts(ExactMap::build(box, {.divisions = 1, .rule = InsideRule::Parity}));
}

/// With an origin, and so in version 2.
ExactMapParts far_box_parts() {
    TriangleMesh box = make_box({2, 3, 4});
    box.origin = {448262, 5411932, 112};
    return ExactMapParts(ExactMap::build(box, {.divisions = 1}));
}

std::vector<ExactMapParts> samples() {
    return {torus_parts(), wide_box_parts(), open_box_parts(), far_box_parts()};
}

ExactMap load_bytes(const std::vector<std::byte>& bytes) {
    return std::get<ExactMap>(load_map(bytes, nullptr, "m"));
}

template <typename T>
bool same_bits(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

bool same_bits(const IndexArray& a, const IndexArray& b) {
    return same_bits(a.narrow, b.narrow) && same_bits(a.wide, b.wide);
}

void expect_same_map(const ExactMap& a, const ExactMap& b) {
    EXPECT_EQ(a.view().centre, b.view().centre);
    EXPECT_EQ(a.view().origin, b.view().origin);
    EXPECT_EQ(a.view().radius, b.view().radius);
    EXPECT_EQ(a.view().divisions, b.view().divisions);
    EXPECT_EQ(a.view().rule, b.view().rule);
    EXPECT_TRUE(same_bits(a.view().band_offsets, b.view().band_offsets));
    EXPECT_TRUE(same_bits(a.view().bands, b.view().bands));
    EXPECT_TRUE(same_bits(a.view().winding_below, b.view().winding_below));
    EXPECT_TRUE(same_bits(a.view().references, b.view().references));
    EXPECT_TRUE(same_bits(a.view().reference_parts, b.view().reference_parts));
    EXPECT_TRUE(same_bits(a.view().vertices, b.view().vertices));
    EXPECT_TRUE(same_bits(a.view().corners, b.view().corners));
    EXPECT_TRUE(same_bits(a.view().face_numbers, b.view().face_numbers));
    EXPECT_TRUE(same_bits(a.view().nodes, b.view().nodes));
    EXPECT_TRUE(same_bits(a.view().border, b.view().border));
    EXPECT_EQ(std::memcmp(&a.statistics(), &b.statistics(), sizeof(ExactMapStatistics)), 0);
    EXPECT_EQ(a.source_hash(), b.source_hash());
}

void mark_as_none(TreeNode& node, std::size_t k) {
    node.children[k] = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.low[axis][k] = 32767;
        node.high[axis][k] = -32768;
    }
}

using ExactMapFileOnDisk = TemporaryFolderTest;

/// The attacks that take seconds, one sample each, so that they can run side by side.
class ExactMapFileAttack : public testing::TestWithParam<std::size_t> {
  protected:
    ExactMap map() const { return samples()[GetParam()].map(); }
};

} // namespace

TEST(ExactMapFile, IsReadBackAtEveryResolutionOfCrowdedMeshes) {
    for (const TriangleMesh& mesh : {make_fins(60), make_comb(100)})
        for (std::uint32_t divisions = 1; divisions <= 24; ++divisions) {
            const ExactMap map = ExactMap::build(mesh, {.divisions = divisions});
            EXPECT_NO_THROW(load_bytes(serialise(map))) << divisions << " divisions";
        }
    for (const TriangleMesh& mesh : {make_fins(600), make_comb(1500)})
        EXPECT_NO_THROW(load_bytes(serialise(ExactMap::build(mesh))));
}

TEST(ExactMapFile, IsReadBackOfShapesWithFacesInPlanesThroughTheirCentre) {
    for (const TriangleMesh& mesh : {make_two_wedges(), make_four_wedges(), make_open_mouth()})
        for (std::uint32_t divisions = 1; divisions <= 24; ++divisions) {
            const ExactMap map = ExactMap::build(mesh, {.divisions = divisions});
            EXPECT_NO_THROW(load_bytes(serialise(map))) << divisions << " divisions";
        }
}

TEST(ExactMapFile, ReadsBackEveryBit) {
    for (ExactMapParts parts : samples()) {
        parts.source_hash = 0x0123'4567'89ab'cdef;
        parts.statistics.certain_share = 0.75F;
        parts.statistics.uncertain_directions = 0.125F;
        expect_same_map(parts.map(), load_bytes(serialise(parts.map())));
    }
}

TEST(ExactMapFile, GivesTheSameBytesForTheSameMap) {
    for (const ExactMapParts& parts : samples()) {
        const auto once = serialise(parts.map());
        EXPECT_EQ(serialise(parts.map()), once);
        EXPECT_EQ(serialise(load_bytes(once)), once);
    }
}

TEST(ExactMapFile, IsReadInPlace) {
    for (const ExactMapParts& parts : samples()) {
        const auto bytes = serialise(parts.map());
        const ExactMap map = load_bytes(bytes);
        const auto lies_within = [&](const void* address) {
            return address >= bytes.data() && address < bytes.data() + bytes.size();
        };
        EXPECT_TRUE(lies_within(map.view().bands.data()));
        EXPECT_TRUE(lies_within(map.view().nodes.data()));
        EXPECT_TRUE(lies_within(map.view().vertices.data()));
    }
}

INSTANTIATE_TEST_SUITE_P(Samples, ExactMapFileAttack, testing::Range(std::size_t{0}, samples().size()));

TEST_P(ExactMapFileAttack, RefusesEveryTruncation) {
    const auto bytes = serialise(map());
    ASSERT_TRUE(attack_map_file(bytes));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_FALSE(attack_map_file({bytes.data(), size})) << size << " of " << bytes.size() << " bytes";
    }
}

TEST_P(ExactMapFileAttack, WithstandsChangesOfEveryByte) {
    auto bytes = serialise(map(), {.build_milliseconds = 1.5});
    constexpr int kFlips[3][2] = {{0x01, 0xff}, {0x08, 0x80}, {0x80, 0xff}}; // by turn, for time
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const std::byte original = bytes[i];
        for (const int flip : kFlips[i % 3]) {
            bytes[i] = original ^ std::byte(flip);
            EXPECT_NO_THROW(attack_map_file(bytes)) << "byte " << i << " ^ " << flip;
        }
        bytes[i] = original;
    }
}

TEST(ExactMapFile, NamesWhatContradictsTheMeaning) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    using Parts = ExactMapParts;
    struct Case {
        const char* words;
        std::function<void(Parts&)> spoil;
    };
    const Case cases[] = {
        {"centre is not finite", [&](Parts& p) { p.view.centre.y = kNan; }},
        {"radius", [&](Parts& p) { p.view.radius = kNan; }},
        {"radius", [&](Parts& p) { p.view.radius = 1e-16F; }},
        {"radius", [&](Parts& p) { p.view.radius = 1e16F; }},
        {"divisions is 0 and not within 1 to 512", [&](Parts& p) { p.view.divisions = 0; }},
        {"divisions is 513", [&](Parts& p) { p.view.divisions = 513; }},
        {"band_offsets has 9 elements and not 73", [&](Parts& p) { p.view.divisions = 3; }},
        {"inside_rule has the unknown value 2", [&](Parts& p) { p.view.rule = InsideRule(2); }},
        {"vertices[3] lies beyond the lattice", [&](Parts& p) { p.vertices[3].x = 524289; }},
        {"vertices[3] lies beyond the lattice", [&](Parts& p) { p.vertices[3].z = INT32_MIN; }},
        {"face_numbers16[2] is 80 and not below 80", [&](Parts& p) { p.face_numbers.narrow[2] = 80; }},
        {"face_numbers32[2] is 2147483648 and not below 2147483648",
         [&](Parts& p) {
             p.face_numbers.widen();
             p.face_numbers.wide[2] = 0x8000'0000;
             p.statistics.face_count = 0xffff'ffff;
         }},
        {"it has no faces", [&](Parts& p) { p.face_numbers.narrow.clear(); }},
        {"corners has 239 elements and not 240", [&](Parts& p) { p.corners.narrow.pop_back(); }},
        {"corners16[5] is 40 and not below 40", [&](Parts& p) { p.corners.narrow[5] = 40; }},
        {"references16 and references32 both", [&](Parts& p) { p.references.wide.push_back(1); }},
        {"dropped_faces is", [&](Parts& p) { p.corners.narrow[4] = p.corners.narrow[3]; }},
        {"border[0] names a vertex",
         [&](Parts& p) {
             p.border = {{0, 40, 1}};
         }},
        {"border[0] is not an edge",
         [&](Parts& p) {
             p.border = {{0, 1, 0}};
         }},
        {"border[0] is not an edge",
         [&](Parts& p) {
             p.border = {{1, 1, 1}};
         }},
        {"bands has no elements", [&](Parts& p) { p.bands.clear(); }},
        {"band_offsets has 8 elements", [&](Parts& p) { p.band_offsets.pop_back(); }},
        {"band_offsets[0] is not 0", [&](Parts& p) { p.band_offsets[0] = 1; }},
        {"band_offsets[3] is smaller", [&](Parts& p) { p.band_offsets[2] = p.band_offsets[3] + 1; }},
        {"bands has", [&](Parts& p) { p.bands.push_back(p.bands.back()); }},
        {"winding_below has", [&](Parts& p) { p.winding_below.pop_back(); }},
        {"references16[7] is 80 and not below 80", [&](Parts& p) { p.references.narrow[7] = 80; }},
        {"reference_parts has", [&](Parts& p) { p.reference_parts.pop_back(); }},
        {"references has", [&](Parts& p) { p.bands.back().first_reference += 1; }},
        {"bands[0] does not begin", [&](Parts& p) { p.bands[0].first_reference = 1; }},
        {"bands[2] does not begin",
         [&](Parts& p) { p.bands[1].first_reference = p.bands[2].first_reference + 1; }},
        {"bands[0] overlaps", [&](Parts& p) { p.bands[0].lower = 65535; }},
        {"bands[0] overlaps", [&](Parts& p) { p.bands[0].upper = p.bands[0].lower - 1; }},
        {"bands[1] overlaps", [&](Parts& p) { p.band_offsets[1] = p.band_offsets[2]; }},
        {"winding_below[0] makes its band", [&](Parts& p) { p.winding_below[0] = ExactMapView::kSplit; }},
        {"winding_below[4] is uncertain", [&](Parts& p) { p.winding_below[4] = ExactMapView::kUncertain; }},
        {"nodes has no elements", [&](Parts& p) { p.nodes.clear(); }},
        {"is not a child of an earlier one", [&](Parts& p) { p.nodes.push_back(p.nodes.back()); }},
        {"the tree misses leaf", [&](Parts& p) { mark_as_none(p.nodes[1], 3); }},
        {"neither a child nor the marker for no child", [&](Parts& p) { p.nodes[0].low[0][0] = 32767; }},
        {"neither a child nor the marker for no child", [&](Parts& p) { p.nodes[0].children[7] = 1; }},
        {"not a later node", [&](Parts& p) { p.nodes[0].children[0] = 0; }},
        {"not a later node", [&](Parts& p) { p.nodes[0].children[0] = 99; }},
        {"not a leaf that has no parent yet",
         [&](Parts& p) { p.nodes[1].children[0] = TreeNode::kLeaf + 10; }},
        {"not a leaf that has no parent yet",
         [&](Parts& p) { p.nodes[1].children[1] = p.nodes[1].children[0]; }},
        {"does not hold its faces", [&](Parts& p) { ++p.nodes[1].low[2][0]; }},
        {"does not hold those of its children", [&](Parts& p) { --p.nodes[0].high[1][0]; }},
        {"face_count is 81 and not 80", [&](Parts& p) { ++p.statistics.face_count; }},
        {"longest_list is 0 and not", [&](Parts& p) { p.statistics.longest_list = 0; }},
        {"mean_list", [&](Parts& p) { p.statistics.mean_list = kNan; }},
        {"expected_tests", [&](Parts& p) { p.statistics.expected_tests = -1; }},
        {"certain_share", [&](Parts& p) { p.statistics.certain_share = 1.5F; }},
        {"uncertain_directions", [&](Parts& p) { p.statistics.uncertain_directions = kNan; }},
    };
    for (const Case& spoilt : cases) {
        ExactMapParts parts = torus_parts();
        spoilt.spoil(parts);
        const ExactMap map = parts.map();
        const auto bytes = serialise(map);
        expect_error(ErrorCode::Damaged, spoilt.words, [&] { load_bytes(bytes); });
        expect_error(ErrorCode::Damaged, "echinus build", [&] { load_bytes(bytes); });
        // A build that made it would not hand it out.
        const auto prove = [&] { proven(map.view(), map.statistics(), 0, nullptr); };
        expect_error(ErrorCode::Damaged, spoilt.words, prove);
        expect_error(ErrorCode::Damaged, "bug in Echinus", prove);
    }
}

TEST(ExactMapFile, HoldsWhatIsCertainOfAnOpenSurface) {
    const ExactMap map = open_box_parts().map();
    ASSERT_FALSE(map.view().border.empty());
    const std::vector<std::byte> bytes = serialise(map); // read in place
    const ExactMap loaded = load_bytes(bytes);
    for (const Vec3f& point : telling_points(map.view())) {
        EXPECT_EQ(classify(loaded, point).inside, classify(map, point).inside);
        EXPECT_EQ(classify(loaded, point).certain, classify(map, point).certain);
    }
}

TEST(ExactMapFile, RefusesATreeDeeperThanAQuerysStack) {
    ExactMapParts parts(ExactMap::build(make_box({2, 3, 4}), {.divisions = 1})); // two leaves
    const auto chain = [&](std::size_t length) {
        ExactMapParts deep = parts;
        TreeNode link = parts.nodes[0];
        for (std::size_t k = 1; k < TreeNode::kWidth; ++k) mark_as_none(link, k);
        for (std::size_t axis = 0; axis < 3; ++axis) link.low[axis][0] = -32768;
        for (std::size_t axis = 0; axis < 3; ++axis) link.high[axis][0] = 32767;
        deep.nodes.clear();
        for (std::uint32_t i = 1; i < length; ++i) {
            link.children[0] = i;
            deep.nodes.push_back(link);
        }
        deep.nodes.push_back(parts.nodes[0]);
        return serialise(deep.map());
    };
    EXPECT_TRUE(attack_map_file(chain(12)));
    expect_error(ErrorCode::Damaged, "lies deeper than 12", [&] { load_bytes(chain(13)); });
}

TEST_F(ExactMapFileOnDisk, IsLoadedAsTheKindThatItIs) {
    const ExactMap exact = torus_parts().map();
    const DistanceMap distance =
        DistanceMap::build(make_box({1, 1, 1}), {.longitude_count = 8, .colatitude_count = 6});
    save(exact, path("exact.ech"));
    save(distance, path("distance.ech"));
    expect_same_map(load_exact_map(path("exact.ech")), exact);
    EXPECT_TRUE(std::holds_alternative<ExactMap>(load_map(path("exact.ech"))));
    EXPECT_TRUE(std::holds_alternative<DistanceMap>(load_map(path("distance.ech"))));
    expect_error(ErrorCode::WrongFormat, "the map is of the kind exact and not distance",
                 [&] { load_distance_map(path("exact.ech")); });
    expect_error(ErrorCode::WrongFormat, "echinus build --kind exact",
                 [&] { load_exact_map(path("distance.ech")); });
}
