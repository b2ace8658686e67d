#pragma once

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Rendering by ray tracing on the processor, without a window or a GPU. It belongs to the library
/// echinus::render, which needs Embree 3 and libpng. Light and backdrop are fixed: the objects, their colours
/// and the camera determine the picture.
namespace echinus::render {

// ---- Objects ----

/// An opaque sRGB colour, as in a style sheet; each component in [0, 1].
struct Colour {
    float red = 0, green = 0, blue = 0;

    /// The colour 0xRRGGBB.
    static constexpr Colour from_hex(std::uint32_t rgb) {
        return {static_cast<float>(rgb >> 16 & 0xFF) / 255, static_cast<float>(rgb >> 8 & 0xFF) / 255,
                static_cast<float>(rgb & 0xFF) / 255};
    }
    friend constexpr bool operator==(const Colour&, const Colour&) = default;
};

/// The colours of the project's figures. The layers can be distinguished with every common kind of colour
/// blindness: the scheme "muted" of Paul Tol, "Colour Schemes", SRON/EPS/TN/09-002 (2021), ordered so that
/// neighbours differ most.
namespace palette {
inline constexpr Colour kClay = Colour::from_hex(0xBDB5AA);      ///< the model: warm grey
inline constexpr Colour kCloth = Colour::from_hex(0xB4584E);     ///< the front of a cloth
inline constexpr Colour kClothBack = Colour::from_hex(0xD39A7C); ///< the back of a cloth
inline constexpr Colour kMark = Colour::from_hex(0xFF1030);      ///< faces with a fault
inline constexpr Colour kPage = Colour::from_hex(0xF9F8F6);      ///< the backdrop of every picture
inline constexpr Colour kLayerBack = Colour::from_hex(0xE4DED4); ///< the inside of any layer: bone
inline constexpr Colour kInk = Colour::from_hex(0x3A3936);       ///< text and wires
inline constexpr Colour kLayers[] = {
    Colour::from_hex(0x44AA99), Colour::from_hex(0xDDCC77), Colour::from_hex(0xCC6677),
    Colour::from_hex(0x88CCEE), Colour::from_hex(0xAA4499), Colour::from_hex(0x999933),
    Colour::from_hex(0x332288), Colour::from_hex(0x117733), Colour::from_hex(0x882255),
};
/// A colour scale from low to high values, which also works in greyscale: five of Paul Tol's "YlOrBr".
inline constexpr Colour kScale[] = {
    Colour::from_hex(0xFFF7BC), Colour::from_hex(0xFEC44F), Colour::from_hex(0xFB9A29),
    Colour::from_hex(0xCC4C02), Colour::from_hex(0x662506),
};
} // namespace palette

/// A mesh and its colours. The material is matte, and both sides are lit.
struct RenderedObject {
    TriangleMesh mesh; ///< world frame, any unit
    Colour colour = palette::kClay;
    std::vector<Colour> face_colours;        ///< [face_count] colours in place of `colour`, or empty
    std::optional<Colour> back_colour;       ///< the clockwise side of faces; by default the front's colour
    std::vector<std::uint32_t> marked_faces; ///< faces drawn in palette::kMark on both sides
    /// Edges look smooth if the angle between their faces is smaller than this, and sharp otherwise. With 0
    /// every face looks flat.
    double crease_angle_deg = 40;
    double wire_width_px = 0; ///< width of the lines drawn along all edges; 0 draws none
};

// ---- Camera ----
/// The direction from which a picture is taken.
struct View {
    Vec3d up = {0, 0, 1}; ///< any length except 0
    /// Direction towards the camera, counter-clockwise about `up`. 0 is +x for up = z and, cyclically, +z for
    /// up = y and +y for up = x.
    double azimuth_deg = 35;
    double elevation_deg = 20;      ///< angle above the horizon, in [-89, 89]
    double vertical_field_deg = 24; ///< field of view, [1, 120]; a small one is nearly a parallel projection
    double margin = 0.07;           ///< empty border, as a share of the picture's height, in [0, 0.35]
    double footer = 0;              ///< extra room below for a caption: a share of the height, in [0, 0.25]
};

/// A pinhole camera and the floor below the objects, in the objects' frame.
struct Camera {
    Vec3d position;
    Vec3d right, up, forward; ///< orthonormal; forward points into the picture
    double tan_half_height = 0;
    Vec3d world_up;          ///< unit
    double floor_height = 0; ///< the value of dot(world_up, point) on the floor
};

/// The camera that shows all points as large as the margin allows, above a floor at the height of the lowest
/// point. Pictures taken with the same camera have a common scale.
/// @param aspect  width over height of the picture
/// @throws Error InvalidOptions for a field of `view` or an aspect out of range, InvalidMesh when there is
/// no point, a point is not finite, or all points coincide
Camera camera_for(std::span<const Vec3f> points, const View& view, double aspect);

/// The camera for all vertices that faces of the objects use.
/// @throws Error as the function for points does, and InvalidMesh as inspect() does
Camera camera_for(std::span<const RenderedObject> objects, const View& view, double aspect);

// ---- Pictures ----

/// A picture in memory.
struct Image {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb; ///< [height][width][3] sRGB, top row first
};

struct RenderOptions {
    static constexpr std::uint32_t kMaxSide = 16384;
    static constexpr std::uint64_t kMaxPixelCount = std::uint64_t{1} << 26;
    static constexpr std::uint32_t kMaxSampleCount = 4096;

