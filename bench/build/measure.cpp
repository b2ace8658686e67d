#include "build/system.hpp"
#include "build/threads.hpp"
#include "common/comparison.hpp"
#include "measurements.hpp"
#include "rivals/compare/clock.hpp"

#include <fmt/format.h>

#include <chrono>

using namespace echinus;
using namespace echinus::comparison;

namespace {

constexpr std::size_t kLargestTorus = 300'000; // faces; the next, of a million, is one of the subjects

double wall_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The ways take turns, there and back, until each has had its time.
void measure(const Subject& subject, bool pinned, const std::vector<BuildWay>& ways, Records& records) {
    constexpr double kEnough = 0.6; // seconds for each way
    constexpr std::size_t kFewest = 3, kMost = 25;
    // On one core other programs' time must not count; on several, waiting for each other must.
    const auto clock = pinned ? process_seconds : wall_seconds;
    std::vector<std::vector<double>> times(ways.size());
    double slowest = 0;
    for (std::size_t round = 0;
         round < kFewest || (round < kMost && static_cast<double>(round) * slowest < kEnough); ++round)
        for (std::size_t turn = 0; turn < ways.size(); ++turn) {
            const std::size_t k = round % 2 == 0 ? turn : ways.size() - 1 - turn;
            const double start = clock();
            ways[k].build();
            times[k].push_back(clock() - start);
            slowest = std::max(slowest, times[k].back());
        }
    for (std::size_t k = 0; k < ways.size(); ++k)
        records.add({{"mesh", subject.name},
                     {"faces", fmt::format("{}", subject.mesh.faces.size())},
                     {"system", ways[k].system},
                     {"way", ways[k].way},
                     {"threads", fmt::format("{}", ways[k].thread_count)},
                     {"clock", pinned ? "processor" : "wall"},
                     {"ms", fmt::format("{:.4g}", 1e3 * median_of(times[k]))}});
}

std::vector<BuildWay> ways_for(const TriangleMesh& mesh) {
    BuildList list;
    list_exact_map(list, mesh);
    list_distance_map(list, mesh);
    list_build_rivals(list, mesh);
    return list;
}

Subject torus_subject(std::size_t face_count) {
    return {.name = "torus of n faces",
            .mesh = torus_of(face_count),
            .radius = 1.4,
            .large = true,
            .z_is_up = true};
}

} // namespace

Records measure_build(const Setting& setting) {
    Records records({"mesh", "faces", "system", "way", "threads", "clock", "ms"});
    const auto one_thread = [](const std::vector<BuildWay>& all) {
        std::vector<BuildWay> some;
        for (const BuildWay& way : all)
            if (way.thread_count == 1) some.push_back(way);
        return some;
    };
    for (const auto& make_subject : subjects(setting.meshes, setting.debian_horse)) {
        const Subject subject = make_subject();
        if (subject.large && setting.effort.large_point_count == 0) continue;
        setting.report_progress("build " + subject.name, 0);
        const std::vector<BuildWay> ways = ways_for(subject.mesh);
        measure(subject, true, one_thread(ways), records);
    }
    for (std::size_t faces = 1000; faces <= kLargestTorus; faces *= 4) {
        const Subject torus = torus_subject(faces);
        setting.report_progress(fmt::format("build torus of {} faces", torus.mesh.faces.size()), 0);
        measure(torus, true, one_thread(ways_for(torus.mesh)), records);
    }
    return records;
}

Records measure_threads(const Setting& setting) {
    Records records({"mesh", "faces", "system", "way", "threads", "clock", "ms"});
    for (const auto& make_subject : subjects(setting.meshes, setting.debian_horse)) {
        const Subject subject = make_subject();
        if (subject.large && setting.effort.large_point_count == 0) continue;
        setting.report_progress("threads " + subject.name, 0);
        BuildList ways;
        list_exact_map(ways, subject.mesh);
        list_distance_map(ways, subject.mesh);
        list_batches(ways, subject, 200'000);
        measure(subject, false, ways, records);
    }
    return records;
}
