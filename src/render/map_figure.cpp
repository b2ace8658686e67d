#include "render/image.hpp"

#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace echinus::render {

namespace {

/// Room for two lines of text below the pictures, and the height of its letters, as shares of the pictures'
/// height.
constexpr double kFooter = 0.11;
constexpr double kLetterShare = 0.023;
constexpr double kSmallestLetterPx = 7;

RenderedObject model_object(const TriangleMesh& model) {
    RenderedObject object;
    object.mesh = model;
    return object;
}

Colour layer_colour(std::uint32_t layer) {
    return palette::kLayers[layer % std::size(palette::kLayers)];
}

RenderedObject map_object(const MapSurface& surface) {
    RenderedObject object;
    object.mesh = surface.mesh;
    object.back_colour = palette::kLayerBack;
    object.crease_angle_deg = 60; // the map's surface is uneven between samples even if the model is smooth
    for (std::uint32_t layer : surface.layer) object.face_colours.push_back(layer_colour(layer));
    return object;
}

/// Base lines of the two lines of text, and the height of their letters.
struct Footer {
    double letter_px, first_line, second_line;

    explicit Footer(const Image& image)
        : letter_px(std::max(kLetterShare * image.height, kSmallestLetterPx)),
          first_line(image.height - 4.2 * letter_px), second_line(image.height - 1.7 * letter_px) {}
};

void draw_caption(Image& image, const std::string& caption) {
    const Footer footer(image);
    draw_text(image, image.width / 2.0, footer.first_line, caption, footer.letter_px, palette::kInk,
              TextAlign::Centre);
}

/// The meaning of a colour.
struct LegendEntry {
    Colour colour;
    std::string label;
};

/// The title, then a dot and a label for each entry.
void draw_legend(Image& image, const std::string& title, std::span<const LegendEntry> entries) {
    const Footer footer(image);
    const double letter = footer.letter_px;
    const double dot_step = 1.6 * letter;
    const double gap = 1.2 * letter;
    double width = text_width(title, letter);
    for (const LegendEntry& entry : entries) width += gap + dot_step + text_width(entry.label, letter);
    double x = (image.width - width) / 2;
    draw_text(image, x, footer.second_line, title, letter);
    x += text_width(title, letter);
    for (const LegendEntry& entry : entries) {
        const PagePoint dot{x + gap + letter / 2, footer.second_line - letter / 2};
        draw_strokes(image, std::array{PageStroke{dot, dot}}, 1.25 * letter, entry.colour);
        draw_text(image, x + gap + dot_step, footer.second_line, entry.label, letter);
        x += gap + dot_step + text_width(entry.label, letter);
    }
}

/// The options of one of two successive pictures that share one progress bar.
RenderOptions half_of(const RenderOptions& options, int half) {
    RenderOptions result = options;
    result.width = options.width / 2;
    if (options.progress) {
        result.progress = [&options, half](double share) { options.progress((half + share) / 2); };
    }
    return result;
}

/// The right half of the figure.
struct MapPicture {
    RenderedObject object;
    std::string caption;
    std::string legend_title;
    std::vector<LegendEntry> legend;
};

Image draw_figure(const TriangleMesh& model, MapPicture map, const View& view, const RenderOptions& options) {
    const std::array objects{model_object(model), std::move(map.object)};
    View roomy_view = view;
    roomy_view.footer = std::max(view.footer, kFooter);
    const RenderOptions left = half_of(options, 0);
    const double aspect = static_cast<double>(left.width) / left.height;
    const std::span<const RenderedObject> model_alone(&objects[0], 1);
    Camera camera = camera_for(objects, roomy_view, aspect);
    // The model must not float above the floor if the map extends below the model.
    camera.floor_height = camera_for(model_alone, roomy_view, aspect).floor_height;

    std::array pictures{render(model_alone, camera, left),
                        render({&objects[1], 1}, camera, half_of(options, 1))};
    draw_caption(pictures[0], "model, " + std::to_string(model.faces.size()) + " faces");
    draw_caption(pictures[1], map.caption);
    draw_legend(pictures[1], map.legend_title, map.legend);
    return arrange(pictures, 2);
}

// ---- An exact map: its faces, coloured by the lists that contain them ----

/// Classes of list lengths: up to 4 faces, up to 8 and so on.
constexpr std::size_t kClassCount = std::size(palette::kScale);

std::size_t class_of(std::uint32_t list_length) {
    std::size_t result = 0;
    while (result + 1 < kClassCount && list_length > (std::uint32_t{4} << result)) ++result;
    return result;
}

/// The map's mesh, on its lattice.
RenderedObject map_object(const ExactMapView& map) {
    ExactMapSurface surface = reconstruct_surface(map);
    RenderedObject object;
    object.mesh = std::move(surface.mesh);
    for (const std::uint32_t length : surface.longest_list)
        object.face_colours.push_back(palette::kScale[class_of(length)]);
    return object;
}

std::vector<LegendEntry> list_legend() {
    std::vector<LegendEntry> legend;
    for (std::size_t i = 0; i + 1 < kClassCount; ++i)
        legend.push_back({palette::kScale[i], std::to_string(4U << i)});
    legend.push_back({palette::kScale[kClassCount - 1], "more"});
    return legend;
}

} // namespace

Image draw_map_figure(const TriangleMesh& model, const DistanceMapView& map, const View& view,
                      const RenderOptions& options) {
    const MapSurface surface = reconstruct_surface(map);
    if (surface.mesh.faces.empty()) {
        throw Error(
            ErrorCode::InvalidMesh,
            "the map has no surface: nowhere do four neighbouring directions have equally many entries; "
            "build it with more directions");
    }
    MapPicture picture{map_object(surface),
                       "map, " + std::to_string(map.longitude_count) + " x " +
                           std::to_string(map.colatitude_count) + " directions, " +
                           std::to_string(map.entry_count()) + " entries",
                       "entries from the centre outwards",
                       {}};
    const std::uint32_t layer_count = 1 + *std::max_element(surface.layer.begin(), surface.layer.end());
    for (std::uint32_t layer = 0; layer < layer_count; ++layer)
        picture.legend.push_back({layer_colour(layer), std::to_string(layer + 1)});
    return draw_figure(model, std::move(picture), view, options);
}

Image draw_map_figure(const TriangleMesh& model, const ExactMapView& map, const View& view,
                      const RenderOptions& options) {
    return draw_figure(model,
                       {map_object(map),
                        "map, " + std::to_string(map.cell_count()) + " cells, " +
                            std::to_string(map.references.size()) + " faces in lists",
                        "faces in the longest list, up to", list_legend()},
                       view, options);
}

} // namespace echinus::render
