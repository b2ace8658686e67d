#include "page/page_parts.hpp"

#include <fmt/format.h>

#include <cmath>

namespace {

using Rows = std::vector<std::vector<std::string>>;

double ms(const Records& build, const Records::Record& condition) {
    const std::vector<Records::Record> found = build.where(condition);
    return found.empty() ? std::nan("") : number(found.front(), "ms");
}

/// One core: a row for each mesh.
std::string one_core(const Records& build) {
    Rows rows{{"mesh", "faces", "exact map, ms", "rebuild, ms", "build / rebuild", "distance map, ms",
               "Embree, ms", "CGAL, ms"}};
    for (const Records::Record& first :
         build.where({{"system", "exact map"}, {"way", "build"}, {"clock", "processor"}})) {
        const auto of = [&](const char* system, const char* way) {
            return ms(build, {{"mesh", first.at("mesh")},
                              {"faces", first.at("faces")},
                              {"system", system},
                              {"way", way},
                              {"clock", "processor"}});
        };
        const double built = of("exact map", "build"), rebuilt = of("exact map", "rebuild");
        rows.push_back({first.at("mesh"), first.at("faces"), shown(built), shown(rebuilt),
                        shown(built / rebuilt), shown(of("distance map", "build")),
                        shown(of("Embree", "build")), shown(of("CGAL", "build"))});
    }
    return markdown_table(rows);
}

/// One thread and two, by the clock on the wall.
std::string two_cores(const Records& build) {
    Rows rows{{"mesh", "system", "what", "one thread, ms", "two, ms", "ratio"}};
    for (const Records::Record& first : build.where({{"clock", "wall"}, {"threads", "1"}})) {
        Records::Record other = first;
        other["threads"] = "2";
        other.erase("ms");
        const double one = number(first, "ms"), two = ms(build, other);
        if (std::isnan(two)) continue;
        rows.push_back({first.at("mesh"), first.at("system"), first.at("way"), shown(one), shown(two),
                        fmt::format("{:.2f}", one / two)});
    }
    return markdown_table(rows);
}

} // namespace

void add_builds(const Results& results, Values& values) {
    values["builds"] = one_core(results.build);
    values["threads"] = two_cores(results.threads);
}

void add_cloth(const Results& results, Values& values) {
    Rows rows{{"map", "particles", "iterations", "ms a frame", "frames per second", "of it constraints, ms",
               "collision, ms", "pushes a frame", "lost"}};
    for (const Records::Record& record : results.cloth.all())
        rows.push_back({record.at("map"), record.at("particles"), record.at("iterations"),
                        shown(number(record, "ms")), shown(number(record, "frames_per_second")),
                        shown(number(record, "constraints_ms")), shown(number(record, "collision_ms")),
                        record.at("contacts"), record.at("lost")});
    values["cloth"] = markdown_table(rows);
}
