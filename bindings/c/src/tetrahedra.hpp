#pragma once

#include <echinus/echinus.h>
#include <echinus/tetrahedra.hpp>

/// Valid.
struct echinus_tetrahedra {
    echinus::TetrahedralMesh value;
};
