"""Maps of rigid meshes: which points are inside, how deep, and the way out; and cloth that collides with them.

All points are in the frame and the unit of the mesh. Arrays of points have the shape ``(..., 3)``, answers
the shape ``(...)``. An array of type float32 whose points have their three coordinates side by side is read
in place, whatever the distance from one point to the next; others are converted to float32 first.

Functions that compute for long release Python's lock. What the C++ library refuses raises :class:`Error` with
its sentence; arrays of a wrong shape or type raise ``ValueError`` or ``TypeError``.
"""

from echinus._core import available_instruction_sets, instruction_set, use_instruction_set
from echinus._core import version as __version__
from echinus._errors import Error, ErrorCode
from echinus._maps import (
    AnyMap,
    Contacts,
    DistanceMap,
    DistanceMapStatistics,
    ExactMap,
    ExactMapStatistics,
    SweepHits,
    load,
)
from echinus._meshes import (
    Fault,
    Mesh,
    MeshLike,
    MeshReport,
    RepairReport,
    as_mesh,
    inspect,
    intersecting_pairs,
    make_box,
    make_sphere,
    make_torus,
    read_mesh,
    repair,
    self_intersecting_pairs,
    unsigned_distance,
    weld,
    winding_number,
    write_mesh,
)
from echinus._simulation import ColliderState, Simulation, SimulationOptions, SimulationProfile

__all__ = [
    "AnyMap",
    "ColliderState",
    "Contacts",
    "DistanceMap",
    "DistanceMapStatistics",
    "Error",
    "ErrorCode",
    "ExactMap",
    "ExactMapStatistics",
    "Fault",
    "Mesh",
    "MeshLike",
    "MeshReport",
    "RepairReport",
    "Simulation",
    "SimulationOptions",
    "SimulationProfile",
    "SweepHits",
    "__version__",
    "as_mesh",
    "available_instruction_sets",
    "inspect",
    "instruction_set",
    "intersecting_pairs",
    "load",
    "make_box",
    "make_sphere",
    "make_torus",
    "read_mesh",
    "repair",
    "self_intersecting_pairs",
    "unsigned_distance",
    "use_instruction_set",
    "weld",
    "winding_number",
    "write_mesh",
]
