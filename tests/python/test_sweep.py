"""Every argument of everything public, spoilt in each way that its type allows: refused with its name, never a crash.

The types are those of the signatures, the ranges those of bindings/options.toml, whose defaults C++ has, too.
"""

import inspect
import tomllib

import numpy as np
import pytest

import echinus as ech
from echinus import _core
from support import ROOT, torus

TABLE = tomllib.loads((ROOT / "bindings" / "options.toml").read_text())
TABLE.pop("words")

MESH = torus()
EXACT = ech.ExactMap(MESH)
BODY = ech.make_solid_box()
SHEET = ech.make_cloth(column_count=4, row_count=4)
CACHE = ech.VertexCache([MESH.vertices], 1)
SIMULATION = ech.Simulation(SHEET, [ech.Collider(EXACT, position=(0, 0, 9))])
POINTS = np.zeros((2, 3), np.float32)
PARTICLES = ech.ParticleCollision([ech.Collider(EXACT)], 0.01)
CORNERS = np.array([[9, 0, 0], [10, 0, 0], [9, 1, 0]], np.float32)
SURFACES = ech.SurfaceCollision(CORNERS, [[0, 1, 2]], [ech.Collider(EXACT)], 0.01)
KEY = ech.PoseKey(0, (0, 0, 0))
SCENE = {"model": {"torus": {}}, "cloth": {"size": [1, 1], "particles": [4, 4], "position": [0, 0, 9]}}

#: Everything that can be called, with arguments that suit it.
CALLS = [
    (ech.Mesh, {"vertices": MESH.vertices, "faces": MESH.faces}),
    (ech.inspect, {"mesh": MESH}),
    (ech.weld, {"mesh": MESH}),
    (ech.repair, {"mesh": MESH}),
    (ech.as_mesh, {"mesh": MESH}),
    (ech.winding_number, {"mesh": MESH, "points": POINTS}),
    (ech.unsigned_distance, {"mesh": MESH, "points": POINTS}),
    (ech.intersecting_pairs, {"a": MESH, "b": MESH}),
    (ech.self_intersecting_pairs, {"mesh": MESH}),
    (ech.intersections, {"a": MESH, "b": MESH}),
    (ech.check, {"meshes": [MESH]}),
    (ech.part, {"mesh": MESH, "models": []}),
    (ech.make_torus, {}),
    (ech.make_sphere, {}),
    (ech.make_box, {}),
    (ech.read_mesh, {"path": "none.obj"}),
    (ech.write_mesh, {"path": "none/none.obj", "mesh": MESH, "original": "none.obj"}),
    (ech.ExactMap, {"mesh": MESH}),
    (ech.DistanceMap, {"mesh": MESH}),
    (EXACT.contains, {"points": POINTS}),
    (EXACT.contacts, {"points": POINTS}),
    (EXACT.signed_distance, {"points": POINTS}),
    (EXACT.winding_number, {"points": POINTS}),
    (EXACT.sweep, {"start": POINTS, "end": POINTS}),
    (EXACT.save, {"path": "none/none.ech"}),
    (ech.load, {"path": "none.ech"}),
    (ech.TetrahedralMesh, {"vertices": BODY.vertices, "tetrahedra": BODY.tetrahedra}),
    (ech.read_tetrahedra, {"path": "none.msh"}),
    (ech.write_tetrahedra, {"path": "none/none.msh", "mesh": BODY}),
    (ech.make_solid_box, {}),
    (ech.tetrahedralize, {"model": EXACT, "size": 0.3}),
    (ech.require_valid_tetrahedra, {"mesh": BODY}),
    (ech.boundary, {"mesh": BODY}),
    (ech.inspect_tetrahedra, {"mesh": BODY}),
    (ech.measure_distance, {"mesh": BODY, "model": EXACT}),
    (ech.embed, {"mesh": BODY, "points": POINTS}),
    (ech.embed(BODY, POINTS).carry, {"positions": BODY.vertices}),
    (ech.make_cloth, {"column_count": 4, "row_count": 4}),
    (ech.make_cloth_of_mesh, {"mesh": MESH}),
    (ech.make_soft_body, {"mesh": BODY}),
    (ech.combine, {"parts": [SHEET]}),
    (ech.with_masses_times, {"factor": 2, "deformable": SHEET}),
    (ech.passing_through, {"collider": 0, "deformable": SHEET}),
    (ech.VertexCache, {"samples": [MESH.vertices], "sample_seconds": 1}),
    (CACHE.at, {"seconds": 0}),
    (ech.read_vertex_cache, {"path": "none.pc2", "mesh": MESH, "frames_per_second": 24}),
    (ech.pose_at, {"keys": [KEY], "seconds": 0}),
    (ech.rotation_about, {"axis": (0, 0, 1), "angle_rad": 1}),
    (ech.Simulation, {"deformable": SHEET, "colliders": []}),
    (ech.Simulation.from_scene, {"scene": SCENE}),
    (SIMULATION.step, {}),
    (SIMULATION.run, {"frame_limit": 0}),
    (SIMULATION.restored, {"state": SIMULATION.save_state()}),
    (SIMULATION.set_collider_velocity, {"collider": 0, "linear": (0, 0, 0), "angular": (0, 0, 0)}),
    (SIMULATION.set_collider_pose, {"collider": 0, "position": (0, 0, 9)}),
    (SIMULATION.set_collider_keyframes, {"collider": 0, "keys": [KEY]}),
    (SIMULATION.set_collider_vertices, {"collider": 0, "vertices": MESH.vertices}),
    (SIMULATION.set_collider_cache, {"collider": 0, "cache": CACHE}),
    (SIMULATION.set_collider_free, {"collider": 0, "mass": 1}),
    (SIMULATION.load_on, {"collider": 0}),
    (SIMULATION.record_contacts, {"is_on": True}),
    (SIMULATION.set_particle_velocity, {"particle": 0, "velocity": (0, 0, 0)}),
    (SIMULATION.blow, {"wind": (0, 0, 0), "rate": 1}),
    (ech.ParticleCollision, {"colliders": [], "thickness": 0.01}),
    (PARTICLES.set_collider_pose, {"collider": 0, "position": (0, 0, 9)}),
    (PARTICLES.place_collider, {"collider": 0, "position": (0, 0, 9)}),
    (PARTICLES.set_collider_friction, {"collider": 0, "friction": 0.5}),
    (PARTICLES.correct, {"previous_positions": POINTS, "positions": POINTS.copy(), "seconds": 1}),
    (ech.SurfaceCollision, {"positions": CORNERS, "faces": [[0, 1, 2]], "colliders": [], "thickness": 0.01}),
    (SURFACES.set_collider_pose, {"collider": 0, "position": (0, 0, 9)}),
    (SURFACES.correct, {"positions": CORNERS.copy(), "seconds": 1}),
]
#: The errors by which the library or the package may refuse.
REFUSED = (TypeError, ValueError, IndexError, ech.Error)

