#include "files/atomic_file.hpp"
#include "page/page_parts.hpp"
#include "rivals/compare/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace echinus;
using namespace echinus::comparison;

namespace {

/// A system wherever it is drawn: the same colour in each plot.
struct Style {
    const char* system;
    const char* colour;
    bool dashed;
};

constexpr Style kStyles[] = {
    {"exact map", "#0072b2", false},
    {"distance map", "#56b4e9", false},
    {"octahedral distance map", "#332288", false},
    {"classified grid", "#d55e00", true},
    {"dense grid", "#009e73", true},
    {"dense grid 0.63 MB", "#009e73", true},
    {"dense grid 2R/200", "#66c2a4", true},
    {"NanoVDB 2R/200", "#999933", true},
    {"OpenVDB 2R/200", "#ccbb44", true},
    {"Embree", "#cc79a7", true},
    {"CGAL", "#882255", true},
    {"Bullet", "#888888", true},
    {"FCL", "#444444", true},
};

/// Where nothing is wrong: at the edge of a logarithmic axis.
double at_least(double value, double least) {
    return std::max(value, least);
}

/// A curve for each system; `place` gives a record's place.
template <typename Place>
std::vector<Curve> curves(const std::vector<Records::Record>& records, Place place) {
    std::vector<Curve> result;
    for (const Style& style : kStyles) {
        Curve curve{.name = style.system, .points = {}, .colour = style.colour, .dashed = style.dashed};
        for (const Records::Record& record : records)
            if (record.at("system") == style.system) {
                const PlotPoint point = place(record);
                if (point.x > 0 && point.y > 0) curve.points.push_back(point);
            }
        if (!curve.points.empty()) result.push_back(std::move(curve));
    }
    return result;
}

constexpr double kNoneWrong = 1e-4; // per cent
constexpr double kNoError = 1e-8;   // R

double wrong_percent(const Records::Record& record) {
    return at_least(100 * number(record, "wrong_share"), kNoneWrong);
}

double megabytes(const Records::Record& record) {
    return number(record, "bytes") / 1e6;
}

/// Of each system the fastest way.
std::vector<Records::Record> fastest(const std::vector<Records::Record>& records) {
    std::vector<Records::Record> best;
    for (const Records::Record& record : records) {
        const auto same = std::ranges::find_if(
            best, [&](const auto& other) { return other.at("system") == record.at("system"); });
        if (same == best.end())
            best.push_back(record);
        else if (number(record, "ns") < number(*same, "ns"))
            *same = record;
    }
    return best;
}

void write_build_plot(const Records& build, const std::filesystem::path& images) {
    auto tori = build.where({{"mesh", "torus of n faces"}, {"way", "build"}});
    std::ranges::copy(build.where({{"mesh", "torus_1M"}, {"way", "build"}, {"clock", "processor"}}),
                      std::back_inserter(tori));
    write_file(images / "build_faces.svg", svg({.title = "Build time against faces, tori, one core",
                                                .x_label = "faces",
                                                .y_label = "build, ms",
                                                .curves = curves(tori, [](const auto& r) {
                                                    return PlotPoint{number(r, "faces"), number(r, "ms")};
                                                })}));
}

void write_bytes_plots(const Records& bytes, const std::filesystem::path& images) {
    const auto near_surface = [&](const char* task) { return bytes.where({{"task", task}, {"set", "S"}}); };
    const auto time = [](const auto& r) { return PlotPoint{megabytes(r), number(r, "ns")}; };
    write_file(images / "contains_time_bytes.svg", svg({.title = "Signs on S: time against bytes",
                                                        .x_label = "bytes that a query reads, MB",
                                                        .y_label = "ns a particle",
                                                        .curves = curves(near_surface("contains"), time)}));
    write_file(images / "contacts_time_bytes.svg", svg({.title = "Contacts on S: time against bytes",
                                                        .x_label = "bytes that a query reads, MB",
                                                        .y_label = "ns a particle",
                                                        .curves = curves(near_surface("contacts"), time)}));
    write_file(images / "contains_error_bytes.svg",
               svg({.title = "Signs on S: error against bytes",
                    .x_label = "bytes that a query reads, MB",
                    .y_label = fmt::format("wrong, % (none: {:.4f})", kNoneWrong),
                    .curves = curves(near_surface("contains"), [](const auto& r) {
                        return PlotPoint{megabytes(r), wrong_percent(r)};
                    })}));
    write_file(images / "contacts_error_bytes.svg",
               svg({.title = "Depths on S: error against bytes",
                    .x_label = "bytes that a query reads, MB",
                    .y_label = "mean error of the depth, R",
                    .curves = curves(near_surface("contacts"), [](const auto& r) {
                        return PlotPoint{megabytes(r), at_least(number(r, "depth_mean"), kNoError)};
                    })}));
}

void write_error_plots(const Results& results, const std::filesystem::path& images) {
    const auto horse_near_surface = [](const Records& records) {
        return fastest(records.where({{"mesh", records.all().front().at("mesh")}, {"set", "S"}}));
    };
    write_file(images / "contains_time_error.svg",
               svg({.title = "Signs on S: time against error, the best way of each",
                    .x_label = fmt::format("wrong, % (none: {:.4f})", kNoneWrong),
                    .y_label = "ns a particle",
                    .curves = curves(horse_near_surface(results.contains), [](const auto& r) {
                        return PlotPoint{wrong_percent(r), number(r, "ns")};
                    })}));
    write_file(images / "contacts_time_error.svg",
               svg({.title = "Contacts on S: time against error, the best way of each",
                    .x_label = "mean error of the depth, R",
                    .y_label = "ns a particle",
                    .curves = curves(horse_near_surface(results.contacts), [](const auto& r) {
                        return PlotPoint{at_least(number(r, "depth_mean"), kNoError), number(r, "ns")};
                    })}));
}

} // namespace

void write_plots(const Results& results, const std::filesystem::path& images) {
    std::filesystem::create_directories(images);
    write_build_plot(results.build, images);
    write_bytes_plots(results.bytes, images);
    write_error_plots(results, images);
}
