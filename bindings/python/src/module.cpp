#include "interface.hpp"

#include <echinus/instruction_set.hpp>
#include <echinus/version.hpp>

#include <pybind11/stl.h>

PYBIND11_MODULE(_core, module) {
    using namespace echinus::python;
    bind_errors(module);
    bind_meshes(module);
    bind_maps(module);
    bind_tetrahedra(module);
    bind_deformables(module);
    bind_colliders(module);
    bind_scenes(module);
    bind_simulations(module);
    module.attr("version") = echinus::version();
    module.def("available_instruction_sets", echinus::available_instruction_sets,
               "The sets of vector instructions of this machine, the widest first; the last is \"scalar\".");
    module.def("instruction_set", echinus::instruction_set,
               "The set of vector instructions in use. It decides the speed only, never an answer.");
    module.def("use_instruction_set", echinus::use_instruction_set,
               "Selects another set of vector instructions for the whole process.");
}
