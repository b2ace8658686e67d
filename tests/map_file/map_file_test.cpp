#include "distance_map/layout.hpp"
#include "support/distance_maps.hpp"
#include "support/expectations.hpp"
#include "support/map_file_attack.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>
#include <echinus/map_file.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <type_traits>
#include <utility>

using namespace echinus;
using namespace echinus::test;
namespace fs = std::filesystem;

namespace {

constexpr EntryFormat kFormats[] = {EntryFormat::Float32, EntryFormat::Unorm16};

DistanceMap load_distance_bytes(const std::vector<std::byte>& bytes) {
    return std::get<DistanceMap>(load_map(bytes, nullptr, "m"));
}

/// Bit for bit: floats are compared as bytes, so -0 differs from 0.
template <typename T>
bool same_entries(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

void expect_same_distance_map(const DistanceMap& a, const DistanceMap& b) {
    EXPECT_EQ(a.view().centre, b.view().centre);
    EXPECT_EQ(a.view().origin, b.view().origin);
    EXPECT_EQ(a.view().radius, b.view().radius);
    EXPECT_EQ(a.view().grid, b.view().grid);
    EXPECT_EQ(a.view().divisions, b.view().divisions);
    EXPECT_EQ(a.view().longitude_count, b.view().longitude_count);
    EXPECT_EQ(a.view().colatitude_count, b.view().colatitude_count);
    EXPECT_EQ(a.view().pole_axis, b.view().pole_axis);
    EXPECT_EQ(a.view().scale, b.view().scale);
    EXPECT_EQ(a.view().entry_format, b.view().entry_format);
    EXPECT_EQ(a.view().correction, b.view().correction);
    EXPECT_EQ(a.view().centre_inside, b.view().centre_inside);
    EXPECT_TRUE(same_entries(a.view().entry_offsets, b.view().entry_offsets));
    EXPECT_TRUE(same_entries(a.view().entries_float32, b.view().entries_float32));
    EXPECT_TRUE(same_entries(a.view().entries_unorm16, b.view().entries_unorm16));
    EXPECT_EQ(a.statistics().face_count, b.statistics().face_count);
    EXPECT_EQ(a.statistics().dropped_faces, b.statistics().dropped_faces);
    EXPECT_EQ(a.statistics().max_entries, b.statistics().max_entries);
    EXPECT_EQ(a.statistics().corrected_entries, b.statistics().corrected_entries);
    EXPECT_EQ(a.statistics().clamped_entries, b.statistics().clamped_entries);
    EXPECT_EQ(a.statistics().wrong_parity_share, b.statistics().wrong_parity_share);
    EXPECT_EQ(a.source_hash(), b.source_hash());
}

std::uint32_t read_word(const std::vector<std::byte>& bytes, std::size_t position, std::size_t byte_count) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < byte_count; ++i)
        word |= std::to_integer<std::uint32_t>(bytes[position + i]) << 8 * i;
    return word;
}

/// Where a field of the root table lies, found as docs/file_format.md describes it.
std::size_t root_field_position(const std::vector<std::byte>& bytes, std::size_t field) {
    const std::size_t table = read_word(bytes, 0, 4);
    const std::size_t vtable = table - read_word(bytes, table, 4);
    return table + read_word(bytes, vtable + 4 + 2 * field, 2);
}

using MapFileOnDisk = TemporaryFolderTest;

} // namespace

TEST(MapView, IsOfANamedMapAndNeverOfATemporaryOne) {
    const auto check = []<typename Map, typename View>(const Map*, const View*) {
        static_assert(std::is_convertible_v<const Map&, const View&>);
        static_assert(std::is_convertible_v<const Map&, View>);
        static_assert(requires(const Map& map) { map.view(); });
        static_assert(!std::is_convertible_v<Map, const View&>);
        static_assert(!std::is_convertible_v<const Map, View>);
        static_assert(!std::is_constructible_v<View, Map>);
        static_assert(!requires(Map && map) { std::move(map).view(); });
        static_assert(!requires(const Map&& map) { std::move(map).view(); });
    };
    check(static_cast<const ExactMap*>(nullptr), static_cast<const ExactMapView*>(nullptr));
    check(static_cast<const DistanceMap*>(nullptr), static_cast<const DistanceMapView*>(nullptr));
}

