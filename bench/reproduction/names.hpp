#pragma once

#include <echinus/distance_map.hpp>

/// The options that are measured one after the other, and their names in tables.
inline constexpr echinus::PoleAxis kAxes[] = {echinus::PoleAxis::X, echinus::PoleAxis::Y,
                                              echinus::PoleAxis::Z};
inline constexpr echinus::VertexCorrection kCorrections[] = {
    echinus::VertexCorrection::None, echinus::VertexCorrection::Paper, echinus::VertexCorrection::Signed};

inline const char* name_of(echinus::PoleAxis axis) {
    return axis == echinus::PoleAxis::X ? "x" : axis == echinus::PoleAxis::Y ? "y" : "z";
}

inline const char* name_of(echinus::VertexCorrection correction) {
    return correction == echinus::VertexCorrection::None    ? "none"
           : correction == echinus::VertexCorrection::Paper ? "paper"
                                                            : "signed";
}
