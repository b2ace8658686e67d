#include "simulations.hpp"

#include <echinus/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>

using namespace echinus;

namespace {

nlohmann::json read_report(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) throw Error(ErrorCode::Unreadable, path.string() + ": cannot be read");
    try {
        return nlohmann::json::parse(file);
    } catch (const nlohmann::json::exception& error) {
        throw Error(ErrorCode::Damaged, path.string() + ": " + error.what());
    }
}

std::vector<std::string> row_of(const std::string& name, const nlohmann::json& report) {
    const auto& rest = report.at("frames_to_rest");
    return {name,
            fmt::format("{}", report.at("particles").get<int>()),
            fmt::format("{}", report.at("sticks").get<int>()),
            fmt::format("{}", report.at("iterations").get<int>()),
            fmt::format("{:.0f}", report.at("queries_per_frame").get<double>()),
            fmt::format("{:.1f}", report.at("ns_per_query").get<double>()),
            fmt::format("{:.1f}", report.at("ms_per_frame").at("total").get<double>()),
            fmt::format("{:.0f}", report.at("frames_per_second").get<double>()),
            rest.is_null() ? "not reached" : fmt::format("{}", rest.get<int>()),
            fmt::format("{}", report.at("inside_at_rest").get<int>()),
            fmt::format("{:.4f}", report.at("deepest").at("in_radii").get<double>())};
}

} // namespace

void read_simulations(const std::filesystem::path& folder, Values& values) {
    std::vector<std::vector<std::string>> rows{
        {"scene", "particles", "sticks", "iterations", "queries per frame", "ns per query", "ms per frame",
         "frames per second", "frames to rest", "inside at rest", "deepest / R"}};
    for (const char* name : {"horse", "torus"}) {
        const std::filesystem::path path = folder / name / "report.json";
        try {
            rows.push_back(row_of(name, read_report(path)));
        } catch (const nlohmann::json::exception& error) {
            throw Error(ErrorCode::Damaged, path.string() + ": " + error.what());
        }
    }
    values["rates"] = markdown_table(rows);
}
