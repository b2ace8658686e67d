#pragma once

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>
#include <echinus/tetrahedra.hpp>

#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace echinus::test {

/// The place of a checksum in a saved state, and where begins what it is of.
inline constexpr std::size_t kChecksumAt = 24, kStateAt = 32;

/// So that only the checks of values are left to refuse what was changed.
inline void mend_checksum(std::vector<std::byte>& state) {
    const std::uint64_t checksum = XXH64(state.data() + kStateAt, state.size() - kStateAt, 0);
    std::memcpy(state.data() + kChecksumAt, &checksum, sizeof checksum);
}

inline VertexCache growing_cache(const TriangleMesh& mesh) {
    std::vector<Vec3f> samples = mesh.vertices;
    for (const Vec3f& v : mesh.vertices) samples.push_back(v * 1.5F);
    return {.sample_seconds = 0.1,
            .vertex_count = mesh.vertices.size(),
            .samples = std::make_shared<const std::vector<Vec3f>>(std::move(samples))};
}

/// Small ones that between them have every part of a state: a cloth and a soft body on a model that deforms
/// and on one that follows keys, and particles among maps of two kinds.
inline std::vector<Simulation> simulations_to_attack() {
    const TriangleMesh ball = make_sphere(0.2, 6, 4);
    Deformable sheet = make_cloth(
        {.column_count = 4, .row_count = 4, .width = 0.3, .height = 0.3, .pose = {{}, {0, 0, 0.23}}});
    sheet.inverse_masses[5] = 0;
    sheet.attachments = {{5, 0}};
    std::vector<Simulation> all;
    const Deformable body = make_soft_body(make_solid_box({0.1, 0.1, 0.1}, {2, 2, 2}),
                                           {.young_modulus = 1e4, .pose = {{}, {0.4, 0, 0.26}}});
    all.emplace_back(combine(std::vector{sheet, body}),
                     std::vector<Collider>{{.map = ExactMap::build(ball)},
                                           {.map = ExactMap::build(ball), .pose = {{}, {0.4, 0, 0}}}},
                     SimulationOptions{.thickness = 0.01});
    all[0].set_collider_cache(0, growing_cache(ball));
    all[0].set_collider_keyframes(1, {{0, {{}, {0.4, 0, 0}}}, {0.1, {{}, {0.3, 0, 0}}}});
    all.emplace_back(
        sheet,
        std::vector<Collider>{{.map = ExactMap::build(ball)},
                              {.map = DistanceMap::build(ball), .pose = {{}, {0.4, 0, 0}}}},
        SimulationOptions{.solver = JakobsenOptions{}, .time_step = 1.0 / 240, .thickness = 0.01});
    return all;
}

/// Overwrites four bytes of a state at a time: the first byte chooses the simulation, and of each record of
/// eight bytes behind it the first half says where and the second what.
/// @returns whether the state was accepted
inline bool attack_saved_state(std::span<const std::uint8_t> records) {
    static const std::vector<Simulation> fresh = simulations_to_attack();
    static const std::vector<std::vector<std::byte>> states = [] {
        std::vector<std::vector<std::byte>> saved;
        for (Simulation simulation : fresh) {
            for (int i = 0; i < 8; ++i) simulation.step();
            saved.push_back(simulation.save_state());
        }
        return saved;
    }();
    if (records.empty()) return false;
    const std::size_t kind = records[0] % fresh.size();
    std::vector<std::byte> state = states[kind];
    for (records = records.subspan(1); records.size() >= 8; records = records.subspan(8)) {
        std::uint32_t place = 0;
        std::memcpy(&place, records.data(), 4);
        std::memcpy(state.data() + kStateAt + place % (state.size() - kStateAt - 3), records.data() + 4, 4);
    }
    mend_checksum(state);
    Simulation simulation = fresh[kind];
    try {
        simulation.restore_state(state);
        for (int i = 0; i < 3; ++i) simulation.step();
    } catch (const Error&) {
        return false;
    }
    return true;
}

} // namespace echinus::test