TEST(MapFile, ReadsBackEveryBit) {
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
        for (const EntryFormat format : kFormats) {
            const DistanceMap map = random_map_parts(format, 4 + seed % 7, 4 + seed % 5, seed).map();
            expect_same_distance_map(map, load_distance_bytes(serialise(map)));
        }
    }
}

TEST(MapFile, ReadsBackAMapWithoutEntries) {
    for (const EntryFormat format : kFormats) {
        MapParts parts = random_map_parts(format, 4, 4, 0);
        parts.entry_offsets.assign(17, 0);
        parts.entries_float32.clear();
        parts.entries_unorm16.clear();
        parts.statistics.max_entries = 0;
        expect_same_distance_map(parts.map(), load_distance_bytes(serialise(parts.map())));
    }
}

TEST(MapFile, GivesTheSameBytesForTheSameMap) {
    const MapParts parts = random_map_parts(EntryFormat::Float32, 8, 6, 1);
    EXPECT_EQ(serialise(parts.map()), serialise(parts.map()));
    const auto once = serialise(parts.map());
    EXPECT_EQ(serialise(load_distance_bytes(once)), once);
}

TEST(MapFile, IsReadInPlace) {
    for (const EntryFormat format : kFormats) {
        const auto bytes = serialise(random_map_parts(format, 8, 6, 2).map());
        const DistanceMap map = load_distance_bytes(bytes);
        const auto lies_within = [&](const void* address) {
            return address >= bytes.data() && address < bytes.data() + bytes.size();
        };
        EXPECT_TRUE(lies_within(map.view().entry_offsets.data()));
        EXPECT_TRUE(format == EntryFormat::Float32 ? lies_within(map.view().entries_float32.data())
                                                   : lies_within(map.view().entries_unorm16.data()));
    }
}

TEST(MapFile, RefusesEveryTruncation) {
    for (const EntryFormat format : kFormats) {
        const auto bytes = serialise(random_map_parts(format, 8, 6, 3).map());
        ASSERT_TRUE(attack_map_file(bytes));
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            EXPECT_FALSE(attack_map_file({bytes.data(), size})) << size << " of " << bytes.size() << " bytes";
        }
    }
}

TEST(MapFile, IgnoresBytesBehindTheMap) {
    auto bytes = serialise(random_map_parts(EntryFormat::Float32, 8, 6, 3).map());
    bytes.resize(bytes.size() + 5, std::byte{0xff});
    EXPECT_TRUE(attack_map_file(bytes));
}

TEST(MapFile, WithstandsChangesOfEveryByte) {
    for (const EntryFormat format : kFormats) {
        auto bytes = serialise(random_map_parts(format, 5, 4, 4).map(), {.build_milliseconds = 1.5});
        for (auto& byte : bytes) {
            const std::byte original = byte;
            for (const int flip : {0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x40, 0x80, 0x03, 0x7f, 0xff}) {
                byte = original ^ std::byte(flip);
                EXPECT_NO_THROW(attack_map_file(bytes)) << "byte " << &byte - bytes.data() << " ^ " << flip;
            }
            byte = original;
        }
    }
}

TEST(MapFile, ReadsBackEveryBitOnEveryGrid) {
    for (const DirectionGrid grid : kEveryGrid)
        for (const EntryFormat format : kFormats) {
            const DistanceMap map = random_map_parts(format, grid, 5, 3).map();
            expect_same_distance_map(map, load_distance_bytes(serialise(map)));
        }
}

