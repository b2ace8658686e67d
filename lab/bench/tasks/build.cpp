// The task build: build times on one thread, also against the number of faces.

#include "systems.hpp"
#include "task.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

using namespace echinus;
using namespace echinus::comparison;

namespace {

constexpr std::size_t kMaxFacesForCgal = 300'000; // beyond, it takes minutes

void record(const Subject& subject, const std::vector<TimedStructure>& builds, int passes,
            const Setting& setting, Records& records) {
    const std::size_t faces = subject.mesh.faces.size();
    const std::vector<Pace> paces = time_builds(builds, passes, [&](double fraction) {
        setting.report_progress(fmt::format("build {} of {} faces", subject.name, faces), fraction);
    });
    for (std::size_t k = 0; k < builds.size(); ++k)
        records.add({{"mesh", subject.name},
                     {"faces", fmt::format("{}", faces)},
                     {"system", builds[k].system},
                     {"ms", fmt::format("{:.4g}", 1e-6 * paces[k].ns)},
                     {"spread", fmt::format("{:.2g}", paces[k].spread)}});
}

void measure_on(const Subject& subject, const Setting& setting, Records& records) {
    record(subject, builds_on(subject), subject.large ? 3 : 3 * setting.effort.passes, setting, records);
}

/// A torus of `faces` faces around which waves run, as an animated body deforms: a rebuild for each of its
/// poses, in turn, and Embree's build of the first.
void measure_deforming(std::size_t faces, const Setting& setting, Records& records) {
    constexpr std::size_t kPoses = 24;
    const Subject torus{"torus with running waves", torus_of(faces), 1.4, true, test::Axis::Z};
    auto poses = std::make_shared<std::vector<std::vector<Vec3f>>>();
    for (std::size_t i = 0; i < kPoses; ++i) {
        std::vector<Vec3f>& pose = poses->emplace_back(torus.mesh.vertices);
        for (Vec3f& v : pose) {
            const double phase = 2 * std::numbers::pi * static_cast<double>(i) / kPoses;
            v.z += static_cast<float>(0.1 * std::sin(3 * double{v.x} + phase));
        }
    }
    const ExactMapOptions exact{.thread_count = 1};
    const auto builder = std::make_shared<ExactMapBuilder>(torus.mesh.faces, exact);
    const auto next = std::make_shared<std::size_t>(0);
    std::vector<TimedStructure> builds{
        {"exact map build", true, [&, exact] { (void)ExactMap::build(torus.mesh, exact); }},
        {"exact map rebuild", true, [=] { (void)builder->rebuild((*poses)[++*next % kPoses]); }}};
    for (const BenchSystem& library : libraries_on(torus))
        if (library.name == "Embree")
            builds.push_back({library.name, false, [build = library.builder.build] { (void)build(); }});
    record(torus, builds, 3 * setting.effort.passes, setting, records);
}

} // namespace

std::vector<TimedStructure> builds_on(const Subject& subject) {
    const TriangleMesh& mesh = subject.mesh;
    const ExactMapOptions exact{.thread_count = 1};
    DistanceMapOptions distance;
    distance.thread_count = 1;
    const auto builder = std::make_shared<ExactMapBuilder>(mesh.faces, exact);
    std::vector<TimedStructure> builds{
        {"exact map build", true, [=, &mesh] { (void)ExactMap::build(mesh, exact); }},
        {"exact map rebuild", true, [=, &mesh] { (void)builder->rebuild(mesh.vertices); }},
        {"distance map build", true, [=, &mesh] { (void)DistanceMap::build(mesh, distance); }},
    };
    Subject everybody = subject; // the slow ones, too
    everybody.large = mesh.faces.size() > kMaxFacesForCgal;
    const auto own = std::make_shared<const Subject>(std::move(everybody));
    for (const BenchSystem& library : libraries_on(*own))
        if (library.name == "Embree" || library.name == "CGAL")
            builds.push_back({library.name, false, [own, build = library.builder.build] { (void)build(); }});
    return builds;
}

std::vector<Pace> time_builds(const std::vector<TimedStructure>& builds, int passes,
                              const std::function<void(double)>& report_progress) {
    std::vector<Racer> racers;
    for (const TimedStructure& structure : builds)
        racers.push_back({[&structure](Part) { structure.build(); }, {{0, 1}}});
    TurnOptions options;
    options.passes = passes;
    options.report_progress = report_progress;
    return take_turns(racers, options);
}

Records measure_build(const Setting& setting) {
    Records records({"mesh", "faces", "system", "ms", "spread"});
    for (const auto& make_subject : subjects(setting.meshes, setting.debian_horse)) {
        const Subject subject = make_subject();
        if (!subject.large || !setting.is_short) measure_on(subject, setting, records);
    }
    for (const std::size_t faces : {7'000, 20'000, 52'000})
        if (!setting.is_short || faces == 7'000) measure_deforming(faces, setting, records);
    const std::size_t max_faces = setting.is_short ? 5000 : 300'000;
    for (std::size_t faces = 1000; faces <= max_faces; faces *= 4) {
        Subject torus{"torus of n faces", torus_of(faces), 1.4, true, test::Axis::Z};
        measure_on(torus, setting, records);
    }
    return records;
}
