#include "console/json.hpp"
#include "judges/check_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace echinus::test {

namespace {

double agreement(const Score& score) {
    return score.far_points == 0
               ? 1
               : static_cast<double>(score.agreeing) / static_cast<double>(score.far_points);
}

/// All keys of a score; those of sides differ between closed and open surfaces.
Json to_object(const Score& score, bool closed) {
    Json object;
    object.add("points", score.points);
    object.add("ambiguous", score.ambiguous);
    if (closed) {
        object.add("wrong_inside", score.wrong_inside);
        object.add("wrong_snapped", score.wrong_snapped);
    } else {
        object.add("far_points", score.far_points);
        object.add("agreement", agreement(score));
        object.add("disagreements_certain", score.disagreements_certain);
        object.add("certain_share", static_cast<double>(score.certain) /
                                        static_cast<double>(std::max<std::size_t>(1, score.points)));
    }
    object.add("inconsistent", score.inconsistent);
    object.add("distance_points", score.points);
    object.add("worst_distance_error", score.worst_distance_error);
    object.add("worst_point_error", score.worst_point_error);
    object.add("worst_normal_error_deg", score.worst_normal_error_deg);
    return object;
}

std::string sides_of(const Score& score, bool closed) {
    if (closed) return fmt::format("{:>9} {:>9}", score.wrong_inside, score.wrong_snapped);
    return fmt::format("{:>8.4f}% {:>9}", 100 * agreement(score), score.disagreements_certain);
}

std::string text_line(const char* rule, const std::string& set, const Score& score, bool closed) {
    return fmt::format("{:<8} {:<12} {:>9} {:>9} {} {:>9} {:>9.2e} {:>9.2e} {:>9.4f}\n", rule, set,
                       score.points, score.ambiguous, sides_of(score, closed), score.inconsistent,
                       score.worst_distance_error, score.worst_point_error, score.worst_normal_error_deg);
}

} // namespace

std::string to_json(const CheckResult& result) {
    Json object;
    object.add("mesh", result.mesh);
    object.add("faces", result.face_count);
    object.add("closed", result.closed);
    object.add("cells_per_octant", result.divisions);
    object.add("bytes", result.byte_count);
    object.add("seed", result.seed);
    object.add("wrong_corners", result.wrong_corners);
    object.add("compared_with_cgal", result.compared_with_cgal);
    object.add("judges_disagree", result.judges_disagree);
    Json rules;
    for (std::size_t rule = 0; rule < result.rules.size(); ++rule) {
        Json entry = to_object(result.total(rule), result.closed);
        if (!result.closed) entry.add("certain_share", result.certain_share()); // of uniform points only
        Json sets;
        for (const SetResult& set : result.sets)
            sets.add(set.name, to_object(set.scores[rule], result.closed));
        entry.add("sets", sets);
        entry.add("complaints", result.total(rule).complaints);
        rules.add(name_of(result.rules[rule]), entry);
    }
    object.add("rules", rules);
    object.add("seconds", result.seconds);
    object.add("holds", result.holds());
    return object.indented();
}

std::string to_text(const CheckResult& result) {
    std::string text =
        fmt::format("{}: {} faces, {}, {} divisions, {} bytes; {:.1f} s\n", result.mesh, result.face_count,
                    result.closed ? "closed" : "open", result.divisions, result.byte_count, result.seconds);
    text += fmt::format("{:<8} {:<12} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "rule", "points",
                        "count", "ambiguous", result.closed ? "wrong" : "agreement",
                        result.closed ? "snapped" : "certain", "inconsist", "distance", "contact", "normal");
    for (std::size_t rule = 0; rule < result.rules.size(); ++rule) {
        const char* name = name_of(result.rules[rule]);
        for (const SetResult& set : result.sets)
            text += text_line(name, set.name, set.scores[rule], result.closed);
        const Score total = result.total(rule);
        text += text_line(name, "all", total, result.closed);
        for (const std::string& complaint : total.complaints) text += "    " + complaint + "\n";
    }
    if (!result.closed)
        text += fmt::format("certain: {:.3f} % of uniform points\n", 100 * result.certain_share());
    if (result.wrong_corners != 0)
        text += fmt::format("{} corners of the map are not where the mesh's snap to\n", result.wrong_corners);
    if (result.judges_disagree != 0)
        text += fmt::format("the judge and CGAL's Side_of_triangle_mesh disagree on {} of {} points\n",
                            result.judges_disagree, result.compared_with_cgal);
    return text + (result.holds() ? "All answers hold.\n" : "NOT all answers hold.\n");
}

} // namespace echinus::test