TEST(MapFile, WithstandsChangesOfEveryByteOnEveryGrid) {
    for (const DirectionGrid grid : kEveryGrid) {
        const EntryFormat format = has_poles(grid) ? EntryFormat::Float32 : EntryFormat::Unorm16;
        auto bytes = serialise(random_map_parts(format, grid, 4, 4).map());
        for (auto& byte : bytes) {
            const std::byte original = byte;
            for (const int flip : {0x01, 0x04, 0x40, 0x80, 0xff}) {
                byte = original ^ std::byte(flip);
                EXPECT_NO_THROW(attack_map_file(bytes))
                    << name_of(grid) << " byte " << &byte - bytes.data() << " ^ " << flip;
            }
            byte = original;
        }
    }
}

TEST(MapFile, NamesWhatContradictsTheMeaningOfAnEllipsoid) {
    const auto expect_damaged = [](const char* words, const std::function<void(MapParts&)>& spoil) {
        MapParts parts = random_map_parts(EntryFormat::Float32, DirectionGrid::Ellipsoidal, 5, 6);
        spoil(parts);
        expect_error(ErrorCode::Damaged, words, [&] { load_distance_bytes(serialise(parts.map())); });
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    expect_damaged("scale is 1.5", [](MapParts& p) { p.view.scale.y = 1.5F; });
    expect_damaged("scale is 0.0", [](MapParts& p) { p.view.scale.z = 0.0156F; });
    expect_damaged("scale is -1", [](MapParts& p) { p.view.scale.x = -1; });
    expect_damaged("scale is nan", [&](MapParts& p) { p.view.scale.x = kNan; });
    expect_damaged("radius is", [](MapParts& p) { p.view.radius = 1e-40F; });
    expect_damaged("divisions is 7 and not 0", [](MapParts& p) { p.view.divisions = 7; });
    expect_damaged("colatitude_count is 3", [](MapParts& p) { p.view.colatitude_count = 3; });
    expect_damaged("entries_float32[9]",
                   [](MapParts& p) { p.entries_float32[9] = p.view.largest_entry() * 1.0001F; });
}

TEST(MapFile, NamesWhatContradictsTheMeaningOfACube) {
    const auto expect_damaged = [](const char* words, const std::function<void(MapParts&)>& spoil) {
        MapParts parts = random_map_parts(EntryFormat::Float32, DirectionGrid::Cube, 5, 6);
        spoil(parts);
        expect_error(ErrorCode::Damaged, words, [&] { load_distance_bytes(serialise(parts.map())); });
    };
    expect_damaged("longitude_count is 7 and not 0", [](MapParts& p) { p.view.longitude_count = 7; });
    expect_damaged("divisions is 4097", [](MapParts& p) { p.view.divisions = 4097; });
    expect_damaged("entry_offsets has 217 elements and not 295", [](MapParts& p) { p.view.divisions = 6; });
    expect_damaged("entry_offsets has 217 elements and not 122",
                   [](MapParts& p) { p.view.grid = DirectionGrid::Octahedral; });
    expect_damaged("entries_float32[9]",
                   [](MapParts& p) { p.entries_float32[9] = p.view.largest_entry() * 1.0001F; });
}

TEST(MapFile, NamesWhatContradictsTheMeaningOfAnOctahedralMap) {
    struct Case {
        const char* words;
        std::function<void(MapParts&)> spoil;
    };
    const Case cases[] = {
        {"grid has the unknown value 4", [](MapParts& p) { p.view.grid = DirectionGrid(4); }},
        {"longitude_count is 0", [](MapParts& p) { p.view.grid = DirectionGrid::Spherical; }},
        {"longitude_count is 7 and not 0", [](MapParts& p) { p.view.longitude_count = 7; }},
        {"colatitude_count is 7 and not 0", [](MapParts& p) { p.view.colatitude_count = 7; }},
        {"divisions is 3 and not within 4 to 4096", [](MapParts& p) { p.view.divisions = 3; }},
        {"divisions is 4097", [](MapParts& p) { p.view.divisions = 4097; }},
        {"radius is", [](MapParts& p) { p.view.radius = 1e-40F; }},
        {"entry_offsets has 122 elements and not 170", [](MapParts& p) { p.view.divisions = 6; }},
        {"entries_float32[9]", [](MapParts& p) { p.entries_float32[9] = p.view.largest_entry() * 1.0001F; }},
    };
    for (const Case& wrong : cases) {
        MapParts parts = random_map_parts(EntryFormat::Float32, DirectionGrid::Octahedral, 5, 6);
        wrong.spoil(parts);
        expect_error(ErrorCode::Damaged, wrong.words, [&] { load_distance_bytes(serialise(parts.map())); });
    }
}

TEST(MapFile, NamesWhatContradictsTheMeaning) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    struct Case {
        const char* words;
        std::function<void(MapParts&)> spoil;
    };
    const Case cases[] = {
        {"centre is not finite", [&](MapParts& p) { p.view.centre.y = kNan; }},
        {"radius", [&](MapParts& p) { p.view.radius = kInfinity; }},
        {"radius", [&](MapParts& p) { p.view.radius = kNan; }},
        {"radius", [&](MapParts& p) { p.view.radius = 0; }},
        {"radius", [&](MapParts& p) { p.view.radius = -1; }},
        {"longitude_count is 3 and not within 4 to 8192", [&](MapParts& p) { p.view.longitude_count = 3; }},
        {"colatitude_count is 8193", [&](MapParts& p) { p.view.colatitude_count = 8193; }},
        {"longitude_count is 4294967295", [&](MapParts& p) { p.view.longitude_count = 0xffffffff; }},
        {"pole_axis has the unknown value 3", [&](MapParts& p) { p.view.pole_axis = PoleAxis(3); }},
        {"entry_format has the unknown value 2", [&](MapParts& p) { p.view.entry_format = EntryFormat(2); }},
        {"vertex_correction has the unknown value 255",
         [&](MapParts& p) { p.view.correction = VertexCorrection(255); }},
        {"entry_offsets has 50 elements and not 49", [&](MapParts& p) { p.entry_offsets.push_back(999); }},
        {"entry_offsets has 48 elements", [&](MapParts& p) { p.entry_offsets.pop_back(); }},
        {"entry_offsets[0] is not 0", [&](MapParts& p) { p.entry_offsets[0] = 1; }},
        {"entry_offsets[8] is smaller", [&](MapParts& p) { p.entry_offsets[7] = p.entry_offsets[8] + 1; }},
        {"entries_float32 has", [&](MapParts& p) { p.entry_offsets.back() += 1; }},
        {"entries_float32 has", [&](MapParts& p) { p.entries_float32.pop_back(); }},
        {"entries_float32 has 0 elements", [&](MapParts& p) { p.entries_float32.clear(); }},
        {"entries_unorm16 has 1 elements and not 0", [&](MapParts& p) { p.entries_unorm16.push_back(7); }},
        {"entries_float32 has", [&](MapParts& p) { p.view.entry_format = EntryFormat::Unorm16; }},
        {"entries_float32[9] is nan", [&](MapParts& p) { p.entries_float32[9] = kNan; }},
        {"entries_float32[9] is inf", [&](MapParts& p) { p.entries_float32[9] = kInfinity; }},
        {"entries_float32[9]", [&](MapParts& p) { p.entries_float32[9] = p.view.radius * 1.0001F; }},
        {"entries_float32[0]", [&](MapParts& p) { p.entries_float32[0] = -0.0001F; }},
        {"max_entries is 3 and not 4", [&](MapParts& p) { p.statistics.max_entries = 3; }},
        {"wrong_parity_share", [&](MapParts& p) { p.statistics.wrong_parity_share = 1.5F; }},
        {"wrong_parity_share", [&](MapParts& p) { p.statistics.wrong_parity_share = kNan; }},
    };
    for (const Case& spoilt : cases) {
        MapParts parts = random_map_parts(EntryFormat::Float32, 8, 6, 5);
        spoilt.spoil(parts);
        const DistanceMap map = parts.map();
        const auto bytes = serialise(map);
        expect_error(ErrorCode::Damaged, spoilt.words, [&] { load_distance_bytes(bytes); });
        expect_error(ErrorCode::Damaged, "echinus build", [&] { load_distance_bytes(bytes); });
        // A build that made it would not hand it out.
        const auto prove = [&] { proven(map.view(), map.statistics(), 0, nullptr); };
        expect_error(ErrorCode::Damaged, spoilt.words, prove);
        expect_error(ErrorCode::Damaged, "bug in Echinus", prove);
    }
}

