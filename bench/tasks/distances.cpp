// The task distances: the signed distance of every particle, by the exact map and by Embree's rays and point
// queries.

#include "queries.hpp"
#include "rivals/compare/turns.hpp"

#include <echinus/exact_map.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace echinus;
using namespace echinus::comparison;

namespace {

/// The signed distances of one part of a set.
using Measure = std::function<void(std::span<const Vec3f> points, std::span<float> distances)>;

struct Participant {
    std::string name;
    bool is_ours;
    Measure measure;
};

/// A rival has no other way than a contact for every particle.
Measure by_contacts(const rivals::System& system) {
    return [&system, contacts = std::vector<Contact>()](std::span<const Vec3f> points,
                                                        std::span<float> distances) mutable {
        contacts.resize(points.size());
        system.contacts_batch(points, std::numeric_limits<float>::infinity(), contacts);
        for (std::size_t i = 0; i < points.size(); ++i) distances[i] = -contacts[i].depth;
    };
}

/// The largest difference from the exact map's distances, by the radius.
double farthest_apart(std::span<const float> distances, std::span<const float> exact, double radius) {
    double farthest = 0;
    for (std::size_t i = 0; i < distances.size(); ++i)
        farthest = std::max(farthest, std::fabs(double{distances[i]} - exact[i]));
    return farthest / radius;
}

void measure_on(const Subject& subject, const Setting& setting, Records& records) {
    const ExactMap map = ExactMap::build(subject.mesh, {.thread_count = 1});
    std::vector<BenchSystem> libraries = libraries_on(subject);
    std::erase_if(libraries, [](const BenchSystem& system) { return system.name != "Embree"; });
    const BuiltSystems built = build_all(std::move(libraries));
    std::vector<Participant> participants{
        {"exact map", true, [&map](std::span<const Vec3f> points, std::span<float> distances) {
             signed_distance_batch(map, points, distances);
         }}};
    for (std::size_t k = 0; k < built.list.size(); ++k)
        participants.push_back({built.list[k].name, false, by_contacts(*built.builds[k].system)});

    const std::size_t count = subject.large ? setting.large_point_count : setting.point_count;
    for (const JudgedSet& set : subject.sets(count)) { // unjudged: the exact map is the judge
        std::vector<std::vector<float>> distances(participants.size(), std::vector<float>(set.points.size()));
        std::vector<Racer> racers;
        for (std::size_t k = 0; k < participants.size(); ++k) {
            const auto run = [&, k](Part part) {
                participants[k].measure(std::span(set.points).subspan(part.begin, part.size()),
                                        std::span(distances[k]).subspan(part.begin, part.size()));
            };
            racers.push_back({run, {{0, set.points.size()}}});
        }
        TurnOptions turns;
        turns.passes = setting.effort.passes;
        turns.report_progress = [&](double fraction) {
            setting.report_progress(fmt::format("distances {} {}", subject.name, set.name), fraction);
        };
        const std::vector<Pace> paces = take_turns(racers, turns);
        for (std::size_t k = 0; k < participants.size(); ++k)
            records.add({{"mesh", subject.name},
                         {"faces", fmt::format("{}", subject.mesh.faces.size())},
                         {"set", set.name},
                         {"particles", fmt::format("{}", set.points.size())},
                         {"system", participants[k].name},
                         {"role", participants[k].is_ours ? "ours" : "rival"},
                         {"ns", fmt::format("{:.4g}", paces[k].ns)},
                         {"spread", fmt::format("{:.2g}", paces[k].spread)},
                         {"times_ours", fmt::format("{:.3g}", paces[k].ns / paces[0].ns)},
                         {"farthest_apart", fmt::format("{:.2g}", farthest_apart(distances[k], distances[0],
                                                                                 subject.radius))}});
    }
}

} // namespace

Records measure_distances(const Setting& setting) {
    Records records({"mesh", "faces", "set", "particles", "system", "role", "ns", "spread", "times_ours",
                     "farthest_apart"});
    for (const auto& make_subject : subjects(setting.meshes, setting.debian_horse)) {
        const Subject subject = make_subject();
        if (!subject.large || !setting.is_short) measure_on(subject, setting, records);
    }
    return records;
}
