#include "simulation/surfaces/near_models.hpp"

#include <algorithm>
#include <utility>

namespace echinus {

void NearModels::add(ModelSurface model) {
    all.push_back(std::move(model));
    is_near.push_back(1);
    moves.push_back(0);
    motions.push_back(nullptr);
}

std::size_t NearModels::near_count() const {
    return static_cast<std::size_t>(std::count(is_near.begin(), is_near.end(), std::uint8_t{1}));
}

bool NearModels::any_moves() const {
    for (std::size_t c = 0; c < count(); ++c)
        if (is_near[c] != 0 && moves[c] != 0) return true;
    return false;
}

bool NearModels::any_deforms() const {
    for (std::size_t c = 0; c < count(); ++c)
        if (is_near[c] != 0 && motions[c] != nullptr) return true;
    return false;
}

bool NearModels::permit(std::uint32_t vertex, const Vec3f& place, bool is_carried) const {
    for (std::size_t c = 0; c < count(); ++c)
        if (is_near[c] != 0 && !all[c].permits(vertex, place, is_carried)) return false;
    return true;
}

bool NearModels::permit_after_a_look(std::uint32_t vertex, const Vec3f& place, bool is_carried,
                                     const Workers& workers) {
    if (permit(vertex, place, is_carried)) return true;
    bool is_renewed = false;
    for_each_near(
        [&](std::size_t, ModelSurface& model) { is_renewed = model.renew(vertex, workers) || is_renewed; });
    return is_renewed && permit(vertex, place, is_carried);
}

} // namespace echinus
