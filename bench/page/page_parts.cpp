#include "page/page_parts.hpp"

#include <fmt/format.h>

#include <cmath>

Results read_results(const std::filesystem::path& folder) {
    return {Records::read(folder / "contains.csv"), Records::read(folder / "contacts.csv"),
            Records::read(folder / "bytes.csv"),    Records::read(folder / "build.csv"),
            Records::read(folder / "threads.csv"),  Records::read(folder / "cloth.csv")};
}

std::string shown(double value) {
    if (std::isnan(value)) return "";
    if (value == 0) return "0";
    const int digits_before = static_cast<int>(std::floor(std::log10(std::fabs(value)))) + 1;
    if (digits_before > 6 || digits_before < -3) return fmt::format("{:.1e}", value);
    return fmt::format("{:.{}f}", value, std::max(0, 3 - digits_before));
}

const Records::Record* find(const std::vector<Records::Record>& records, const std::string& system,
                            const std::string& way) {
    for (const Records::Record& record : records)
        if (record.at("system") == system && (way.empty() || record.at("way") == way)) return &record;
    return nullptr;
}
