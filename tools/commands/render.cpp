#include "commands/commands.hpp"
#include "console/progress.hpp"
#include "input_file.hpp"
#include "mesh/local_frame.hpp"
#include "output.hpp"
#include "recording/simulation_folder.hpp"
#include "recording/threads.hpp"

#include <echinus/intersections.hpp>
#include <echinus/map_file.hpp>
#include <echinus_render/render.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>

using namespace echinus;
using namespace echinus::render;
namespace fs = std::filesystem;

namespace {

/// A smaller picture shows nothing, and a page of six has no room for them.
constexpr std::uint32_t kLeastSide = 10;

/// Common to all pictures.
struct PictureArguments {
    fs::path target;
    RenderOptions options;
    View view;

    void add_options(Command command, std::uint32_t width, std::uint32_t height);
    void add_up_option(Command command);
};

void PictureArguments::add_options(Command command, std::uint32_t width, std::uint32_t height) {
    options.width = width;
    options.height = height;
    const auto add_count = [&](const char* name, std::uint32_t& variable, const char* description,
                               std::uint32_t least, std::uint32_t most) {
        command.add(name, &variable, description).range(least, most).type_name("COUNT").show_default();
    };
    command.add("-o,--output", &target, "PNG file to write, or -")
        .required()
        .ends_in(".png")
        .type_name("PNG");
    add_count("--width", options.width, "Pixels", kLeastSide, RenderOptions::kMaxSide);
    add_count("--height", options.height, "Pixels", kLeastSide, RenderOptions::kMaxSide);
    add_count("--samples", options.samples, "Rays per pixel: more rays take longer and reduce noise", 1,
              RenderOptions::kMaxSampleCount);
    add_count("--threads", options.thread_count, "Threads to use; 0: all cores", 0, 1024);
    command
        .add_numbers("--view", ',', {&view.azimuth_deg, &view.elevation_deg},
                     "Direction of the camera in degrees: azimuth, counter-clockwise seen from above, and "
                     "elevation above "
                     "the floor")
        .type_name("AZIMUTH,ELEVATION")
        .default_text("35,20");
}

void PictureArguments::add_up_option(Command command) {
    add_choice<Vec3d>(command, "--up", view.up, {{"x", {1, 0, 0}}, {"y", {0, 1, 0}}, {"z", {0, 0, 1}}},
                      "The axis of the mesh that points up");
}

void write_picture(const PictureArguments& arguments, const Image& image) {
    const std::vector<std::uint8_t> bytes = encode_png(image);
    Output output(arguments.target);
    output.write(bytes.data(), bytes.size());
    output.commit();
}

/// The options with a progress bar, for one of `part_count` equal parts of the work.
RenderOptions with_progress(const RenderOptions& options, ProgressBar& bar, std::size_t part = 0,
                            std::size_t part_count = 1) {
    RenderOptions result = options;
    result.progress = [&bar, part, part_count](double share) {
        bar((static_cast<double>(part) + share) / static_cast<double>(part_count));
    };
    return result;
}

double aspect_of(const RenderOptions& options) {
    return static_cast<double>(options.width) / options.height;
}

// ---- Meshes ----

struct MeshPicture : PictureArguments {
    std::vector<fs::path> meshes;
    MeshArgument standard_input; ///< its format
    double wire_width_px = 0;
    bool marks_intersections = false;
};

/// The first mesh in grey, and each further one in another colour.
std::vector<RenderedObject> objects_of(const MeshPicture& arguments) {
    std::vector<RenderedObject> objects;
    for (const fs::path& path : arguments.meshes) {
        const MeshArgument argument{path, arguments.standard_input.format};
        RenderedObject object;
        object.mesh = read_mesh(argument);
        object.wire_width_px = arguments.wire_width_px;
        if (!objects.empty()) {
            move_to_frame(objects[0].mesh.origin, object.mesh, argument.name());
            object.colour = palette::kLayers[(objects.size() - 1) % std::size(palette::kLayers)];
        }
        objects.push_back(std::move(object));
    }
    return objects;
}

void mark_intersections(std::vector<RenderedObject>& objects) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
        std::vector<std::uint32_t>& marked = objects[i].marked_faces;
        for (const auto& [a, b] : self_intersecting_pairs(objects[i].mesh))
            marked.insert(marked.end(), {a, b});
        for (std::size_t j = 0; j < i; ++j)
            for (const auto& [a, b] : intersecting_pairs(objects[i].mesh, objects[j].mesh)) {
                marked.push_back(a);
                objects[j].marked_faces.push_back(b);
            }
    }
}