TEST(MapFile, RefusesEntriesOfADirectionThatDescend) {
    for (const EntryFormat format : kFormats) {
        MapParts parts = random_map_parts(format, 8, 6, 6);
        const auto two_entries =
            std::adjacent_find(parts.entry_offsets.begin(), parts.entry_offsets.end(),
                               [](std::uint32_t a, std::uint32_t b) { return b - a == 2; });
        ASSERT_NE(two_entries, parts.entry_offsets.end());
        const std::uint32_t first = *two_entries;
        if (format == EntryFormat::Float32) {
            std::swap(parts.entries_float32[first], parts.entries_float32[first + 1]);
        } else {
            std::swap(parts.entries_unorm16[first], parts.entries_unorm16[first + 1]);
        }
        expect_error(ErrorCode::Damaged, "[" + std::to_string(first + 1) + "]",
                     [&] { load_distance_bytes(serialise(parts.map())); });
    }
}

TEST(MapFile, RefusesAnotherVersionBeforeItLooksFurther) {
    auto bytes = serialise(random_map_parts(EntryFormat::Float32, 8, 6, 7).map());
    constexpr std::size_t kVersionField = 0;
    bytes[root_field_position(bytes, kVersionField)] = std::byte{9};
    expect_error(ErrorCode::UnsupportedVersion, "version 9", [&] { load_distance_bytes(bytes); });
    // A later version may change anything else, here the place of the map.
    constexpr std::size_t kMapField = 3;
    bytes[root_field_position(bytes, kMapField) + 3] = std::byte{0xff};
    expect_error(ErrorCode::UnsupportedVersion, "version 9", [&] { load_distance_bytes(bytes); });
}

