#pragma once

#include "mechanics/elastic_model.hpp"

#include <echinus/simulation.hpp>

namespace echinus {

/// The elastic parts of a deformable. Faces that belong to no tetrahedron are cloth, whose warp is along the
/// x axis of the shape at rest, projected onto the face; at each edge between two of them is a hinge with its
/// angle at rest; edges without faces are threads.
/// @pre the deformable and the options are valid
ElasticParts elastic_parts(const Deformable& deformable, const SimulationOptions& options);

} // namespace echinus