void render_meshes(const MeshPicture& arguments) {
    std::vector<RenderedObject> objects = objects_of(arguments);
    if (arguments.marks_intersections) mark_intersections(objects);
    ProgressBar bar("drawing");
    const Image image = naming_mesh(name_of_input(arguments.meshes[0]), [&] {
        return render::render(objects, camera_for(objects, arguments.view, aspect_of(arguments.options)),
                              with_progress(arguments.options, bar));
    });
    write_picture(arguments, image);
}

void add_mesh_picture(Command program) {
    const auto arguments = std::make_shared<MeshPicture>();
    Command command = program.add_command("mesh", "A mesh in matte grey, and others in colours");
    command.add("MESH", &arguments->meshes, "Mesh files, or -").required().type_name("...");
    arguments->standard_input.add_format_option(command);
    arguments->add_options(command, 1000, 750);
    arguments->add_up_option(command);
    command.add("--wire", &arguments->wire_width_px, "Draw the edges as lines of this width in pixels")
        .type_name("WIDTH")
        .show_default();
    command.add_flag("--intersections", arguments->marks_intersections,
                     "Draw faces that intersect others in bright red");
    command.footer("Examples:\n  echinus render mesh torus.obj --wire 1 -o torus.png\n"
                   "  echinus render mesh body.obj shirt.obj --intersections -o crossing.png");
    command.action([arguments] { render_meshes(*arguments); });
}

// ---- A map ----

struct MapPicture : PictureArguments {
    fs::path map;
    MeshArgument mesh;
};

/// Does the map belong to the mesh? Then all vertices lie in the map's sphere, and some on it, even after
/// repair or rounding.
void require_same_model(const TriangleMesh& mesh, const AnyMap& map, const std::string& map_name) {
    const auto [centre, radius] =
        std::visit([](const auto& kind) { return std::pair(kind.view().centre, kind.view().radius); }, map);
    float reach = 0;
    for (const Triangle& face : mesh.faces)
        for (const std::uint32_t vertex : face)
            reach = std::max(reach, length(mesh.vertices[vertex] - centre));
    constexpr float kTolerance = 0.01F;
    if (std::fabs(reach - radius) <= kTolerance * radius) return;
    throw Error(ErrorCode::InvalidMesh, "not the mesh from which " + map_name + " was built: it reaches " +
                                            std::to_string(reach) + " from the map's centre, the map " +
                                            std::to_string(radius));
}

void render_map(const MapPicture& arguments) {
    const InputFile map_file(arguments.map, "ech");
    const AnyMap map = map_file.read([](const fs::path& path) { return load_map(path); });
    TriangleMesh mesh = read_mesh(arguments.mesh);
    move_to_origin(std::visit([](const auto& kind) { return kind.view().origin; }, map), mesh);
    ProgressBar bar("drawing");
    const Image image = naming_mesh(arguments.mesh.name(), [&] {
        require_same_model(mesh, map, map_file.name());
        return std::visit(
            [&](const auto& kind) {
                return draw_map_figure(mesh, kind.view(), arguments.view,
                                       with_progress(arguments.options, bar));
            },
            map);
    });
    write_picture(arguments, image);
}

void add_map_picture(Command program) {
    const auto arguments = std::make_shared<MapPicture>();
    Command command = program.add_command(
        "map",
        "A map next to its model: the faces of an exact map, coloured by the number of faces that "
        "a query there may have to test, or the surface reconstructed from a distance map, layer by layer");
    command.add("MAP", &arguments->map, "Map file, made by echinus build, or -").required().type_name("");
    command.add("MESH", &arguments->mesh.path, "The mesh from which the map was built, or -")
        .required()
        .type_name("");
    arguments->mesh.add_format_option(command);
    arguments->add_options(command, 1600, 700);
    arguments->add_up_option(command);
    command.footer("Example:\n  echinus render map torus.ech torus.obj -o torus_map.png");
    command.action([arguments] {
        arguments->mesh.require_format();
        render_map(*arguments);
    });
}

