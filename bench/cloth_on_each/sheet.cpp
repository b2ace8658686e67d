#include "sheet.hpp"

using namespace echinus;

namespace {

/// Pale, so that the red of the marks stands out.
constexpr Colour kClothFront = Colour::from_hex(0x9CC4D8), kClothBack = Colour::from_hex(0xD9CFA8);
constexpr Colour kMark = Colour::from_hex(0xD81E1E);
constexpr double kMarkRadius = 0.011; // of the model's
/// Room for two lines below each picture, and their letters, as shares of its height.
constexpr double kFooter = 0.14, kLabelLine = 0.925, kCaptionLine = 0.98;
constexpr double kLabelHeight = 0.034, kCaptionHeight = 0.026;

void append(const TriangleMesh& part, const Vec3f& place, TriangleMesh& whole) {
    const auto first = static_cast<std::uint32_t>(whole.vertices.size());
    for (const Vec3f& vertex : part.vertices) whole.vertices.push_back(vertex + place);
    for (const Triangle& face : part.faces)
        whole.faces.push_back({first + face[0], first + face[1], first + face[2]});
}

RenderedObject marks_of(const FinalCloth& cloth, const ExactMap& judge) {
    const TriangleMesh ball = make_sphere(kMarkRadius * double{judge.view().radius}, 10, 6);
    RenderedObject marks;
    marks.colour = kMark;
    for (const Vec3f& particle : cloth.mesh.vertices) {
        const Contact found = contact(judge, particle);
        if (found.inside) append(ball, found.point, marks.mesh);
    }
    return marks;
}

std::vector<RenderedObject> objects_of(const TriangleMesh& model, const FinalCloth& cloth) {
    std::vector<RenderedObject> objects(2);
    objects[0].mesh = model;
    objects[1].mesh = cloth.mesh;
    objects[1].colour = kClothFront;
    objects[1].back_colour = kClothBack;
    objects[1].crease_angle_deg = 180; // cloth has folds, not edges
    return objects;
}

} // namespace

Image draw_sheet(const TriangleMesh& model, std::span<const FinalCloth> cloths, const SheetOptions& options) {
    View view = options.view;
    view.footer = kFooter;
    const Camera camera = camera_for(objects_of(model, cloths.front()), view,
                                     static_cast<double>(options.width) / options.height);
    RenderOptions picture_options;
    picture_options.width = options.width;
    picture_options.height = options.height;
    picture_options.samples = options.samples;
    const ExactMap judge = ExactMap::build(model);
    std::vector<Image> pictures;
    for (const FinalCloth& cloth : cloths) {
        std::vector<RenderedObject> objects = objects_of(model, cloth);
        RenderedObject marks = marks_of(cloth, judge);
        if (!marks.mesh.faces.empty()) objects.push_back(std::move(marks));
        Image& picture = pictures.emplace_back(render(objects, camera, picture_options));
        const double middle = picture.width / 2.0, height = picture.height;
        draw_text(picture, middle, kLabelLine * height, cloth.label, kLabelHeight * height, palette::kInk,
                  TextAlign::Centre);
        draw_text(picture, middle, kCaptionLine * height, cloth.caption, kCaptionHeight * height,
                  palette::kInk, TextAlign::Centre);
    }
    return arrange(pictures, options.column_count);
}
