#pragma once

#include "mechanics/elastic_model.hpp"

#include <echinus/simulation.hpp>

namespace echinus {

/// A deformable as material. Faces that belong to no tetrahedron are cloth, whose warp lies along the x axis
/// of the shape at rest as far as the face does; a hinge at each edge between two of them has the angle at
/// rest; edges without faces are threads.
/// @pre the deformable and the options are valid
ElasticParts elastic_parts(const Deformable& deformable, const SimulationOptions& options);

} // namespace echinus