// ---- Moments of a simulation ----

struct SimulationPicture : PictureArguments {
    fs::path folder;
    std::optional<std::int64_t> frame;
    Vec3d close_up;
    double close_up_reach = 0; ///< along each axis; 0 for no close-up
};

/// Marks an element that intersects something: a face of the cloth, or the tube of a piece of thread.
void mark(RenderedObject& drawn, std::uint32_t number, std::size_t face_count) {
    const auto first_of_tubes = static_cast<std::uint32_t>(face_count);
    if (number < first_of_tubes) return drawn.marked_faces.push_back(number);
    for (std::uint32_t i = 0; i < kTubeFaces; ++i)
        drawn.marked_faces.push_back(first_of_tubes + kTubeFaces * (number - first_of_tubes) + i);
}

void mark_intersections(const SimulationFolder& folder, const MeshAndEdges& cloth,
                        RenderedObject& drawn_collider, RenderedObject& drawn_cloth) {
    const TriangleMesh surface{cloth.mesh.vertices, surface_of(cloth)};
    const auto mark_cloth = [&](std::uint32_t number) { mark(drawn_cloth, number, cloth.mesh.faces.size()); };
    std::vector<FacePair> pairs = intersecting_pairs(surface, drawn_collider.mesh);
    folder.drop_let_through(surface.faces, pairs);
    for (const auto& [number, face] : pairs) {
        mark_cloth(number);
        drawn_collider.marked_faces.push_back(face);
    }
    for (const auto& [a, b] : self_intersecting_pairs(surface)) {
        mark_cloth(a);
        mark_cloth(b);
    }
}

/// The collider and the cloth at one moment.
std::array<RenderedObject, 2> objects_at(const SimulationFolder& folder, std::size_t sample) {
    std::array<RenderedObject, 2> objects;
    const MeshAndEdges cloth = folder.cloth(sample);
    objects[0].mesh = folder.colliders(sample);
    objects[1].mesh = with_tubes(cloth);
    objects[1].colour = palette::kCloth;
    objects[1].back_colour = palette::kClothBack;
    objects[1].crease_angle_deg = 180; // cloth has folds, not edges
    mark_intersections(folder, cloth, objects[0], objects[1]);
    return objects;
}

/// The camera that shows the cube around a point as large as possible, with the floor of the whole scene.
Camera close_up_camera(const SimulationPicture& arguments, const View& view, const Camera& whole) {
    const double reach = arguments.close_up_reach;
    std::vector<Vec3f> corners;
    for (const double x : {-reach, reach})
        for (const double y : {-reach, reach})
            for (const double z : {-reach, reach}) corners.emplace_back(arguments.close_up + Vec3d{x, y, z});
    Camera camera = camera_for(corners, view, aspect_of(arguments.options));
    camera.floor_height = whole.floor_height;
    return camera;
}

void require_close_up(const SimulationPicture& arguments) {
    const Vec3d& at = arguments.close_up;
    const double reach = arguments.close_up_reach;
    if (!(reach >= 0) || !std::isfinite(at.x + at.y + at.z + reach))
        throw WrongUse("--close-up", "needs finite numbers, the last of them positive");
}

void render_moment(const SimulationPicture& arguments) {
    const SimulationFolder folder(arguments.folder);
    const std::size_t sample =
        arguments.frame ? folder.sample_at(*arguments.frame) : folder.sample_count() - 1;
    const auto objects = objects_at(folder, sample);
    View view = arguments.view;
    view.up = folder.up();
    ProgressBar bar("drawing");
    const Image image = naming_mesh(arguments.folder.string(), [&] {
        Camera camera = camera_for(objects, view, aspect_of(arguments.options));
        if (arguments.close_up_reach > 0) camera = close_up_camera(arguments, view, camera);
        return render::render(objects, camera, with_progress(arguments.options, bar));
    });
    write_picture(arguments, image);
}