#: For each type, values that are none of it, and values that no argument of it may have.
WRONG_NUMBERS = ["text", object(), [1, 2]], [np.nan]
WRONG_COUNTS = ["1", 1.5, object()], [-1, 2**70]
WRONG_VECTORS = [3, "abc", (0, None, 0)], [(1, 2), (0, 0, 0, 0, 0), (np.nan, 0, 0)]
WRONG_LISTS = [3, [object()]], []
WRONG = {
    "float": WRONG_NUMBERS,
    "int": WRONG_COUNTS,
    "bool": ([1, "yes"], []),
    "Sequence[float]": WRONG_VECTORS,
    "tuple[float, float, float]": WRONG_VECTORS,
    "Path": ([5, object()], ["a\0b"]),
    "str": ([5], ["none such"]),
    "bytes": (["text"], [b"text"]),
    "Sequence[PoseKey]": WRONG_LISTS,
    "Sequence[Deformable]": WRONG_LISTS,
    "Sequence[Collider]": WRONG_LISTS,
}
ARRAYS = ["text", object(), np.zeros((2, 3), complex), np.zeros((2, 7)), [[1, 2, 3], [4]]]


def wrong_values(name, annotation):
    """(wrong types, wrong values) for an argument, by its type; nothing for those that take anything."""
    kind = annotation.removesuffix(" | None")
    if kind.startswith("Literal["):
        return [3], ["none such"]
    if kind.startswith("NDArray"):  # which is changed in place
        return [], [*ARRAYS, np.zeros((2, 3)), 3]
    if kind.startswith("ArrayLike"):
        return [], [*ARRAYS, [-1], [0.5]] if name in ("pins", "attachments", "threads") else ARRAYS
    if kind in ("MeshLike", "ExactMap", "Deformable", "TetrahedralMesh", "VertexCache"):
        return [object(), 3, "text"], []
    if name == "out":
        return [], [3, np.zeros(7), "text"]
    if name in ("margin", "tolerance"):
        return WRONG_NUMBERS[0], [np.nan, -1]
    return WRONG.get(kind, ([], []))


