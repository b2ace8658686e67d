#include "judges/check_cloth.hpp"

#include "console/json.hpp"
#include "judges/exact_judge.hpp"
#include "recording/simulation_folder.hpp"
#include "recording/threads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace echinus::test {

namespace {

constexpr std::size_t kMostLines = 20;

std::optional<FacePair> first_of(const std::vector<FacePair>& pairs) {
    return pairs.empty() ? std::nullopt : std::optional(pairs.front());
}

JudgedFrame judge(const SimulationFolder& folder, std::size_t sample) {
    const MeshAndEdges saved = folder.cloth(sample);
    const TriangleMesh cloth{saved.mesh.vertices, surface_of(saved)};
    auto model_pairs = intersecting_pairs_by_cgal(cloth, folder.colliders(sample));
    folder.drop_let_through(cloth.faces, model_pairs);
    const auto own_pairs = self_intersecting_pairs_by_cgal(cloth);
    return {.frame = folder.frame_of(sample),
            .model_pairs = model_pairs.size(),
            .own_pairs = own_pairs.size(),
            .first_model_pair = first_of(model_pairs),
            .first_own_pair = first_of(own_pairs)};
}

/// The first, every so many after it, and the last.
std::vector<std::size_t> samples_to_judge(std::size_t count, std::size_t stride) {
    std::vector<std::size_t> samples;
    for (std::size_t sample = 0; sample < count; sample += stride) samples.push_back(sample);
    if (samples.back() != count - 1) samples.push_back(count - 1);
    return samples;
}

std::size_t bad_frame_count(const ClothCheckResult& result) {
    return static_cast<std::size_t>(
        std::count_if(result.frames.begin(), result.frames.end(), [](const auto& f) { return !f.holds(); }));
}

std::size_t most(const ClothCheckResult& result, std::size_t JudgedFrame::*count) {
    std::size_t largest = 0;
    for (const JudgedFrame& frame : result.frames) largest = std::max(largest, frame.*count);
    return largest;
}

std::string name_of(const std::optional<FacePair>& pair) {
    return pair ? fmt::format("{}, {}", pair->a, pair->b) : "";
}

} // namespace

bool ClothCheckResult::holds() const {
    return bad_frame_count(*this) == 0;
}

ClothCheckResult check_cloth(const std::filesystem::path& path, const ClothCheckOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    const SimulationFolder folder(path);
    ClothCheckResult result{.folder = path.string(),
                            .cloth_face_count = surface_of(folder.cloth(0)).size(),
                            .model_face_count = folder.colliders(0).faces.size()};
    const std::vector<std::size_t> samples = samples_to_judge(folder.sample_count(), options.stride);
    for (const std::size_t sample : samples) {
        result.frames.push_back(judge(folder, sample));
        if (options.report_progress)
            options.report_progress(static_cast<double>(result.frames.size()) /
                                    static_cast<double>(samples.size()));
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

std::string to_json(const ClothCheckResult& result) {
    const auto pair = [](const std::optional<FacePair>& p) {
        return p ? Json{double(p->a), double(p->b)} : Json();
    };
    Json frames = Json::array();
    for (const JudgedFrame& frame : result.frames)
        frames.push_back({{"frame", frame.frame},
                          {"intersecting_pairs", frame.model_pairs},
                          {"self_intersecting_pairs", frame.own_pairs},
                          {"first_pair", pair(frame.first_model_pair)},
                          {"first_own_pair", pair(frame.first_own_pair)}});
    return Json{{"folder", result.folder},
                {"cloth_faces", result.cloth_face_count},
                {"model_faces", result.model_face_count},
                {"frames_judged", result.frames.size()},
                {"frames_with_pairs", bad_frame_count(result)},
                {"most_intersecting_pairs", most(result, &JudgedFrame::model_pairs)},
                {"most_self_intersecting_pairs", most(result, &JudgedFrame::own_pairs)},
                {"frames", frames},
                {"seconds", result.seconds},
                {"holds", result.holds()}}
        .indented();
}

std::string to_text(const ClothCheckResult& result) {
    std::string text =
        fmt::format("{}: {} faces of the cloth, {} of the model, {} frames judged; {:.1f} s\n", result.folder,
                    result.cloth_face_count, result.model_face_count, result.frames.size(), result.seconds);
    if (result.holds()) return text + "No faces intersect.\n";
    text += fmt::format("{:>9} {:>11} {:>15} {:>11} {:>15}\n", "frame", "with model", "the first",
                        "with itself", "the first");
    std::size_t line_count = 0;
    for (const JudgedFrame& frame : result.frames)
        if (!frame.holds() && ++line_count <= kMostLines)
            text +=
                fmt::format("{:>9} {:>11} {:>15} {:>11} {:>15}\n", frame.frame, frame.model_pairs,
                            name_of(frame.first_model_pair), frame.own_pairs, name_of(frame.first_own_pair));
    if (line_count > kMostLines) text += fmt::format("... and {} more frames\n", line_count - kMostLines);
    return text + fmt::format(
                      "Faces INTERSECT in {} frames: up to {} pairs with the model, {} of the cloth's own.\n",
                      line_count, most(result, &JudgedFrame::model_pairs),
                      most(result, &JudgedFrame::own_pairs));
}

} // namespace echinus::test