std::string label_of(const SimulationFolder& folder, std::size_t sample) {
    const double frame_number = folder.frame_of(sample);
    const bool rests = folder.rest_frame() && frame_number >= *folder.rest_frame();
    return (rests ? "at rest, frame " : "frame ") + std::to_string(std::llround(frame_number));
}

constexpr std::uint32_t kSheetColumns = 3, kSheetRows = 2;
/// Room for a line of text under each picture of a sheet, and the letters in it, as shares of its height.
constexpr double kLabelFooter = 0.075, kLabelHeight = 0.025, kLabelBaseLine = 0.965;

void draw_label(Image& image, const std::string& label) {
    draw_text(image, image.width / 2.0, kLabelBaseLine * image.height, label,
              std::max(7.0, kLabelHeight * image.height), palette::kInk, TextAlign::Centre);
}

/// One camera for all moments, so that they can be compared.
Camera sheet_camera(const SimulationFolder& folder, const std::vector<std::size_t>& moments,
                    const SimulationPicture& arguments, double aspect) {
    std::vector<RenderedObject> all;
    for (std::size_t sample : moments) {
        for (RenderedObject& object : objects_at(folder, sample)) all.push_back(std::move(object));
    }
    View view = arguments.view;
    view.up = folder.up();
    view.footer = kLabelFooter;
    return camera_for(all, view, aspect);
}

Image draw_sheet(const SimulationPicture& arguments) {
    const SimulationFolder folder(arguments.folder);
    const std::vector<std::size_t> moments = choose_moments(folder, std::size_t{kSheetColumns} * kSheetRows);
    RenderOptions options = arguments.options;
    options.width /= kSheetColumns;
    options.height /= kSheetRows;
    const Camera camera = sheet_camera(folder, moments, arguments, aspect_of(options));
    ProgressBar bar("drawing");
    std::vector<Image> pictures;
    for (std::size_t sample : moments) {
        const auto part = with_progress(options, bar, pictures.size(), moments.size());
        pictures.push_back(render::render(objects_at(folder, sample), camera, part));
        draw_label(pictures.back(), label_of(folder, sample));
    }
    return arrange(pictures, kSheetColumns);
}

void render_sheet(const SimulationPicture& arguments) {
    write_picture(arguments, naming_mesh(arguments.folder.string(), [&] { return draw_sheet(arguments); }));
}

void add_moment_picture(Command program) {
    const auto arguments = std::make_shared<SimulationPicture>();
    Command command = program.add_command("moment", "One moment of a simulation");
    command.add("DIR", &arguments->folder, "Folder that echinus simulate wrote").required().type_name("");
    command.add("--frame", &arguments->frame, "The frame to draw; by default the last").type_name("NUMBER");
    command
        .add_numbers("--close-up", ',',
                     {&arguments->close_up.x, &arguments->close_up.y, &arguments->close_up.z,
                      &arguments->close_up_reach},
                     "Show only the surroundings of a point, up to REACH along each axis")
        .type_name("X,Y,Z,REACH");
    arguments->add_options(command, 1000, 750);
    command.footer("Example:\n  echinus render moment out/horse --frame 120 -o moment.png");
    command.action([arguments] {
        require_close_up(*arguments);
        render_moment(*arguments);
    });
}

void add_sheet_picture(Command program) {
    const auto arguments = std::make_shared<SimulationPicture>();
    Command command = program.add_command("sheet", "Six moments of a simulation, from the first to the last");
    command.add("DIR", &arguments->folder, "Folder that echinus simulate wrote").required().type_name("");
    arguments->add_options(command, 1500, 900);
    command.footer("Example:\n  echinus render sheet out/horse -o sheet.png");
    command.action([arguments] { render_sheet(*arguments); });
}

} // namespace

void add_render_command(Command program) {
    Command command = program.add_command("render", "Draw a mesh, a map, or moments of a simulation");
    command.require_command("A command (mesh, map, moment or sheet)");
    command.footer("Example:\n  echinus render map torus.ech torus.obj -o torus_map.png");
    add_mesh_picture(command);
    add_map_picture(command);
    add_moment_picture(command);
    add_sheet_picture(command);
}
