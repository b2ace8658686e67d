#include "guard/guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

namespace {

constexpr double kLeast = 0.1; // of a ratio: less than this nobody minds
constexpr double kSpreads = 3;

using Record = Records::Record;

/// What one sentence is about: a system at a task, with all its ratios.
std::string subject_of(const Record& record) {
    std::string text = record.at("system") + ", " + record.at("task");
    if (!record.at("set").empty()) text += " on " + record.at("set");
    return text;
}

std::string key_of(const Record& record) {
    return record.at("mesh") + '|' + subject_of(record) + '|' + record.at("against");
}

/// By which factor a ratio changed, and by which it may.
struct Change {
    std::string against;
    double factor, tolerance;

    bool is_slower() const { return factor > 1 + tolerance; }
    bool is_faster() const { return factor < 1 / (1 + tolerance); }
};

std::string sentence(const std::string& subject, const std::vector<Change>& changes) {
    std::string text = subject + ':';
    for (const Change& change : changes)
        text += fmt::format("{} {:.2f} times as long as recorded beside {} (up to {:.2f} is spread)",
                            &change == &changes.front() ? "" : ",", change.factor, change.against,
                            1 + change.tolerance);
    return text;
}

} // namespace

GuardVerdict compare_ratios(const Records& recorded, const Records& measured) {
    std::map<std::string, Record> by_key;
    for (const Record& record : recorded.all()) by_key[key_of(record)] = record;
    std::map<std::string, std::vector<Change>> changes;
    GuardVerdict verdict;
    for (const Record& record : measured.all()) {
        const auto old = by_key.find(key_of(record));
        if (old == by_key.end()) {
            verdict.unknown.push_back(fmt::format("{} beside {} on {}: nothing is recorded",
                                                  subject_of(record), record.at("against"),
                                                  record.at("mesh")));
            continue;
        }
        changes[subject_of(record)].push_back(
            {record.at("against"), number(record, "ratio") / number(old->second, "ratio"),
             std::max(kLeast, kSpreads * (number(record, "spread") + number(old->second, "spread")))});
        by_key.erase(old);
    }
    for (const auto& [key, record] : by_key)
        verdict.unknown.push_back(fmt::format("{} beside {} on {}: recorded, but not measured",
                                              subject_of(record), record.at("against"), record.at("mesh")));
    for (const auto& [subject, of_subject] : changes) {
        if (std::ranges::all_of(of_subject, &Change::is_slower))
            verdict.slower.push_back(sentence(subject, of_subject));
        if (std::ranges::all_of(of_subject, &Change::is_faster))
            verdict.faster.push_back(sentence(subject, of_subject));
    }
    return verdict;
}
