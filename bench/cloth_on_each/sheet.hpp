#pragma once

#include <echinus/exact_map.hpp>
#include <echinus/render.hpp>

#include <span>
#include <string>

/// A cloth at the end of its run, and what stands below its picture.
struct FinalCloth {
    echinus::TriangleMesh mesh;
    std::string label, caption;
};

struct SheetOptions {
    std::uint32_t column_count = 4;
    std::uint32_t width = 290, height = 290; ///< of one picture
    std::uint32_t samples = 32;
    echinus::View view;
};

/// A picture for each cloth, all from one camera, which sees the model and the first cloth. Particles inside
/// the model are marked by red balls on the surface above them.
/// @throws Error as render() does
echinus::Image draw_sheet(const echinus::TriangleMesh& model, std::span<const FinalCloth> cloths,
                          const SheetOptions& options);
