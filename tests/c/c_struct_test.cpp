#include "handles.hpp"

#include <echinus/map_file.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

using namespace echinus;
using namespace echinus::test;

namespace {

/// The options of a program that was compiled with a newer header.
struct NewerOptions {
    echinus_exact_map_options known;
    std::uint32_t unknown = 0;
    std::uint32_t also_unknown = 0;
};

TEST(CStructs, OfANewerHeaderAreTakenIfTheySetNothingNew) {
    const CMesh mesh = c_torus();
    NewerOptions options;
    echinus_exact_map_options_init(&options.known, sizeof options);
    EXPECT_EQ(options.known.size, sizeof options);
    EXPECT_EQ(options.unknown, 0U);
    CMap map;
    expect_ok(echinus_map_build_exact(mesh.get(), &options.known, out(map)));

    options.also_unknown = 1;
    expect_refused(echinus_map_build_exact(mesh.get(), &options.known, out(map)), ECHINUS_INVALID_ARGUMENT,
                   "options sets a member that version");
    EXPECT_EQ(map, nullptr);
}

TEST(CStructs, OfANewerHeaderGetZeroWhereTheLibraryKnowsNothing) {
    struct NewerInfo {
        echinus_map_info known;
        std::uint64_t unknown;
    } info;
    std::memset(&info, 0xFF, sizeof info);
    info.known.size = sizeof info;
    const CMap map = c_map(c_torus());
    expect_ok(echinus_map_describe(map.get(), &info.known));
    EXPECT_EQ(info.known.size, sizeof info);
    EXPECT_EQ(info.known.kind, ECHINUS_MAP_EXACT);
    EXPECT_EQ(info.unknown, 0U);
}

TEST(CStructs, AreRefusedWithASizeThatCannotBeRight) {
    const CMesh mesh = c_torus();
    echinus_exact_map_options options;
    echinus_exact_map_options_init(&options, sizeof options);
    CMap map;
    for (const std::size_t wrong :
         {std::size_t{0}, std::size_t{8}, offsetof(echinus_exact_map_options, find_certain_gaps) - 1,
          std::size_t{5000}, SIZE_MAX}) {
        options.size = wrong;
        expect_refused(echinus_map_build_exact(mesh.get(), &options, out(map)), ECHINUS_INVALID_ARGUMENT,
                       "the size of options is " + std::to_string(wrong));
    }
    echinus_mesh_report report{};
    expect_refused(echinus_mesh_inspect(mesh.get(), &report), ECHINUS_INVALID_ARGUMENT,
                   "the size of report is 0");
}

TEST(CStructs, AreFilledNoFartherThanTheirSize) {
    struct {
        echinus_exact_map_options options;
        unsigned char after[16];
    } guarded;
    std::memset(&guarded, 0xAB, sizeof guarded);
    echinus_exact_map_options_init(&guarded.options, offsetof(echinus_exact_map_options, byte_budget));
    const auto* bytes = reinterpret_cast<const unsigned char*>(&guarded);
    for (std::size_t i = offsetof(echinus_exact_map_options, byte_budget); i < sizeof guarded; ++i)
        ASSERT_EQ(bytes[i], 0xAB) << i;
    echinus_exact_map_options_init(nullptr, sizeof guarded.options);
}

} // namespace