TEST(MapFile, HasVersion2WhereAReaderThatKnowsNoOriginsWouldMisplaceTheMap) {
    constexpr std::size_t kVersionField = 0;
    TriangleMesh mesh = make_box({2, 3, 4});
    const auto check = [&]<typename Map>(const Map*, const auto& options) {
        mesh.origin = {};
        auto without = serialise(Map::build(mesh, options));
        mesh.origin = {448262, 5411932, 112};
        auto with = serialise(Map::build(mesh, options));
        std::byte& version_without = without[root_field_position(without, kVersionField)];
        std::byte& version_with = with[root_field_position(with, kVersionField)];
        EXPECT_EQ(version_without, std::byte{1});
        EXPECT_EQ(version_with, std::byte{2});
        const AnyMap near = load_map(without, nullptr, "m"), far = load_map(with, nullptr, "m");
        EXPECT_EQ(std::get<Map>(near).view().origin, Vec3d{});
        EXPECT_EQ(std::get<Map>(far).view().origin, mesh.origin);

        std::swap(version_without, version_with);
        expect_error(ErrorCode::Damaged, "its version does not have", [&] { load_map(with, nullptr, "m"); });
        expect_error(ErrorCode::Damaged, "its origin is missing, 0 or not finite",
                     [&] { load_map(without, nullptr, "m"); });
    };
    check(static_cast<const ExactMap*>(nullptr), ExactMapOptions{.divisions = 1});
    check(static_cast<const DistanceMap*>(nullptr),
          DistanceMapOptions{.longitude_count = 8, .colatitude_count = 6});
}

