#include "files/atomic_file.hpp"
#include "mesh_io/encode.hpp"
#include "mesh_io/mesh_source.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

namespace echinus {

void write_tetrahedra(const std::filesystem::path& path, const TetrahedralMesh& mesh) {
    const std::string ending = lower_case_ending(path);
    if (ending != ".msh" && ending != ".vtk")
        throw Error(ErrorCode::WrongFormat, path.string() +
                                                ": tetrahedra are written to files that end in .msh or .vtk, "
                                                "not in " +
                                                in_quotes(ending));
    require_valid_tetrahedra(mesh);
    write_file(path, ending == ".msh" ? encode_msh(mesh) : encode_vtk(mesh));
}

} // namespace echinus
