#pragma once

#include <echinus/intersections.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

/// Does the cloth of a recorded simulation meet the model or itself? Judged by CGAL's exact predicates on the
/// recorded float positions; of Echinus only the reader of recordings takes part.
namespace echinus::test {

struct ClothCheckOptions {
    std::size_t stride = 1; ///< judges the first sample, every so many after it, and the last
    /// Called with the share of the samples judged so far.
    std::function<void(double fraction)> report_progress = {};
};

/// Pairs of faces that intersect at one moment.
struct JudgedFrame {
    double frame = 0;
    std::size_t model_pairs = 0; ///< of a cloth face and a model face
    std::size_t own_pairs = 0;   ///< of two cloth faces, beyond what they share
    std::optional<FacePair> first_model_pair, first_own_pair;

    bool holds() const { return model_pairs == 0 && own_pairs == 0; }
};

struct ClothCheckResult {
    std::string folder;
    std::size_t cloth_face_count = 0, model_face_count = 0;
    std::vector<JudgedFrame> frames{};
    double seconds = 0;

    /// In no frame that was judged anything intersects.
    bool holds() const;
};

/// @param folder  written by `echinus simulate SCENE -o FOLDER`
/// @throws Error as SimulationFolder does
ClothCheckResult check_cloth(const std::filesystem::path& folder, const ClothCheckOptions& options = {});

std::string to_json(const ClothCheckResult& result);
std::string to_text(const ClothCheckResult& result);

} // namespace echinus::test