    std::uint32_t width = 1000; ///< pixels, 1 to kMaxSide; width * height at most kMaxPixelCount
    std::uint32_t height = 750; ///< pixels, within the same limits
    std::uint32_t samples =
        32; ///< rays per pixel, 1 to kMaxSampleCount. The time is proportional to it, and the noise is
            ///< inversely proportional to its square root. Powers of two are distributed best.
    unsigned thread_count = 0; ///< 0: all cores. The picture does not depend on it.
    /// Called with the completed share, ascending to 1, from one thread at a time. It may throw to stop.
    std::function<void(double share)> progress;
};

/// Renders objects in soft light on a pale, endless floor. On one machine the picture is the same, byte for
/// byte, in every run and for any number of threads; a different processor may round differently, since
/// Embree chooses its instructions accordingly. The cost is three rays per sample of each non-empty pixel.
/// @throws Error InvalidOptions for options out of range, face_colours of the wrong size or marked faces that
/// do not exist, InvalidMesh as inspect() does, or when an object has no face with an area
Image render(std::span<const RenderedObject> objects, const Camera& camera,
             const RenderOptions& options = {});

/// The bytes of a PNG file (8 bits, sRGB).
/// @throws Error InvalidOptions when the picture is empty or its size is not that of its data
std::vector<std::uint8_t> encode_png(const Image& image);

/// Writes encode_png() to a file, under a temporary name first.
/// @throws Error Unwritable, or as encode_png()
void write_png(const std::filesystem::path& path, const Image& image);

// ---- Figures: several pictures on one page ----

/// The position of a text relative to its anchor.
enum class TextAlign : std::uint8_t { Left, Centre, Right };

/// Draws one line of text in a built-in stroke font, which contains printable ASCII; any other character
/// becomes a box.
/// @param x, y      anchor in pixels: the left end, middle or right end of the baseline
/// @param height_px height of a capital letter
void draw_text(Image& image, double x, double y, std::string_view text, double height_px,
               Colour colour = palette::kInk, TextAlign align = TextAlign::Left);

/// The width of a text drawn by draw_text(), in pixels.
double text_width(std::string_view text, double height_px);

/// Puts pictures of one size side by side, row after row.
/// @throws Error InvalidOptions when there are no pictures, their sizes differ, or the page is larger than
/// RenderOptions allows
Image arrange(std::span<const Image> pictures, std::uint32_t column_count);

/// Draws the paper's figures 2 and 3: the model, and next to it the surface reconstructed from its map, with
/// each layer of entries in its own colour and a legend.
/// @param options  width is that of the whole figure
/// @throws Error as camera_for() and render(), and InvalidMesh when the map has no surface
Image draw_map_figure(const TriangleMesh& model, const DistanceMapView& map, const View& view,
                      const RenderOptions& options = {});

/// Draws the model, and next to it the mesh of an exact map. Each face is coloured by the length of the
/// longest list that contains it: the number of faces that a query near it may have to test.
/// @param options  width is that of the whole figure
/// @throws Error as camera_for() and render()
Image draw_map_figure(const TriangleMesh& model, const ExactMapView& map, const View& view,
                      const RenderOptions& options = {});

} // namespace echinus::render

ECHINUS_EXPORT_END
