#pragma once

#include <echinus/collider.hpp>
#include <echinus/echinus.h>

/// Has a sample of a vertex.
struct echinus_vertex_cache {
    echinus::VertexCache value;
};
