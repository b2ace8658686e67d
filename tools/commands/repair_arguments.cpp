#include "commands/repair_arguments.hpp"

#include <cmath>
#include <cstdlib>
#include <string>

using echinus::RepairOptions;

RepairOptions RepairArguments::options() const {
    RepairOptions options = repair ? RepairOptions::all() : RepairOptions{};
    options.close_seams = repair || weld_distance != 0;
    options.weld_distance = weld_distance;
    options.max_hole_edges = max_hole_edges;
    options.drop_inner_faces = drop_inner_faces;
    options.sheet_thickness = sheet_thickness;
    return options;
}

bool RepairArguments::given() const {
    return repair || weld_distance != 0 || max_hole_edges != 0 || drop_inner_faces || sheet_thickness != 0;
}

namespace {

void add_length(Command command, const std::string& name, double& length, const std::string& description) {
    const auto read_length = [name, &length](const std::string& text) {
        char* end = nullptr;
        length = std::strtod(text.c_str(), &end);
        if (end == text.c_str() || *end != '\0') return false;
        if (!(length > 0 && std::isfinite(length))) throw WrongUse(name, "must be a finite, positive length");
        return true;
    };
    command.add(name, read_length, description).type_name("LENGTH");
}

} // namespace

void add_solid_options(Command command, RepairArguments& arguments) {
    add_length(
        command, "--weld", arguments.weld_distance,
        "Join vertices at the borders of holes that are at most this far apart, in the unit of the mesh, and "
        "fill holes that are no wider; --repair does so within 4.8e-7 of the radius");
    command
        .add("--close-holes", &arguments.max_hole_edges,
             "Fill holes whose border has at most this number of edges")
        .range(3, RepairOptions::kMaxHoleEdges)
        .type_name("EDGES");
    command.add_flag(
        "--drop-inner-faces", arguments.drop_inner_faces,
        "Drop faces that have the solid on both sides, such as those of an engine in a car body");
    add_length(command, "--thicken", arguments.sheet_thickness,
               "Thicken open parts into solids of this thickness, in the unit of the mesh");
}
