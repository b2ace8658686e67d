#pragma once

#include <string>
#include <string_view>

namespace echinus::comparison {

/// As text or as the value of an attribute, in HTML and in SVG.
std::string escaped(std::string_view plain);

/// A line of text in a picture.
/// @param anchor  which part of it lies at (x, y): "start", "middle" or "end"
/// @param more    further attributes, with a space in front
std::string svg_text(double x, double y, std::string_view anchor, std::string_view content,
                     std::string_view more = {});

} // namespace echinus::comparison
