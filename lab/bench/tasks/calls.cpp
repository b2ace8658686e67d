// The task calls: what a particle costs in calls of one up to a million, beside Embree and grids; the same
// against the number of faces; and the slowest of a million single calls.

#include "systems.hpp"
#include "task.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace echinus;
using namespace echinus::comparison;

namespace {

/// The kind of query.
enum class Asked { Side, Contact, Distance };

constexpr std::array kAsked{Asked::Side, Asked::Contact, Asked::Distance};

std::string name_of(Asked asked) {
    return asked == Asked::Side ? "contains" : asked == Asked::Contact ? "contacts" : "distances";
}

struct Answers {
    std::vector<std::uint8_t> inside;
    std::vector<Contact> contacts;

    explicit Answers(std::size_t count) : inside(count), contacts(count) {}
};

/// A distance is a contact of every particle, however far.
float margin_of(Asked asked) {
    return asked == Asked::Distance ? std::numeric_limits<float>::infinity() : 0;
}

void ask_one(const rivals::System& system, Asked asked, const Vec3f& point, Answers& answers, std::size_t i) {
    if (asked == Asked::Side)
        answers.inside[i] = system.contains(point);
    else
        answers.contacts[i] = system.contact(point, margin_of(asked));
}

/// Asks for particles [begin, end), in calls of `call_size`.
void ask(const rivals::System& system, Asked asked, std::span<const Vec3f> points, Part part,
         std::size_t call_size, Answers& answers) {
    for (std::size_t begin = part.begin; begin < part.end; begin += call_size) {
        const std::size_t count = std::min(call_size, part.end - begin);
        if (call_size == 1)
            ask_one(system, asked, points[begin], answers, begin);
        else if (asked == Asked::Side)
            system.contains_batch(points.subspan(begin, count),
                                  std::span(answers.inside).subspan(begin, count));
        else
            system.contacts_batch(points.subspan(begin, count), margin_of(asked),
                                  std::span(answers.contacts).subspan(begin, count));
    }
}

struct Systems {
    std::vector<BenchSystem> list;
    std::vector<Built> built;
};

bool takes_part(const std::string& name) {
    constexpr std::array kNames{"exact map", "classified grid", "dense grid 0.63 MB", "Embree"};
    return std::ranges::find(kNames, name) != kNames.end();
}

Systems build(const Subject& subject, bool (*is_chosen)(const std::string&)) {
    Systems systems{systems_on(subject), {}};
    std::erase_if(systems.list, [&](const BenchSystem& system) { return !is_chosen(system.name); });
    for (const BenchSystem& system : systems.list) systems.built.push_back(system.builder.build());
    return systems;
}

/// @param call_size  0: all in one call
void add_times(const std::string& kind, const Subject& subject, const JudgedSet& set, const Systems& systems,
               Asked asked, std::size_t call_size, const Setting& setting, Records& records) {
    const std::string call = call_size == 0 ? "whole set" : fmt::format("{}", call_size);
    const std::size_t count = set.points.size();
    Answers answers(count);
    std::vector<Racer> racers;
    for (const Built& system : systems.built) {
        const auto run = [&, system = system.get()](Part part) {
            ask(*system, asked, set.points, part, call_size == 0 ? part.size() : call_size, answers);
        };
        racers.push_back({run, parts_for(run, count, setting.effort.patience_seconds)});
    }
    TurnOptions turns;
    turns.passes = setting.effort.passes;
    turns.enough_seconds = setting.effort.enough_seconds;
    turns.report_progress = [&](double fraction) {
        setting.report_progress(fmt::format("{} of {} {} {}", name_of(asked), subject.name, set.name, call),
                                fraction);
    };
    const std::vector<Pace> paces = take_turns(racers, turns);
    for (std::size_t k = 0; k < paces.size(); ++k)
        records.add({{"kind", kind},
                     {"task", name_of(asked)},
                     {"mesh", subject.name},
                     {"faces", fmt::format("{}", subject.mesh.faces.size())},
                     {"set", set.name},
                     {"particles", fmt::format("{}", count)},
                     {"call", call},
                     {"system", systems.list[k].name},
                     {"role", systems.list[k].is_ours ? "ours" : "rival"},
                     {"ns", fmt::format("{:.4g}", paces[k].ns)},
                     {"spread", fmt::format("{:.2g}", paces[k].spread)}});
}

void add_call_sizes(const Subject& subject, const Setting& setting, Records& records) {
    const Systems systems = build(subject, takes_part);
    const std::size_t few = std::max<std::size_t>(setting.point_count / 10, 10'000);
    for (const std::size_t call_size : {1, 16, 256, 1000, 10'000, 0})
        for (const JudgedSet& set :
             call_size == 0 ? subject.sets(setting.point_count) : subject.sets_for_calls(few, call_size))
            for (const Asked asked : kAsked)
                add_times("calls", subject, set, systems, asked, call_size, setting, records);
}

void add_faces(const Setting& setting, Records& records) {
    const std::size_t most = setting.is_short ? 5000 : 1'100'000;
    for (std::size_t faces = 1000; faces <= most; faces *= 4) {
        const Subject torus{"torus of n faces", torus_of(faces), 1.4, true, test::Axis::Z};
        const Systems systems =
            build(torus, [](const std::string& name) { return name == "exact map" || name == "Embree"; });
        const std::size_t count = std::min<std::size_t>(setting.point_count, 100'000);
        for (const std::size_t call_size : {1, 1000, 0})
            for (const JudgedSet& set :
                 call_size == 0 ? torus.sets(count) : torus.sets_for_calls(count, call_size))
                for (const Asked asked : {Asked::Side, Asked::Contact})
                    add_times("faces", torus, set, systems, asked, call_size, setting, records);
    }
}

/// Of single calls, in nanoseconds, with the reading of the clock.
struct Latencies {
    double median, p999, worst;
    /// The worst of the shortest of three calls for each particle: what the query itself takes, without the
    /// moments at which the machine did something else.
    double worst_undisturbed;
};

double percentile(std::vector<double>& times, double share) {
    const auto place =
        times.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(times.size() - 1));
    std::ranges::nth_element(times, place);
    return *place;
}

Latencies latencies_of(const rivals::System& system, std::span<const Vec3f> points) {
    const auto now = [] { return std::chrono::steady_clock::now(); };
    std::vector<double> first(points.size()), shortest(points.size());
    Answers answers(points.size());
    for (int pass = 0; pass < 3; ++pass)
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto start = now();
            ask_one(system, Asked::Contact, points[i], answers, i);
            const double ns = std::chrono::duration<double, std::nano>(now() - start).count();
            if (pass == 0) first[i] = ns;
            shortest[i] = pass == 0 ? ns : std::min(shortest[i], ns);
        }
    return {percentile(first, 0.5), percentile(first, 0.999), percentile(first, 1), percentile(shortest, 1)};
}

void add_latencies(const Subject& subject, const Setting& setting, Records& records) {
    const Systems systems =
        build(subject, [](const std::string& name) { return name == "exact map" || name == "Embree"; });
    for (const JudgedSet& set : subject.sets(setting.point_count))
        for (std::size_t k = 0; k < systems.built.size(); ++k) {
            setting.report_progress(
                fmt::format("latency of {} {} {}", systems.list[k].name, subject.name, set.name), 0);
            const Latencies found = latencies_of(*systems.built[k], set.points);
            records.add({{"kind", "latency"},
                         {"task", "contacts"},
                         {"mesh", subject.name},
                         {"faces", fmt::format("{}", subject.mesh.faces.size())},
                         {"set", set.name},
                         {"particles", fmt::format("{}", set.points.size())},
                         {"call", "1"},
                         {"system", systems.list[k].name},
                         {"role", systems.list[k].is_ours ? "ours" : "rival"},
                         {"median", fmt::format("{:.4g}", found.median)},
                         {"p999", fmt::format("{:.4g}", found.p999)},
                         {"worst", fmt::format("{:.4g}", found.worst)},
                         {"worst_undisturbed", fmt::format("{:.4g}", found.worst_undisturbed)}});
        }
}

} // namespace

Records measure_calls(const Setting& setting) {
    Records records({"kind", "task", "mesh", "faces", "set", "particles", "call", "system", "role", "ns",
                     "spread", "median", "p999", "worst", "worst_undisturbed"});
    const Subject horse = first_subject(setting.meshes, setting.debian_horse);
    add_latencies(horse, setting, records);
    add_call_sizes(horse, setting, records);
    add_call_sizes(torus_subject(), setting, records);
    add_faces(setting, records);
    return records;
}