def cases(call):
    for parameter in inspect.signature(call).parameters.values():
        wrong_types, wrong = wrong_values(parameter.name, str(parameter.annotation))
        of_scene = call in (ech.ExactMap, ech.DistanceMap) and parameter.name not in ("mesh", "threads")
        for value in wrong_types:  # what is a key of scenes as well is refused as such
            yield parameter.name, value, REFUSED if of_scene else TypeError
        for value in wrong:
            yield parameter.name, value, REFUSED


def without_other_choice(given, name):
    """The arguments beside which another one may be given."""
    return {key: value for key, value in given.items() if (key, name) != ("size", "count")}


def option_cases():
    for struct, columns in TABLE.items():
        for place in columns["python_places"]:
            name = place.partition(":")[2].removesuffix(".__init__")
            if name.endswith("Options"):
                continue
            call, given = next((call, given) for call, given in CALLS if call is getattr(ech, name))
            for option, row in columns["rows"].items():
                option = row.get("python", option)
                if option and isinstance(row.get("range"), list) and row["type"] in ("real", "real?", "whole", "kinds"):
                    least, most = row["range"]
                    for wrong in [least - 2] + ([] if most == "inf" else [2 * most]):
                        value = int(wrong) if row["type"] == "whole" else wrong
                        yield call, given, option, (value,) * 3 if row["type"] == "kinds" else value


def test_everything_public_is_called_below_the_way_it_suits():
    classes_of_answers = {
        "AnyMap", "BoundaryDistance", "CheckedMeshes", "ColliderState", "ContactPoints", "Contacts", "DistanceMapStatistics", "ErrorCode", "ExactMapStatistics", "Fault",
        "Intersections", "Load", "MeshLike", "MeshReport", "Parted", "Penetration", "RepairReport", "SimulationOptions", "SimulationProfile", "SweepHits", "TetrahedraFile",
        "Tetrahedralization", "TetrahedralReport",
    }  # fmt: skip
    not_of_python = {"available_instruction_sets", "instruction_set", "use_instruction_set", "__version__"}
    only_within_others = {"Collider", "PoseKey", "Error", "Deformable", "Embedding"}
    called = {call.__name__ for call, _ in CALLS}
    assert set(ech.__all__) - called == classes_of_answers | not_of_python | only_within_others
    for call, given in CALLS:
        try:
            call(**given)
        except ech.Error as error:
            assert error.code in ("unreadable", "unwritable"), call


@pytest.mark.parametrize("call, given", CALLS, ids=[call.__qualname__ for call, _ in CALLS])
def test_every_argument_is_refused_where_it_is_wrong(call, given):
    for name, value, error in cases(call):
        with pytest.raises(error) as raised:
            call(**{**without_other_choice(given, name), name: value})
            pytest.fail(f"{name}={value!r}")
        if not isinstance(raised.value, ech.Error):
            assert name.removesuffix("s") in str(raised.value), (name, value)


@pytest.mark.parametrize("collider", [{"map": MESH}, {"scale": "2"}, {"position": 3}, {"rotation": (1, 0)}, {"linear_velocity": "up"}, {"name": 3}])
def test_a_collider_with_a_wrong_member_is_refused(collider):
    (name,) = collider
    with pytest.raises((TypeError, ValueError), match=name):
        ech.Simulation(SHEET, [ech.Collider(**{"map": EXACT, **collider})])


def test_every_option_is_refused_beyond_its_range():
    found = 0
    for call, given, name, value in option_cases():
        if call is ech.DistanceMap and name == "divisions":
            given = {**given, "grid": "cube"}
        with pytest.raises((ValueError, ech.Error)):
            call(**{**given, name: value})
            pytest.fail(f"{call.__name__}({name}={value})")
        found += 1
    assert found > 30


def test_the_defaults_of_the_table_are_those_of_c_plus_plus():
    defaults = _core.option_defaults()
    compared = 0
    for struct, columns in TABLE.items():
        for option, row in columns["rows"].items():
            name = row.get("python", option)
            if name in defaults[struct] and row["type"] != "reserved":
                expected = row.get("default")
                expected = 1 / 60 if expected == "1/60" else tuple(expected) if isinstance(expected, list) else expected
                assert defaults[struct][name] == expected, (struct, option)
                compared += 1
    assert compared > 50
