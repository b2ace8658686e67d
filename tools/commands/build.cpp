#include "commands/commands.hpp"
#include "commands/descriptions.hpp"
#include "commands/repair_arguments.hpp"
#include "directions/lattice.hpp"
#include "input_file.hpp"
#include "output.hpp"

#include <echinus/any_map.hpp>
#include <echinus/error.hpp>
#include <echinus/map_file.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

using namespace echinus;

namespace {

enum class MapKind { Exact, Distance };

struct BuildArguments {
    MeshArgument mesh;
    std::filesystem::path target;
    MapKind kind = MapKind::Exact;
    ExactMapOptions exact;
    std::uint32_t cells_per_octant = 0;
    DistanceMapOptions distance;
    CentreChoice centre = CentreChoice::BoundingSphere;
    std::vector<Option> exact_only, distance_only;  ///< options of one kind of map
    std::vector<Option> counted_only, divided_only; ///< options of some grids of a distance map
    unsigned thread_count = 0;
    RepairArguments repair;
    bool allow_open = false;
    bool json = false;
};

/// Refuses options of the other kind of map, which would silently have no effect.
void refuse_options_of_the_other_kind(const BuildArguments& arguments) {
    const bool exact = arguments.kind == MapKind::Exact;
    for (const Option option : exact ? arguments.distance_only : arguments.exact_only)
        if (option.given())
            throw WrongUse(option.name(), std::string("belongs to --kind ") + (exact ? "distance" : "exact"));
    const bool counted = has_poles(arguments.distance.grid);
    for (const Option option : counted ? arguments.divided_only : arguments.counted_only)
        if (option.given())
            throw WrongUse(option.name(), std::string("belongs to --grid ") +
                                              (counted ? "octahedral or cube" : "spherical or ellipsoidal"));
}

ExactMapOptions exact_options_of(const BuildArguments& arguments) {
    ExactMapOptions options = arguments.exact;
    options.divisions = static_cast<std::uint32_t>(std::sqrt(arguments.cells_per_octant));
    options.centre = arguments.centre;
    options.thread_count = arguments.thread_count;
    return options;
}

DistanceMapOptions distance_options_of(const BuildArguments& arguments) {
    DistanceMapOptions options = arguments.distance;
    options.centre = arguments.centre;
    options.thread_count = arguments.thread_count;
    return options;
}

/// Behind a hole, a distance map misjudges what is inside, and an exact map is uncertain, so maps of open
/// meshes need an explicit option. A mesh without volume has no inside. For an inside-out mesh, the
/// correction of a distance map would have the wrong sign; an exact map is unaffected.
void require_solid(const MeshReport& report, const TriangleMesh& mesh, const BuildArguments& arguments) {
    const bool exact = arguments.kind == MapKind::Exact;
    const std::string name = arguments.mesh.name();
    const double radius = report.bounding_sphere.radius;
    constexpr double kRounding = 1e-13; // of a sum over faces whose volumes cancel
    if (report.closed && std::fabs(report.signed_volume) <= kRounding * radius * radius * radius && !exact)
        throw Error(ErrorCode::InvalidMesh,
                    name + ": the mesh encloses no volume; it is flat, or so far from the origin that its "
                           "vertices round to one point: move it to the origin");
    if (report.closed && report.signed_volume < 0 && !exact)
        throw Error(ErrorCode::InvalidMesh, name + ": the mesh is inside out: its faces are clockwise seen "
                                                   "from outside; fix it with --repair");
    if (report.closed || arguments.allow_open) return;
    throw Error(
        ErrorCode::InvalidMesh,
        name + ": " +
            refusal_of_open_mesh(mesh, report, "--repair",
                                 std::string(", or with --weld, --close-holes or --thicken, or accept ") +
                                     (exact ? "answers that are not certain near its holes with --allow-open"
                                            : "wrong answers behind its holes with --allow-open")));
}

/// The signed volume of a closed surface, in cubic lattice steps.
double signed_volume(const ExactMapView& map) {
    const auto corner = [&](std::size_t i) { return LatticePoint(map.vertices[map.corners[i]]); };
    double sum = 0;
    for (std::size_t i = 0; i < map.corners.size(); i += 3)
        sum += static_cast<double>(dot(corner(i), cross(corner(i + 1), corner(i + 2))));
    return sum / 6;
}

/// Positions a few lattice steps off the middle of each face, in front of it and behind it.
std::vector<Vec3f> places_beside_faces(const ExactMapView& map) {
    const LatticeFrame frame(map.centre, map.radius);
    std::vector<Vec3f> places;
    for (std::size_t i = 0; i < map.corners.size(); i += 3) {
        const auto corner = [&](std::size_t k) { return Vec3d(map.vertices[map.corners[i + k]]); };
        const Vec3d normal = cross(corner(1) - corner(0), corner(2) - corner(0));
        const double twice_area = length(normal);
        if (twice_area == 0) continue;
        const Vec3d middle = (corner(0) + corner(1) + corner(2)) * (1.0 / 3);
        for (const double steps : {-8, -4, -2, 2, 4, 8})
            places.emplace_back(frame.to_local(middle + normal * (steps / twice_area)));
    }
    return places;
}

/// Is the volume no larger than rounding permits, the winding number 0 in every gap, and no position next to
/// a face inside? A solid may also satisfy the first condition, if some of its parts have the opposite
/// orientation and the volumes cancel, or the second, if a coarse map has all of the inside within bands.
bool encloses_nothing(const ExactMapView& map) {
    constexpr double kRounding =
        4.0 * kLatticeExtent * kLatticeExtent; // the largest section, a few steps thick
    if (!map.border.empty() || std::fabs(signed_volume(map)) > kRounding) return false;
    if (!std::ranges::all_of(map.winding_below,
                             [](std::int16_t w) { return w == 0 || w == ExactMapView::kSplit; }))
        return false;
    const std::vector<Vec3f> places = places_beside_faces(map);
    std::vector<std::uint8_t> inside(places.size());
    contains_batch(map, places, inside);
    return std::ranges::all_of(inside, [](std::uint8_t flag) { return flag == 0; });
}

AnyMap build_kind(const TriangleMesh& mesh, const BuildArguments& arguments) {
    if (arguments.kind == MapKind::Exact) {
        ExactMap map = naming_file(arguments.mesh.name(), ErrorCode::InvalidOptions, [&] {
            // build() refuses a budget that is too small.
            return ExactMap::build(mesh, exact_options_of(arguments));
        });
        if (encloses_nothing(map) && !arguments.allow_open)
            throw Error(
                ErrorCode::InvalidMesh,
                "the mesh encloses nothing: it is flat, or its parts cancel each other, or it is so far from "
                "the origin that its vertices round to one point; build it anyway with --allow-open");
        return map;
    }
    DistanceMap map = DistanceMap::build(mesh, distance_options_of(arguments));
    if (map.view().entry_count() == 0)
        throw Error(
            ErrorCode::InvalidMesh,
            "no ray from the centre meets the mesh; it is too thin for so few directions, or so far from the "
            "origin that its vertices round to a few points");
    return map;
}

struct BuiltMap {
    AnyMap map;
    MapFileNotes notes;
    RepairReport repairs;
    bool inside_out = false; ///< whether the mesh is inside out, according to the map
    double rounding_step = 0;
};

BuiltMap build_map(TriangleMesh mesh, const BuildArguments& arguments) {
    RepairReport repairs;
    if (arguments.repair.given()) {
        RepairedMesh repaired = repair(mesh, arguments.repair.options());
        mesh = std::move(repaired.mesh);
        repairs = std::move(repaired.report);
    }
    const MeshReport report = inspect(mesh);
    require_solid(report, mesh, arguments);
    const auto start = std::chrono::steady_clock::now();
    AnyMap map = build_kind(mesh, arguments);
    const std::chrono::duration<double, std::milli> duration = std::chrono::steady_clock::now() - start;
    return {std::move(map),
            {.build_milliseconds = duration.count()},
            std::move(repairs),
            report.closed && report.signed_volume < 0,
            report.rounding_step};
}

void print_result(const MapDescription& description, const BuiltMap& built, const BuildArguments& arguments) {
    if (arguments.json) {
        Json object = to_json(description);
        if (arguments.repair.given()) object.add("repairs", to_json(built.repairs));
        if (built.inside_out) object.add("inside_out", true);
        if (built.rounding_step > 0) object.add("rounding_step", built.rounding_step);
        print(object.indented());
    } else if (arguments.target != kStandardStream) {
        print(to_text(description, arguments.target.string()));
        if (arguments.repair.given()) print("\nRepair: " + to_text(built.repairs) + ".\n");
        if (built.inside_out)
            print("\nThe mesh is inside out. The enclosed region counts as inside all the same.\n");
        if (built.rounding_step > 0) print("\nRounding: " + rounding_text(built.rounding_step) + ".\n");
    }
}

void build(const BuildArguments& arguments) {
    require_one_result(arguments.target, arguments.json);
    require_another_file(arguments.mesh.path, arguments.target);
    refuse_options_of_the_other_kind(arguments);
    const BuiltMap built =
        naming_mesh(arguments.mesh.name(), [&] { return build_map(read_mesh(arguments.mesh), arguments); });
    const std::vector<std::byte> bytes = serialise(built.map, built.notes);
    Output output(arguments.target);
    output.write(bytes.data(), bytes.size());
    output.commit();
    print_result({built.map, built.notes, bytes.size()}, built, arguments);
}

void add_exact_options(Command command, BuildArguments& arguments) {
    constexpr std::uint32_t kMostCells = ExactMapOptions::kMaxDivisions * ExactMapOptions::kMaxDivisions;
    arguments.exact_only = {
        command
            .add("--cells-per-octant", &arguments.cells_per_octant,
                 "Cells in each octant of directions, rounded down to a square number; by default "
                 "chosen according to the number of faces")
            .range(1U, kMostCells)
            .type_name("COUNT"),
        command
            .add_byte_count(
                "--budget", arguments.exact.byte_budget,
                "Largest size of the map, such as 300KB (units B, KB, MB, GB, KiB, MiB, GiB): the map gets "
                "as many cells as fit. The default, without --cells-per-octant, is 512 B per face plus "
                "64 KiB")
            .excludes("--cells-per-octant"),
        add_choice<InsideRule>(
            command, "--rule", arguments.exact.rule,
            {{"nonzero", InsideRule::Nonzero}, {"parity", InsideRule::Parity}},
            "The points that count as inside where parts of the mesh overlap: those with a winding "
            "number other than 0, or those with an odd one")};
}

void add_distance_options(Command command, BuildArguments& arguments) {
    DistanceMapOptions& options = arguments.distance;
    const Option grid = add_choice<DirectionGrid>(
        command, "--grid", options.grid,
        {{"spherical", DirectionGrid::Spherical},
         {"octahedral", DirectionGrid::Octahedral},
         {"cube", DirectionGrid::Cube},
         {"ellipsoidal", DirectionGrid::Ellipsoidal}},
        "Grid of directions: spherical, in longitude and colatitude, as in the paper; octahedral, which "
        "keeps flat faces flat; cube, evenly spaced in angle; or ellipsoidal, in longitude and colatitude "
        "of an ellipsoid with the proportions of the mesh");
    const Option directions =
        command
            .add_numbers("--directions", 'x', {&options.longitude_count, &options.colatitude_count},
                         "Numbers of samples of longitude and colatitude")
            .type_name("COUNTxCOUNT")
            .default_text("200x200");
    const Option divisions =
        command
            .add("--divisions", &options.divisions,
                 "Number of parts into which each edge of the octahedron or cube is divided; 100 parts "
                 "for the octahedron, or 81 for the cube, take as many bytes as 200x200 directions")
            .range(DistanceMapOptions::kMinDivisions, DistanceMapOptions::kMaxDivisions)
            .type_name("COUNT")
            .show_default();
    const Option pole = add_choice<PoleAxis>(command, "--pole", options.pole_axis,
                                             {{"x", PoleAxis::X}, {"y", PoleAxis::Y}, {"z", PoleAxis::Z}},
                                             "Axis of the mesh on which the poles of the grid lie");
    arguments.counted_only = {directions, pole};
    arguments.divided_only = {divisions};
    arguments.distance_only = {
        grid,
        directions,
        divisions,
        pole,
        add_choice<VertexCorrection>(command, "--correction", options.correction,
                                     {{"signed", VertexCorrection::Signed},
                                      {"paper", VertexCorrection::Paper},
                                      {"none", VertexCorrection::None}},
                                     "Correction for vertices of the mesh between the samples"),
        add_choice<EntryFormat>(command, "--entries", options.entry_format,
                                {{"float32", EntryFormat::Float32}, {"unorm16", EntryFormat::Unorm16}},
                                "Format of a stored distance")};
}

void add_options(Command command, BuildArguments& arguments) {
    command.add("MESH", &arguments.mesh.path, "Mesh file (OBJ, PLY, STL, OFF, glTF, GLB, 3DS), or -")
        .required()
        .type_name("");
    command.add("-o,--output", &arguments.target, "Map file to write, or -").required().type_name("MAP");
    add_choice<MapKind>(command, "--kind", arguments.kind,
                        {{"exact", MapKind::Exact}, {"distance", MapKind::Distance}}, "Kind of map");
    add_choice<CentreChoice>(
        command, "--centre", arguments.centre,
        {{"sphere", CentreChoice::BoundingSphere}, {"search", CentreChoice::Search}},
        "Origin of the rays: the centre of the bounding sphere, or the point with the fewest expected face "
        "tests (exact map) or wrong answers (distance map)");
    command.add("--threads", &arguments.thread_count, "Threads that build the map; 0: all cores")
        .range(0, 1024)
        .type_name("COUNT")
        .show_default();
    command.add_flag("--repair", arguments.repair.repair,
                     "First make the repairs that require no guesswork: close seams, drop duplicate faces, "
                     "doubled patches and loose slivers, flip faces and inside-out parts");
    add_solid_options(command, arguments.repair);
    command.add_flag("--allow-open", arguments.allow_open,
                     "Accept a mesh that is not closed: near its holes the answers of an exact map are "
                     "not certain, and behind its holes those of a distance map are wrong");
    arguments.mesh.add_format_option(command);
    command.add_flag("--json", arguments.json, "Print one JSON object");
    add_exact_options(command.add_group("Exact maps"), arguments);
    add_distance_options(command.add_group("Distance maps"), arguments);
}

} // namespace

void add_build_command(Command program) {
    Command command = program.add_command("build", "Build a map from a mesh");
    const auto arguments = std::make_shared<BuildArguments>();
    add_options(command, *arguments);
    command.footer("Examples:\n  echinus build torus.obj -o torus.ech\n"
                   "  echinus build torus.obj --kind distance --directions 200x200 --correction signed -o "
                   "torus.ech");
    command.action([arguments] { build(*arguments); });
}