TEST(MapFile, RefusesAnUnknownKindOfMap) {
    auto bytes = serialise(random_map_parts(EntryFormat::Float32, 8, 6, 8).map());
    constexpr std::size_t kMapTypeField = 2;
    bytes[root_field_position(bytes, kMapTypeField)] = std::byte{77};
    expect_error(ErrorCode::UnsupportedVersion, "unknown kind 77", [&] { load_distance_bytes(bytes); });
    bytes[root_field_position(bytes, kMapTypeField)] = std::byte{0};
    expect_error(ErrorCode::Damaged, "holds no map", [&] { load_distance_bytes(bytes); });
}

TEST_F(MapFileOnDisk, KeepsTheMapAliveWhenTheFileIsReplacedOrRemoved) {
    const DistanceMap map = random_map_parts(EntryFormat::Float32, 8, 6, 9).map();
    const DistanceMap other = random_map_parts(EntryFormat::Unorm16, 6, 8, 10).map();
    const fs::path file = path("map.ech");
    save(map, file);
    const DistanceMap loaded = load_distance_map(file);
    save(other, file);
    expect_same_distance_map(load_distance_map(file), other);
    fs::remove(file);
    expect_same_distance_map(loaded, map);
}

TEST_F(MapFileOnDisk, CarriesNotesBesideTheMap) {
    const DistanceMap map = random_map_parts(EntryFormat::Float32, 8, 6, 11).map();
    save(map, path("plain.ech"));
    save(map, path("noted.ech"), {.build_milliseconds = 12.25});
    EXPECT_EQ(load_map_file_notes(path("plain.ech")).build_milliseconds, std::nullopt);
    EXPECT_EQ(load_map_file_notes(path("noted.ech")).build_milliseconds, 12.25);
    expect_same_distance_map(load_distance_map(path("noted.ech")), map);
}

TEST_F(MapFileOnDisk, RefusesNotesThatAreNoDuration) {
    const DistanceMap map = random_map_parts(EntryFormat::Float32, 8, 6, 11).map();
    for (const double milliseconds : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
        save(map, path("noted.ech"), {.build_milliseconds = milliseconds});
        expect_error(ErrorCode::Damaged, "build_milliseconds",
                     [&] { load_map_file_notes(path("noted.ech")); });
    }
}

TEST_F(MapFileOnDisk, RefusesWhatIsNoMapFileByName) {
    const fs::path missing = path("missing.ech");
    expect_error(ErrorCode::Unreadable, missing.string(), [&] { load_distance_map(missing); });
    expect_error(ErrorCode::Unreadable, path("").string(), [&] { load_distance_map(path("")); });
    for (const char* content : {"", "ECHM", "not a map at all", "v 0 0 0\nv 1 0 0\nf 1 2 3\n"}) {
        const fs::path wrong = write("wrong.ech", content);
        expect_error(ErrorCode::WrongFormat, wrong.string(), [&] { load_distance_map(wrong); });
        expect_error(ErrorCode::WrongFormat, wrong.string(), [&] { load_map_file_notes(wrong); });
        EXPECT_FALSE(is_map_file(wrong));
    }
    EXPECT_FALSE(is_map_file(missing));
    EXPECT_FALSE(is_map_file(path("")));
}

TEST_F(MapFileOnDisk, RecognisesAMapFileByItsFirstBytes) {
    save(random_map_parts(EntryFormat::Float32, 8, 6, 12).map(), path("any.name"));
    EXPECT_TRUE(is_map_file(path("any.name")));
}

TEST_F(MapFileOnDisk, ReportsAFullDisk) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
    const DistanceMap map = random_map_parts(EntryFormat::Float32, 8, 6, 13).map();
    expect_error(ErrorCode::Unwritable, "/dev/full", [&] { save(map, "/dev/full"); });
}
