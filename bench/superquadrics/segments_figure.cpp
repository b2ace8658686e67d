#include "segments_figure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string>

using namespace echinus;
using namespace echinus::rivals;

namespace {

constexpr double kFooter = 0.1, kBaseLine = 0.96, kLetterHeight = 0.03; // of a picture's height
constexpr Colour kUncovered = Colour::from_hex(0xD81E1E);

Colour mixed(const Colour& a, const Colour& b, float share) {
    return {a.red + (b.red - a.red) * share, a.green + (b.green - a.green) * share,
            a.blue + (b.blue - a.blue) * share};
}

/// The palette, then paler, then darker; after that from the start.
Colour colour_of(std::size_t segment) {
    const Colour& pure = palette::kLayers[segment % std::size(palette::kLayers)];
    switch (segment / std::size(palette::kLayers) % 3) {
    case 1:
        return mixed(pure, {1, 1, 1}, 0.5F);
    case 2:
        return mixed(pure, {0, 0, 0}, 0.4F);
    default:
        return pure;
    }
}

RenderedObject coloured(TriangleMesh mesh, std::size_t segment) {
    RenderedObject object;
    object.mesh = std::move(mesh);
    object.colour = colour_of(segment);
    return object;
}

RenderedObject plain(const TriangleMesh& model) {
    RenderedObject object;
    object.mesh = model;
    return object;
}

RenderedObject segments_of(const TriangleMesh& model, const SuperquadricReport& report) {
    RenderedObject object = plain(model);
    for (const std::uint32_t segment : report.segment_of_face)
        object.face_colours.push_back(colour_of(segment));
    return object;
}

RenderedObject uncovered_of(const TriangleMesh& model, const SuperquadricReport& report) {
    RenderedObject object = plain(model);
    object.face_colours.assign(model.faces.size(), palette::kClay);
    for (const std::uint32_t face : report.uncovered_faces) object.face_colours[face] = kUncovered;
    return object;
}

std::vector<RenderedObject> superquadrics_of(const SuperquadricReport& report, bool enlarged) {
    std::vector<RenderedObject> objects;
    for (std::size_t i = 0; i < report.segments.size(); ++i) {
        Superquadric shape = report.segments[i].fitted;
        if (enlarged) shape.sizes *= report.segments[i].enlargement;
        objects.push_back(coloured(tessellate(shape, 60, 120), i));
    }
    return objects;
}

std::vector<RenderedObject> surfaces_of(const SuperquadricMap& map) {
    std::vector<RenderedObject> objects;
    for (std::size_t i = 0; i < map.segment_count(); ++i) {
        TriangleMesh surface = map.surface_of(i);
        if (!surface.faces.empty()) objects.push_back(coloured(std::move(surface), i));
    }
    return objects;
}

} // namespace

Image draw_segments_figure(const TriangleMesh& model, const SuperquadricMap& map, const View& view,
                           const RenderOptions& options) {
    const SuperquadricReport& report = map.report();
    struct Picture {
        std::vector<RenderedObject> objects;
        std::string label;
    };
    const Picture pictures[] = {
        {{plain(model)}, fmt::format("the model, {} faces", model.faces.size())},
        {{segments_of(model, report)}, fmt::format("its {} segments", map.segment_count())},
        {superquadrics_of(report, false), "a superquadric fitted to each"},
        {superquadrics_of(report, true), "enlarged until they hold their segments"},
        {surfaces_of(map),
         fmt::format("the map's surface, {} x {} samples each", map.omega_count(), map.eta_count())},
        {{uncovered_of(model, report)},
         fmt::format("in red what no segment covers, {:.1f} %", 100 * report.uncovered_area_share)}};
    View roomy = view;
    roomy.footer = kFooter;
    // The superquadrics reach farther than the model, but not far: it is to be seen as large as may be.
    roomy.margin = 0.06;
    const Camera camera =
        camera_for(pictures[0].objects, roomy, static_cast<double>(options.width) / options.height);
    std::vector<Image> images;
    for (const Picture& picture : pictures) {
        Image& image = images.emplace_back(render(picture.objects, camera, options));
        draw_text(image, image.width / 2.0, kBaseLine * image.height, picture.label,
                  kLetterHeight * image.height, palette::kInk, TextAlign::Centre);
    }
    return arrange(images, 3);
}
