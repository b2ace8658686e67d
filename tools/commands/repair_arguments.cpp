#include "commands/repair_arguments.hpp"

#include <cmath>
#include <cstdlib>
#include <string>

using echinus::RepairOptions;

RepairOptions RepairArguments::options() const {
    RepairOptions options = solid;
    options.drop_duplicate_faces = options.drop_doubled_patches = options.flip_inside_out = repair;
    return options;
}

bool RepairArguments::given() const {
    return repair || solid.max_hole_edges != 0 || solid.drop_inner_faces || solid.sheet_thickness != 0;
}

void add_solid_options(Command command, RepairArguments& arguments) {
    command
        .add("--close-holes", &arguments.solid.max_hole_edges,
             "Fill holes whose border has at most so many edges")
        .range(3, RepairOptions::kMaxHoleEdges)
        .type_name("EDGES");
    command.add_flag("--drop-inner-faces", arguments.solid.drop_inner_faces,
                     "Drop faces that have the solid on both sides, such as an engine in a body");
    const auto read_thickness = [&arguments](const std::string& text) {
        char* end = nullptr;
        arguments.solid.sheet_thickness = std::strtod(text.c_str(), &end);
        if (end == text.c_str() || *end != '\0') return false;
        if (!(arguments.solid.sheet_thickness > 0 && std::isfinite(arguments.solid.sheet_thickness)))
            throw WrongUse("--thicken", "must be a finite length and positive");
        return true;
    };
    command
        .add("--thicken", read_thickness,
             "Make solids so thick of the parts that are not closed, in the unit of the mesh")
        .type_name("LENGTH");
}
