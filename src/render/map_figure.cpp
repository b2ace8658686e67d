#include "render/page.hpp"

#include <echinus/error.hpp>
#include <echinus/render.hpp>

#include <algorithm>
#include <array>
#include <string>

namespace echinus {

namespace {

/// Room for two lines of text under the pictures, as a share of their height, and the letters in it.
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
    object.crease_angle_deg = 60; // between samples the surface is uneven where the model is not
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

/// "entries from the centre" and for each layer a dot and its number.
void draw_legend(Image& image, std::uint32_t layer_count) {
    const Footer footer(image);
    const std::string title = "entries from the centre outwards";
    const double letter = footer.letter_px;
    const double dot_step = 1.6 * letter;
    const double gap = 1.2 * letter;
    double width = text_width(title, letter);
    for (std::uint32_t layer = 1; layer <= layer_count; ++layer) {
        width += gap + dot_step + text_width(std::to_string(layer), letter);
    }
    double x = (image.width - width) / 2;
    draw_text(image, x, footer.second_line, title, letter);
    x += text_width(title, letter);
    for (std::uint32_t layer = 1; layer <= layer_count; ++layer) {
        const std::string number = std::to_string(layer);
        const PagePoint dot{x + gap + letter / 2, footer.second_line - letter / 2};
        draw_strokes(image, std::array{PageStroke{dot, dot}}, 1.25 * letter, layer_colour(layer - 1));
        draw_text(image, x + gap + dot_step, footer.second_line, number, letter);
        x += gap + dot_step + text_width(number, letter);
    }
}

/// The options of one of two pictures that are drawn one after the other and share one progress bar.
RenderOptions half_of(const RenderOptions& options, int half) {
    RenderOptions result = options;
    result.width = options.width / 2;
    if (options.progress) {
        result.progress = [&options, half](double share) { options.progress((half + share) / 2); };
    }
    return result;
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
    const std::array objects{model_object(model), map_object(surface)};
    View roomy_view = view;
    roomy_view.footer = std::max(view.footer, kFooter);
    const RenderOptions left = half_of(options, 0);
    const double aspect = static_cast<double>(left.width) / left.height;
    const std::span<const RenderedObject> model_alone(&objects[0], 1);
    Camera camera = camera_for(objects, roomy_view, aspect);
    // Where the map reaches below the model, the model shall not hang in the air.
    camera.floor_height = camera_for(model_alone, roomy_view, aspect).floor_height;

    std::array pictures{render(model_alone, camera, left),
                        render({&objects[1], 1}, camera, half_of(options, 1))};
    draw_caption(pictures[0], "model, " + std::to_string(model.faces.size()) + " faces");
    draw_caption(pictures[1], "map, " + std::to_string(map.longitude_count) + " x " +
                                  std::to_string(map.colatitude_count) + " directions, " +
                                  std::to_string(map.entry_count()) + " entries");
    draw_legend(pictures[1], 1 + *std::max_element(surface.layer.begin(), surface.layer.end()));
    return arrange(pictures, 2);
}

} // namespace echinus
