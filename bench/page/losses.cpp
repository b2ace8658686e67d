// Where a rival is better: found from the records, so that none is forgotten.

#include "page/page_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace {

using Rows = std::vector<std::vector<std::string>>;

/// The rivals' ways that took less time than the first way of ours.
void add_faster(const Records& records, const std::string& ours, const std::string& mesh, const char* set,
                Rows& rows) {
    const auto all = records.where({{"mesh", mesh}, {"set", set}});
    const Records::Record* const our = find(all, ours);
    if (our == nullptr) return;
    for (const Records::Record& record : all) {
        const double share = number(record, "ns") / number(*our, "ns");
        if (record.at("role") != "rival" || share >= 1) continue;
        rows.push_back({record.at("system") + ", " + record.at("way"),
                        fmt::format("{}, {} on {}", mesh, record.at("task"), set),
                        shown(number(record, "ns")), shown(number(*our, "ns")),
                        fmt::format("{:.3f}", 100 * number(record, "wrong_share")),
                        fmt::format("{:.3f}", 100 * number(*our, "wrong_share"))});
    }
}

std::string faster_than(const Results& results, const std::string& ours) {
    Rows rows{{"rival", "at", "its ns", "our ns", "it is wrong, %", "ours, %"}};
    for (const Records* records : {&results.contains, &results.contacts}) {
        std::string mesh;
        for (const Records::Record& record : records->all()) {
            if (record.at("mesh") == mesh) continue;
            mesh = record.at("mesh");
            for (const char* set : {"U", "S", "C"}) add_faster(*records, ours, mesh, set, rows);
        }
    }
    return rows.size() == 1 ? "None." : markdown_table(rows);
}

std::string build_losses(const Records& build) {
    Rows rows{{"rival", "mesh", "faces", "its build, ms", "the exact map's, ms"}};
    for (const Records::Record& ours :
         build.where({{"system", "exact map"}, {"way", "build"}, {"clock", "processor"}}))
        for (const char* rival : {"Embree", "CGAL"})
            for (const Records::Record& other : build.where({{"system", rival},
                                                             {"mesh", ours.at("mesh")},
                                                             {"faces", ours.at("faces")},
                                                             {"clock", "processor"}}))
                if (number(other, "ms") < number(ours, "ms"))
                    rows.push_back({rival, ours.at("mesh"), ours.at("faces"), shown(number(other, "ms")),
                                    shown(number(ours, "ms"))});
    return rows.size() == 1 ? "None." : markdown_table(rows);
}

} // namespace

void add_losses(const Results& results, Values& values) {
    values["losses"] = "Every rival that took less time than the exact map:\n\n" +
                       faster_than(results, "exact map") + "\n\nthan the distance map:\n\n" +
                       faster_than(results, "distance map") + "\n\nand that was built in less time:\n\n" +
                       build_losses(results.build);
}
