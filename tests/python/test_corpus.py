"""Labels of a corpus: right, the same bytes whoever computes them, whole or absent; and read by the loaders of others."""

import contextlib
import io
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import statistics
import subprocess
import sys
import tarfile
import threading
import time
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, strategies

import echinus as ech
from echinus import corpus
from echinus.corpus import _command, _engines, _locks, _random, _samples, _tasks, _verification
from support import open_torus, torus

SMALL = corpus.Sampling(uniform=300, near=200, sigmas=(0.01, 0.1), surface=100)
SIDES = replace(SMALL, distances=False)  # as the command takes them for occupancies


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Twelve good meshes, one open, and some that are to be refused."""
    folder = tmp_path_factory.mktemp("meshes")
    for i in range(6):
        (folder / f"class_{i % 2}").mkdir(exist_ok=True)
        ech.write_mesh(folder / f"class_{i % 2}" / f"torus_{i}.obj", ech.make_torus(1 + i, 0.4, 12 + i, 8))
        ech.write_mesh(folder / f"class_{i % 2}" / f"sphere_{i}.ply", ech.make_sphere(1, 8 + i, 6))
    ech.write_mesh(folder / "open.off", open_torus())
    (folder / "broken.obj").write_text("v 0 0 0\nf 1 2 3\n")
    (folder / "empty.stl").write_bytes(b"")
    (folder / "flat.obj").write_text("v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n")
    return folder


def corpus_of(folder, output, **options):
    sampling = SMALL if options.get("form", "occupancy") != "occupancy" else SIDES
    return corpus.Corpus(corpus.find_meshes([folder]), output, **{"sampling": sampling, "archive_size": 4, **options})


def bytes_below(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


# ---- Samples


def test_labels_are_those_of_the_points_as_they_are_stored():
    for dtype in ("float16", "float32"):
        s = corpus.sample(torus(), corpus.Sampling(uniform=2000, near=2000, surface=10, dtype=dtype))
        assert s.points.dtype == s.surface.dtype == dtype
        framed = ech.Mesh((torus().vertices.astype(float) - s.loc) / s.scale, torus().faces)
        truth, distance = ech.winding_number(framed, s.points) > 0.5, ech.unsigned_distance(framed, s.points)
        clear = distance > 1e-5
        assert clear.mean() > 0.99 and np.array_equal(s.occupancy[clear], truth[clear])
        assert np.abs(np.abs(s.distance) - distance).max() < 1e-5
        assert np.array_equal(s.distance[clear] < 0, truth[clear])
        assert ech.unsigned_distance(framed, s.nearest).max() < 1e-5
        assert s.certain.all() and s.report["closed"]


def test_samples_near_the_surface_are_as_far_as_their_sigmas_say():
    s = corpus.sample(ech.make_box((1, 1, 1), 1), corpus.Sampling(uniform=0, near=40_000, sigmas=(0.001, 0.01), surface=0))
    for part, sigma in zip(np.split(s.distance, 2), (0.001, 0.01)):
        assert part.std() == pytest.approx(sigma, rel=0.03)  # along the normal of a side


@given(areas=strategies.lists(strategies.sampled_from([0.0, 1e-30, 1e-7, 1.0, 3.0, 1e7]), min_size=1, max_size=300), seed=strategies.integers(0, 99))
def test_faces_are_those_that_a_search_of_all_areas_finds(areas, seed):
    assume(max(areas) > 0)
    feet = np.arange(len(areas), dtype=np.float64)
    triangles = np.zeros((len(areas), 3, 3))
    triangles[:, :, 0] = feet[:, None]
    triangles[:, 1, 1], triangles[:, 2, 2] = np.sqrt(areas), np.sqrt(areas)
    surface = _samples._Surface(ech.Mesh(triangles.reshape(-1, 3), np.arange(3 * len(areas)).reshape(-1, 3)))
    share = np.concatenate([np.random.default_rng(seed).random(200), [0, 1 - 2.0**-53], surface._total / surface._total[-1]])
    share = share[share < 1]
    found = np.searchsorted(surface._total, share * surface._total[-1], side="right")
    assert (surface._find(share) == np.minimum(found, len(areas) - 1)).all()


def test_samples_of_the_surface_are_even_by_area_and_have_the_normals_of_their_faces():
    box = ech.make_box((1, 2, 4), 1)
    s = corpus.sample(box, corpus.Sampling(uniform=0, near=0, surface=28_000))
    shares = [(np.abs(s.normals[:, axis]) > 0.9).mean() for axis in range(3)]
    assert shares == pytest.approx([8 / 14, 4 / 14, 2 / 14], abs=0.01)
    assert np.abs(np.abs(s.normals).max(axis=1) - 1).max() < 1e-6
    assert ech.unsigned_distance(box, s.surface.astype(float) * s.scale + s.loc).max() < 1e-6


@pytest.mark.parametrize("frame, extent", [("cube", 1), ("sphere", 2 / 1.03), ("none", 2.8)])
def test_a_frame_is_what_it_says(frame, extent):
    mesh = ech.Mesh(torus().vertices + np.float32([3, 4, 5]), torus().faces)
    s = corpus.sample(mesh, corpus.Sampling(uniform=20_000, near=0, surface=4000, frame=frame, padding=0.1))
    assert np.ptp(s.surface[:, 0]) == pytest.approx(extent, rel=0.01)
    box = {"cube": 1.1, "sphere": 2, "none": 2.8 * 1.1}[frame]
    assert np.ptp(s.points[:, 0]) == pytest.approx(box, rel=0.01)
    assert np.allclose(s.surface.mean(axis=0) * s.scale + s.loc, [3, 4, 5], atol=0.05)


@pytest.mark.parametrize("mesh", [torus(), open_torus()])
def test_sides_without_distances_are_the_same(mesh):
    sides, all_of_it = corpus.sample(mesh, SIDES), corpus.sample(mesh, SMALL)
    assert len(sides.distance) == len(sides.nearest) == 0
    for name in ("points", "occupancy", "certain", "surface", "normals"):
        assert np.array_equal(getattr(sides, name), getattr(all_of_it, name)), name
    with pytest.raises(ValueError, match="need distances"):
        corpus.Corpus([], "out", form="deepsdf", sampling=SIDES)


def test_samples_depend_on_the_mesh_and_the_seed_only():
    a, b = corpus.sample(torus(), SMALL), corpus.sample(ech.Mesh(torus().vertices.copy(), torus().faces.astype(int)), SMALL)
    assert np.array_equal(a.points, b.points)
    other_seed = corpus.sample(torus(), replace(SMALL, seed=1))
    other_mesh = corpus.sample(ech.make_torus(1, 0.4, 30, 13), SMALL)
    assert not np.array_equal(a.points, other_seed.points) and not np.array_equal(a.points, other_mesh.points)


def test_more_of_one_kind_does_not_change_another():
    more = corpus.sample(torus(), replace(SMALL, near=0, surface=0))
    assert np.array_equal(more.points, corpus.sample(torus(), SMALL).points[:300])


def test_a_mesh_that_is_not_to_be_labelled_is_refused_with_a_reason():
    cases = [
        (torus(), {"max_faces": 100}, "it has 720 faces; at most 100"),
        (open_torus(), {"min_certain": 1.0}, "% of its labels are certain"),
        (torus(), {"time_limit": 1e-9}, "take longer than"),
        (ech.Mesh(np.zeros((3, 3)), [[0, 1, 2]]), {}, "its extent is 0; it must be between 1e-30 and 1e\\+30"),
        (ech.Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]]), {}, "no area"),
        (ech.Mesh(torus().vertices * 1e6, torus().faces), {"frame": "none", "dtype": "float16"}, "do not fit into float16"),
        (ech.Mesh(torus().vertices * 1e6, torus().faces), {"frame": "none", "dtype": "float16", "uniform": 0, "near": 0}, "do not fit into float16"),
        (torus(), {"sigmas": (1e30,), "dtype": "float16"}, "do not fit into float16"),
    ]
    for mesh, options, reason in cases:
        with pytest.raises(corpus.Refused, match=reason) as refusal:  # and without a warning of NumPy
            corpus.sample(mesh, replace(SMALL, **options))
        assert refusal.value.again == ("time_limit" in options)
    assert 0 < corpus.sample(open_torus(), SMALL).certain.mean() < 1


def test_meshes_become_solid_on_request_and_the_report_says_how():
    def sampled(mesh, **options):
        return corpus.sample(mesh, replace(SMALL, **options))

    filled = sampled(ech.Mesh(torus().vertices, torus().faces[7:]), close_holes=16)
    assert filled.report["made_solid"]["holes_closed"] >= 1 and filled.report["closed"] and filled.certain.all()

    corners = torus().vertices[torus().faces]
    middles = corners.mean(axis=1, keepdims=True)
    apart = (middles + np.float32(0.9) * (corners - middles)).reshape(-1, 3)  # no seams, which would be closed
    soup = ech.Mesh(apart, np.arange(len(apart)).reshape(-1, 3))
    shell = sampled(soup, thicken=0.02)
    assert shell.report["made_solid"]["sheets_thickened"] == len(torus().faces) and shell.report["closed"]
    box = max(torus().vertices.max(axis=0) - torus().vertices.min(axis=0))
    by_hand, _ = ech.repair(soup, sheet_thickness=0.02 * float(box))
    in_shell = ech.ExactMap(by_hand).contains(shell.points.astype(float) * shell.scale + shell.loc)
    assert (in_shell == shell.occupancy).mean() > 0.99 and 0 < shell.occupancy.mean() < 0.6

    engine = ech.Mesh(torus().vertices / 4 + np.float32([0, 1, 0]), torus().faces)
    twice = ech.Mesh(
        np.concatenate([torus().vertices, engine.vertices]), np.concatenate([torus().faces, engine.faces + len(torus().vertices)])
    )
    assert sampled(twice, drop_inner_faces=True).report["made_solid"]["inner_faces_dropped"] == len(engine.faces)
    assert "made_solid" not in sampled(open_torus()).report
    with pytest.raises(ech.Error, match="thickness"):
        sampled(open_torus(), thicken=1e-7)


@pytest.mark.parametrize("name, values, range_", [
    ("close_holes", (257, -1), "a whole number from 0 to 256"),
    ("thicken", (-1.0, 0.6, np.nan), "a number from 0 to 0.5"),
    ("uniform", (-1, 1 << 32), "a whole number from 0 to 4294967295"),
    ("sigmas", ((), (0.1, -1.0), (1e300,), (np.nan,)), "positive numbers up to 1e+30"),
    ("padding", (-1.0, np.nan, 1e300), "a number from 0 to 1e+30"),
    ("min_certain", (2.0, -0.1, np.nan), "a number from 0 to 1"),
    ("time_limit", (0.0, -1.0, np.nan), "a positive number of seconds"),
    ("seed", (-1, 1 << 63), "a whole number from 0 to 9223372036854775807"),
])
def test_a_setting_out_of_range_is_named_with_its_range(name, values, range_):
    for value in values:
        with pytest.raises(ValueError, match=re.escape(f"{name} must be {range_}, not {value}")):
            corpus.Sampling(**{name: value})


@pytest.mark.parametrize("of, wrong, error, words", [
    (corpus.Sampling, {"frame": "square"}, ValueError, "frame must be 'cube', 'sphere' or 'none', not 'square'"),
    (corpus.Sampling, {"dtype": "float64"}, ValueError, "dtype must be 'float16' or 'float32', not 'float64'"),
    (corpus.Sampling, {"dtype": np.float32}, TypeError, "dtype must be a str, not <class 'numpy.float32'>"),
    (corpus.Sampling, {"sigmas": 0.1}, TypeError, "sigmas must be numbers, not 0.1"),
    (corpus.Sampling, {"sigmas": ("a",)}, TypeError, "each of sigmas must be a number, not 'a'"),
    (corpus.Sampling, {"padding": "a"}, TypeError, "padding must be a number, not 'a'"),
    (corpus.Sampling, {"seed": 1.5}, TypeError, "seed must be a whole number, not 1.5"),
    (corpus.Sampling, {"repair": "no"}, TypeError, "repair must be True or False, not 'no'"),
    (corpus.Corpus, {"form": "npz"}, ValueError, "form must be 'occupancy', 'deepsdf' or 'webdataset', not 'npz'"),
    (corpus.Corpus, {"sampling": {}}, TypeError, "sampling must be of the class Sampling, not dict"),
    (corpus.Corpus, {"archive_size": "4"}, TypeError, "archive_size must be a whole number, not '4'"),
    (corpus.Corpus, {"max_bytes": -1}, ValueError, "max_bytes must be a whole number from 0"),
    (corpus.Corpus, {"shard": 3}, TypeError, "shard must be (i, n), not 3"),
    (corpus.Corpus, {"meshes": ["a.obj"]}, TypeError, "meshes[0] must be (name, path), as find_meshes() gives them, not 'a.obj'"),
    (corpus.Corpus, {"meshes": None}, TypeError, "meshes must be a list of (name, path), not None"),
    (corpus.Corpus, {"meshes": [("a", "a.obj"), ("a", "b.obj")]}, ValueError, "b.obj would both be labelled as a"),
    (corpus.Corpus, {"meshes": [(".unfinished", "a.obj")]}, ValueError, "meshes[0]: its labels would go to '.unfinished' in the output folder"),
    (corpus.Corpus, {"meshes": [("../a", "a.obj")]}, ValueError, "meshes[0]: its labels would go to '../a' in the output folder"),
])
def test_settings_of_another_kind_are_named(of, wrong, error, words):
    needed = {"meshes": [], "output": "out"} if of is corpus.Corpus else {}
    with pytest.raises(error, match=re.escape(words)):
        of(**{**needed, **wrong})


def test_numbers_of_numpy_are_settings_like_others(folder, tmp_path):
    sampling = replace(SIDES, uniform=np.int64(300), sigmas=np.array([0.01, 0.1]), padding=np.float32(0.5))
    summary = corpus.label(corpus.Corpus(corpus.find_meshes([folder / "class_0"]), tmp_path, sampling=sampling), workers=1)
    assert summary.labelled == 6


# ---- Random numbers


@given(strategies.floats(1e-300, 0.5))
def test_normal_quantiles_agree_with_the_library_of_python(p):
    expected = statistics.NormalDist().inv_cdf(p)
    assert _random.normal_quantile(np.array([p, 1 - p]))[0] == pytest.approx(expected, rel=2e-9, abs=1e-9)


def test_random_numbers_are_recorded_ones():
    random = _random.Random(b"key")
    assert random.uniform(3).tolist() == RECORDED_UNIFORM
    assert random.normal(2).tolist() == RECORDED_NORMAL


RECORDED_UNIFORM = [0.22783940722903906, 0.38930734575340054, 0.9159237802093166]
RECORDED_NORMAL = [0.25815513066825724, -1.24686766262255]


def test_random_numbers_have_the_moments_of_their_distributions():
    random = _random.Random(b"moments")
    u, n = random.uniform(200_000), random.normal(200_000)
    assert u.mean() == pytest.approx(0.5, abs=0.003) and 0 <= u.min() and u.max() < 1
    assert n.mean() == pytest.approx(0, abs=0.01) and n.std() == pytest.approx(1, abs=0.01)
    assert (n**4).mean() == pytest.approx(3, abs=0.1)


# ---- Formats, read as others read them


def test_occupancy_networks_reads_the_points(folder, tmp_path):
    corpus.label(corpus_of(folder, tmp_path), workers=2)
    model = tmp_path / "class_0" / "torus_0"
    # As PointsField and PointCloudField of occupancy_networks/im2mesh/data/fields.py take them.
    points_dict = np.load(model / "points.npz")
    points, occupancies = points_dict["points"], np.unpackbits(points_dict["occupancies"])[: len(points_dict["points"])]
    assert points.shape == (500, 3) and set(np.unique(occupancies)) == {0, 1}
    cloud = np.load(model / "pointcloud.npz")
    assert cloud["points"].shape == cloud["normals"].shape == (100, 3)
    world = points * points_dict["scale"] + points_dict["loc"]
    mesh = ech.read_mesh(folder / "class_0" / "torus_0.obj")
    clear = ech.unsigned_distance(mesh, world) > 1e-5
    assert np.array_equal(occupancies[clear] == 1, (ech.winding_number(mesh, world) > 0.5)[clear])


def test_deepsdf_reads_the_distances(folder, tmp_path):
    corpus.label(corpus_of(folder, tmp_path, form="deepsdf", sampling=corpus.Sampling(uniform=300, near=200, frame="sphere")), workers=2)
    npz = np.load(tmp_path / "class_1" / "torus_1.npz")
    # As unpack_sdf_samples of deep_sdf/data.py takes them: rows x, y, z, distance.
    positive, negative = npz["pos"], npz["neg"]
    assert positive.shape[1] == negative.shape[1] == 4 and len(positive) + len(negative) == 500
    assert (positive[:, 3] >= 0).all() and (negative[:, 3] < 0).all()
    mesh = ech.read_mesh(folder / "class_1" / "torus_1.obj")
    for rows in (positive, negative):
        world = rows[:, :3].astype(float) / npz["scale"] - npz["offset"]
        assert np.allclose(ech.unsigned_distance(mesh, world), np.abs(rows[:, 3]) / npz["scale"], atol=1e-5)


def samples_of_archives(folder):
    """As WebDataset groups them: members in a row whose names are equal up to the first dot of the last part."""
    for path in sorted(folder.glob("*.tar")):
        with tarfile.open(path) as archive:
            sample = {}
            for member in archive:
                place, slash, name = member.name.rpartition("/")
                stem, _, extension = name.partition(".")
                if sample and sample["__key__"] != place + slash + stem:
                    yield sample
                    sample = {}
                sample |= {"__key__": place + slash + stem, extension: archive.extractfile(member).read()}
            if sample:
                yield sample


def test_webdataset_reads_the_samples(folder, tmp_path):
    corpus.label(corpus_of(folder, tmp_path, form="webdataset"), workers=2)
    samples = {s["__key__"]: s for s in samples_of_archives(tmp_path)}
    assert len(samples) == 13 and len(list(tmp_path.glob("*.tar"))) == 4
    one = {name: np.load(io.BytesIO(data)) for name, data in samples["class_0/torus_0"].items() if name.endswith(".npy")}
    expected = corpus.sample(ech.read_mesh(folder / "class_0" / "torus_0.obj"), SMALL)
    for name in ("points", "occupancy", "distance", "nearest", "certain", "surface", "normals"):
        assert np.array_equal(one[f"{name}.npy"], getattr(expected, name)), name
    assert json.loads(samples["open"]["json"])["closed"] is False


# ---- The same bytes, whoever computes them


@pytest.fixture(scope="module", params=["occupancy", "webdataset"])
def reference(request, folder, tmp_path_factory):
    output = tmp_path_factory.mktemp("reference")
    summary = corpus.label(corpus_of(folder, output, form=request.param), workers=1)
    assert (summary.labelled, summary.refused) == (13, 3)
    return request.param, bytes_below(output)


def test_two_workers_give_the_same_bytes(folder, tmp_path, reference):
    corpus.label(corpus_of(folder, tmp_path, form=reference[0]), workers=2)
    assert bytes_below(tmp_path) == reference[1]


def test_solids_have_the_same_bytes_with_more_workers(folder, tmp_path):
    solid = replace(SIDES, close_holes=64, drop_inner_faces=True, thicken=0.01)
    for workers in (1, 2):
        corpus.label(corpus_of(folder, tmp_path / str(workers), sampling=solid), workers=workers)
    assert bytes_below(tmp_path / "1") == bytes_below(tmp_path / "2")
    assert '"made_solid"' in (tmp_path / "1" / "manifest.jsonl").read_text()


def test_parts_of_the_work_give_the_same_files(folder, tmp_path, reference):
    for i in (2, 0, 1):
        part = corpus_of(folder, tmp_path, form=reference[0], shard=(i, 3))
        corpus.label(part, workers=1)
    files = {name: data for name, data in bytes_below(tmp_path).items() if "manifest" not in name}
    assert files == {name: data for name, data in reference[1].items() if "manifest" not in name}
    lines = sorted(line for path in tmp_path.glob("manifest-*") for line in path.read_text().splitlines()[1:])
    assert lines == sorted(reference[1]["manifest.jsonl"].decode().splitlines()[1:])
    assert corpus.verify(corpus_of(folder, tmp_path, form=reference[0])) == []


def workers():
    """The children of this process that label."""
    children = pathlib.Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()
    return [int(p) for p in children if b"spawn_main" in pathlib.Path(f"/proc/{p}/cmdline").read_bytes()]


@pytest.mark.seldom
def test_workers_may_be_killed(folder, tmp_path, reference, monkeypatch):
    """At any time: while they start, while they compute, and while they write."""
    monkeypatch.setattr(_engines, "ATTEMPTS", 100)
    waits = [0.05, *np.random.default_rng(1).uniform(0.05, 0.6, 9)]  # seconds; no worker is done before the first
    done, killed = threading.Event(), []

    def kill():
        for seconds in waits:
            if done.wait(seconds):
                return
            for worker in workers()[:1]:
                with contextlib.suppress(ProcessLookupError):  # it ended by itself meanwhile
                    os.kill(worker, signal.SIGKILL)
                    killed.append(worker)

    killer = threading.Thread(target=kill)
    killer.start()
    try:
        corpus.label(corpus_of(folder, tmp_path, form=reference[0]), workers=2)
    finally:
        done.set()
        killer.join()
    assert bytes_below(tmp_path) == reference[1] and killed


@pytest.mark.parametrize("how, seconds", [(signal.SIGKILL, 0.6), (signal.SIGKILL, 1.2), (signal.SIGINT, 1.0)])
@pytest.mark.seldom
def test_a_run_that_was_ended_goes_on_where_it_was(folder, tmp_path, reference, how, seconds):
    command = [sys.executable, "-m", "echinus", "label", str(folder), "-o", str(tmp_path), "--format", reference[0], "--archive-size", "4",
               "--uniform", "300", "--near", "200", "--sigmas", "0.01,0.1", "--surface", "100", "--workers", "2"]
    run = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    time.sleep(seconds)
    run.send_signal(how)
    run.wait()
    subprocess.run(command, check=True, capture_output=True)
    assert bytes_below(tmp_path) == reference[1]
    verdict = subprocess.run([*command, "--verify"], check=True, capture_output=True, text=True)
    assert "16 meshes, 3 of them refused: each of the others has its labels once, unchanged" in verdict.stdout


@pytest.mark.skipif(sys.platform != "linux", reason="asks /proc")
@pytest.mark.seldom
def test_workers_end_with_a_run_that_is_killed(folder, tmp_path):
    command = [sys.executable, "-m", "echinus", "label", str(folder / "class_0"), "-o", str(tmp_path), "--format", "deepsdf", "--uniform", "20000000", "--workers", "1"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as main:
        children = pathlib.Path(f"/proc/{main.pid}/task/{main.pid}/children")
        until(lambda: len(children.read_text().split()) >= 2)  # a worker, and the tracker of resources
        workers = children.read_text().split()
        until(lambda: max(map(resident_pages, workers)) > 100_000)  # with its samples
        main.kill()
    until(lambda: not any(map(goes_on, workers)), seconds=3)  # its task takes longer


def test_workers_are_deaf_to_interrupts_from_their_first_moment(folder, tmp_path):
    task = corpus_of(folder, tmp_path).tasks(str(tmp_path))[-1]
    worker = _engines._Worker(1 << 32)
    try:
        os.kill(worker.process.pid, signal.SIGINT)
        worker.give(task)
        assert [record["mesh"] for record in worker.take() if "mesh" in record] == [task.meshes[0][0]]
    finally:
        worker.stop()
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, [])


def resident_pages(process):
    return int(pathlib.Path("/proc", process, "statm").read_text().split()[1])


def goes_on(process):
    with contextlib.suppress(FileNotFoundError, ProcessLookupError):
        return pathlib.Path("/proc", process, "stat").read_text().rpartition(")")[2].split()[0] != "Z"
    return False


def until(holds, seconds=60):
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.05)


def test_a_second_run_computes_nothing(folder, tmp_path):
    first = corpus.label(corpus_of(folder, tmp_path), workers=2)
    before = bytes_below(tmp_path)
    again = corpus.label(corpus_of(folder, tmp_path), workers=2)
    assert (first.labelled + first.refused, again.already, again.labelled, again.refused) == (16, 16, 0, 0)
    assert bytes_below(tmp_path) == before


def test_other_settings_need_another_folder(folder, tmp_path):
    corpus.label(corpus_of(folder, tmp_path), workers=1)
    other = corpus_of(folder, tmp_path, sampling=replace(SIDES, uniform=7))
    with pytest.raises(ValueError, match="manifest.jsonl: .* made with other settings: uniform was 300, and is 7 now"):
        corpus.label(other, workers=1)
    assert "uniform was 300, and is 7 now" in corpus.verify(other)[0]


def test_all_parts_of_a_folder_have_the_same_settings_and_are_as_many(folder, tmp_path):
    corpus.label(corpus_of(folder, tmp_path, shard=(0, 2)), workers=1)
    before = bytes_below(tmp_path)
    other = replace(SIDES, seed=5)
    for options, words in [
        ({"shard": (1, 2), "sampling": other}, "made with other settings: seed was 0, and is 5 now"),
        ({"shard": (1, 3)}, r"made in 2 parts \(--shard i/2\), now 3 parts \(--shard i/3\)"),
        ({}, r"made in 2 parts \(--shard i/2\), now one part \(no --shard\)"),
    ]:
        with pytest.raises(ValueError, match="manifest-0-of-2.jsonl: .*" + words):
            corpus.label(corpus_of(folder, tmp_path, **options), workers=1)
    assert bytes_below(tmp_path) == before
    corpus.label(corpus_of(folder, tmp_path, shard=(1, 2)), workers=1)
    assert corpus.verify(corpus_of(folder, tmp_path)) == []


def test_parts_that_begin_at_once_have_the_same_settings(folder, tmp_path):
    def begun(i):
        command = [sys.executable, "-m", "echinus", "label", str(folder / "class_0"), "-o", str(tmp_path), "--uniform", "9", "--near", "9", "--surface", "9"]
        return subprocess.Popen([*command, "--shard", f"{i}/2", "--seed", str(i)], stderr=subprocess.PIPE, text=True)

    runs = [begun(0), begun(1)]
    said = [run.communicate(timeout=60)[1] for run in runs]
    assert sorted(run.returncode for run in runs) == [0, 1]
    assert "made with other settings: seed was" in said[0] + said[1]


def test_a_run_that_ends_before_its_first_label_binds_no_other(folder, tmp_path, monkeypatch):
    def broken(tasks, **_):
        raise RuntimeError("no worker")

    with monkeypatch.context() as patched:
        patched.setattr(_engines, "on_processes", broken)
        with pytest.raises(RuntimeError, match="no worker"):
            corpus.label(corpus_of(folder, tmp_path))
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def own_folder(tmp_path):
    folder = tmp_path / "meshes"
    folder.mkdir()
    for i in range(3):
        ech.write_mesh(folder / f"box_{i}.ply", ech.make_box((1, 1, 1 + i), 2))
    return folder


@pytest.mark.parametrize("form", ["occupancy", "webdataset"])
def test_a_mesh_file_that_has_changed_is_labelled_anew(own_folder, tmp_path, form):
    def corpus_in(output):
        return corpus_of(own_folder, tmp_path / output, form=form, archive_size=2)

    corpus.label(corpus_in("labels"), workers=1)
    mesh, before = own_folder / "box_2.ply", (own_folder / "box_2.ply").stat()
    ech.write_mesh(mesh, ech.make_box((1, 1, 7), 2))
    os.utime(mesh, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert mesh.stat().st_size == before.st_size  # neither its date nor its size tells
    assert corpus.verify(corpus_in("labels")) == [f"box_2: {mesh} has changed since it was labelled; the same command without --verify labels it again"]
    summary = corpus.label(corpus_in("labels"), workers=1)
    assert (summary.already, summary.labelled) == (2, 1)
    assert corpus.verify(corpus_in("labels")) == []
    corpus.label(corpus_in("at once"), workers=1)
    assert bytes_below(tmp_path / "labels") == bytes_below(tmp_path / "at once")


def test_a_mesh_that_was_mended_or_added_after_its_refusal_is_labelled(own_folder, tmp_path):
    mesh = own_folder / "box_1.ply"
    good = mesh.read_bytes()
    (tmp_path / "list.txt").write_text("".join(f"{own_folder}/box_{i}.ply\n" for i in range(3)))
    c = corpus.Corpus(corpus.find_meshes([tmp_path / "list.txt"]), tmp_path / "labels", sampling=SIDES)
    for make_bad in (mesh.unlink, lambda: mesh.write_bytes(good[:-20])):
        make_bad()
        shutil.rmtree(tmp_path / "labels", ignore_errors=True)
        summary = corpus.label(c, workers=1)
        assert (summary.refused, summary.again) == (1, 0) and corpus.verify(c) == []
        assert corpus.label(c, workers=1).already == 3  # the same refusal is not repeated
        mesh.write_bytes(good)
        (complaint,) = corpus.verify(c)
        assert f"{mesh} has changed since it was refused" in complaint
        assert corpus.label(c, workers=1).labelled == 1 and corpus.verify(c) == []


def test_paths_of_meshes_are_absolute_since_workers_may_stand_elsewhere(own_folder, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for meshes in (corpus.find_meshes("meshes"), [("box_0", "meshes/box_0.ply")]):
        assert corpus.Corpus(meshes, "labels").meshes[0] == ("box_0", str(own_folder / "box_0.ply"))


def test_a_mesh_whose_file_has_another_extension_now_is_labelled_anew(own_folder, tmp_path):
    c = corpus_of(own_folder, tmp_path / "labels")
    corpus.label(c, workers=1)
    for before, after in ((".ply", ".stl"), (".stl", ".ply")):  # whoever reads it goes by its extension
        os.rename(own_folder / f"box_1{before}", own_folder / f"box_1{after}")
        c = corpus_of(own_folder, tmp_path / "labels")
        assert f"box_1{after} has changed since" in corpus.verify(c)[0]
        assert corpus.label(c, workers=1).refused == (after == ".stl") and corpus.verify(c) == []


def test_labels_stay_while_their_mesh_file_cannot_be_read(own_folder, tmp_path):
    (tmp_path / "list.txt").write_text("".join(f"{own_folder}/box_{i}.ply\n" for i in range(3)))
    c = corpus.Corpus(corpus.find_meshes(tmp_path / "list.txt"), tmp_path / "labels", sampling=SIDES)
    corpus.label(c, workers=1)
    before = bytes_below(tmp_path / "labels")
    (own_folder / "box_1.ply").unlink()
    assert corpus.label(c, workers=1).already == 3 and bytes_below(tmp_path / "labels") == before
    (complaint,) = corpus.verify(c)
    assert "box_1.ply cannot be read any more; the mesh was labelled, and stays so" in complaint


def test_a_gltf_that_was_refused_is_tried_again_since_its_other_files_may_have_come(own_folder, tmp_path):
    (own_folder / "scene.gltf").write_text('{"asset":{"version":"2.0"},"buffers":[{"uri":"scene.bin","byteLength":36}]}')
    assert corpus.label(corpus_of(own_folder, tmp_path / "labels"), workers=1).again == 1


@pytest.mark.parametrize("form", ["occupancy", "deepsdf"])
@pytest.mark.seldom
def test_a_worker_that_outlives_its_run_finishes_no_file(own_folder, tmp_path, form):
    """As those of a cluster do."""
    c = corpus_of(own_folder, tmp_path / "labels", form=form)
    given = []

    def remember(tasks, **_):
        given.extend(tasks)
        raise RuntimeError("the cluster has gone")

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(_engines, "on_processes", remember)
        with pytest.raises(RuntimeError, match="has gone"):
            corpus.label(c)
    for task in given:
        with pytest.raises(OSError):
            _tasks.run(task)
    assert corpus.label(c, workers=1).labelled == 3 and corpus.verify(c) == []


def test_files_without_a_record_go_when_their_mesh_is_refused(own_folder, tmp_path):
    """A run that was killed has written them, or one of another part did, before meshes came into the corpus."""
    parts = [corpus_of(own_folder, tmp_path / "labels", shard=(i, 2)) for i in range(2)]
    for part in parts:
        corpus.label(part, workers=1)
    ech.write_mesh(own_folder / "a.ply", ech.make_box((1, 1, 1), 1))  # the others are of the other part now
    (own_folder / "box_1.ply").write_bytes(b"ply\n")
    for i in range(2):
        corpus.label(corpus_of(own_folder, tmp_path / "labels", shard=(i, 2)), workers=1)
    assert corpus.verify(corpus_of(own_folder, tmp_path / "labels")) == []


def test_meshes_beside_their_labels_are_not_surplus(own_folder):
    c = corpus_of(own_folder, own_folder)
    corpus.label(c, workers=1)
    assert corpus.verify(c) == []


def test_a_file_of_labels_that_cannot_be_read_is_one_complaint(own_folder, tmp_path):
    c = corpus_of(own_folder, tmp_path)
    corpus.label(c, workers=1)
    for name in ("box_0", "box_2"):
        (tmp_path / name / "points.npz").unlink()
    (tmp_path / "box_0" / "points.npz").symlink_to("points.npz")
    complaints = corpus.verify(c)
    assert any(text.startswith("box_0/points.npz: ") for text in complaints) and any(text.startswith("box_2/points.npz: is missing") for text in complaints)


def test_a_mesh_that_is_refused_after_a_change_keeps_no_labels(own_folder, tmp_path):
    c = corpus_of(own_folder, tmp_path / "labels")
    corpus.label(c, workers=1)
    assert (tmp_path / "labels" / "box_0").exists()
    (own_folder / "box_0.ply").write_bytes(b"ply\n")
    assert corpus.label(c, workers=1).refused == 1
    assert corpus.verify(c) == [] and not (tmp_path / "labels" / "box_0").exists()


@pytest.mark.parametrize("form", ["occupancy", "webdataset"])
def test_a_corpus_may_change(folder, tmp_path, form):
    everything = corpus_of(folder, tmp_path / "labels", form=form)
    fewer = replace(everything, meshes=[mesh for mesh in everything.meshes if mesh[0] not in ("class_0/sphere_2", "open")])
    for meshes in (everything, fewer, everything):
        corpus.label(meshes, workers=1)
    assert corpus.verify(everything) == []
    corpus.label(replace(everything, output=tmp_path / "at once"), workers=1)
    assert bytes_below(tmp_path / "labels") == bytes_below(tmp_path / "at once")


@pytest.mark.parametrize("form, left", [("occupancy", ["open/pointcloud.npz", "open/points.npz"]), ("webdataset", ["labels-000003.tar"])])
def test_files_of_a_mesh_that_was_taken_out_are_named_until_they_are_removed(folder, tmp_path, form, left):
    before = corpus_of(folder, tmp_path, form=form)
    corpus.label(before, workers=1)
    after = replace(before, meshes=[mesh for mesh in before.meshes if mesh[0] != "open"][:12])
    if form == "webdataset":
        assert "labels-000003.tar: belongs to no labelled mesh of the corpus" in corpus.verify(after)
    corpus.label(after, workers=1)
    gone = {name for name, _ in before.meshes} - {name for name, _ in after.meshes}
    surplus = corpus.verify(after)
    assert [f"{name}: belongs to no labelled mesh of the corpus" for name in left] == [s for s in surplus if s.startswith(("open", "labels"))]
    for sentence in surplus:
        assert form == "webdataset" or sentence.partition("/points")[0].partition("/pointcloud")[0] in gone
        (tmp_path / sentence.partition(":")[0]).unlink()
    assert corpus.verify(after) == []


def test_archives_tell_that_the_corpus_has_changed(folder, tmp_path):
    before = corpus_of(folder, tmp_path, form="webdataset")
    corpus.label(before, workers=1)
    after = replace(before, meshes=before.meshes[1:])
    assert any("as before the corpus changed" in sentence for sentence in corpus.verify(after))
    corpus.label(after, workers=1)
    assert corpus.verify(after) == []
    assert len(list(samples_of_archives(tmp_path))) == len({s["__key__"] for s in samples_of_archives(tmp_path)})


def test_an_archive_of_refused_meshes_is_done(folder, tmp_path):
    refused = [mesh for mesh in corpus_of(folder, tmp_path).meshes if mesh[0] in ("broken", "empty", "flat")]
    c = replace(corpus_of(folder, tmp_path, form="webdataset"), meshes=refused)
    assert (corpus.label(c, workers=1).refused, corpus.label(c, workers=1).already) == (3, 3)
    assert corpus.verify(c) == []


def test_two_runs_do_not_write_the_same_labels_at_once(folder, tmp_path):
    with _locks.alone(corpus_of(folder, tmp_path)):
        with pytest.raises(ValueError, match="another run is writing these labels"):
            corpus.label(corpus_of(folder, tmp_path), workers=1)
        with pytest.raises(ValueError, match="another run is writing these labels"):
            corpus.label(corpus_of(folder, tmp_path, shard=(0, 16)), workers=1)
    with _locks.alone(corpus_of(folder, tmp_path, shard=(1, 16))):
        corpus.label(corpus_of(folder, tmp_path, shard=(0, 16)), workers=1)
        with pytest.raises(ValueError, match="another run is writing these labels"):
            corpus.label(corpus_of(folder, tmp_path), workers=1)


# ---- What is refused, and what is wrong


def test_a_manifest_that_is_none_is_an_error_that_names_its_line(folder, tmp_path):
    corpus.label(corpus_of(folder, tmp_path), workers=1)
    manifest = tmp_path / "manifest.jsonl"
    manifest.write_bytes(manifest.read_bytes().splitlines(keepends=True)[0] + b"\xff garbage\n")
    for run in (corpus.label, corpus.verify):
        with pytest.raises(ValueError, match="manifest.jsonl, line 2 is not a record"):
            run(corpus_of(folder, tmp_path))


@pytest.mark.parametrize("line", ["1", "null", '"mesh"', "[]", "{}", '{"mesh":1}', '{"mesh":"a","files":"b"}', '{"file":"a"}', '{"mesh":"a","file":"b"}', "[" * 100_000, '{"echinus":1,"files":["x"]}', '{"file":"a","bytes":"x","sha256":""}', '{"mesh":"a","files":[]}', '{"mesh":"a"}',
                                  '{"mesh":"a","echinus":1,"files":["a"]}', 
                                  '{"file":"\\u0000","bytes":1,"sha256":""}', '{"file":"../a","bytes":1,"sha256":""}', '{"mesh":"a","files":["/dev/zero"]}'])
def test_a_line_of_a_manifest_that_is_json_but_no_record_is_named(folder, tmp_path, line):
    c = corpus_of(folder, tmp_path)
    settings = json.dumps(c.settings())
    for lines, number in ((f"{line}\n", 1), (f"{settings}\n{line}\n", 2)):
        (tmp_path / "manifest.jsonl").write_text(lines)
        for run in (corpus.label, corpus.verify):
            with pytest.raises(ValueError, match=f"manifest.jsonl, line {number} is not a record .*remove the file"):
                run(c)


def test_a_manifest_that_is_no_file_is_an_error(folder, tmp_path):
    os.mkfifo(tmp_path / "manifest.jsonl")  # nobody writes to it
    for run in (corpus.label, corpus.verify):
        with pytest.raises(ValueError, match="manifest.jsonl is not a file; remove it, or choose another folder"):
            run(corpus_of(folder, tmp_path))


def test_a_full_disk_is_a_sentence_that_names_the_file(folder, tmp_path):
    command = [sys.executable, "-m", "echinus", "label", str(folder / "class_0"), "-o", str(tmp_path), "--uniform", "9000", "--workers", "1"]
    full = subprocess.run(["sh", "-c", 'ulimit -f 64; exec "$@"', "sh", *command], capture_output=True, text=True)
    assert full.returncode == 1
    assert re.fullmatch(r"echinus label: \[Errno 27\] File too large: '.*/points.npz'\n", full.stderr)
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []


def test_a_manifest_without_settings_is_an_error(folder, tmp_path):
    (tmp_path / "manifest.jsonl").write_text("")
    with pytest.raises(ValueError, match="manifest.jsonl: there are no settings in its first line; remove the file"):
        corpus.label(corpus_of(folder, tmp_path), workers=1)


def test_refused_meshes_are_listed_with_the_reason(folder, tmp_path):
    corpus.label(corpus_of(folder, tmp_path), workers=1)
    lines = [json.loads(line) for line in (tmp_path / "manifest.jsonl").read_text().splitlines()]
    refused = {r["mesh"]: r["refused"] for r in lines if "refused" in r}
    assert set(refused) == {"broken", "empty", "flat"}
    assert "broken.obj" in refused["broken"] and "extent" in refused["flat"]


def test_a_mesh_that_no_worker_survives_is_refused_and_its_neighbours_are_not(folder, tmp_path, monkeypatch):
    deadly = "class_0/sphere_2"

    def in_one_worker(tasks):
        for task in tasks:
            names = {name for name, _ in task.meshes} - {name for name, _ in task.refused}
            yield task, "3 workers died of it" if deadly in names else _tasks.run(task)

    with monkeypatch.context() as patched:
        patched.setattr(_engines, "on_processes", lambda tasks, **_: in_one_worker(tasks))
        for form in ("occupancy", "webdataset"):
            output = tmp_path / form
            summary = corpus.label(corpus_of(folder, output, form=form))
            assert (summary.labelled, summary.refused, summary.again) == (12, 4, 1)
            assert corpus.verify(corpus_of(folder, output, form=form)) == []
    assert len(list(samples_of_archives(tmp_path / "webdataset"))) == 12
    for form, computed in (("occupancy", (1, 0)), ("webdataset", (3, 1))):  # all of the archive, with the broken mesh
        summary = corpus.label(corpus_of(folder, tmp_path / form, form=form), workers=1)
        assert (summary.labelled, summary.refused, summary.again) == (*computed, 0)
        assert corpus.verify(corpus_of(folder, tmp_path / form, form=form)) == []
    assert len(list(samples_of_archives(tmp_path / "webdataset"))) == 13


def test_an_archive_that_no_worker_survives_is_a_sentence(folder, tmp_path, monkeypatch, capsys):
    def in_one_worker(tasks):
        for task in tasks:
            yield task, "3 workers died of it" if task.archive else _tasks.run(task)

    monkeypatch.setattr(_engines, "on_processes", lambda tasks, **_: in_one_worker(tasks))
    command = ["label", str(folder), "-o", str(tmp_path), "--format", "webdataset", "--uniform", "9", "--near", "9", "--surface", "9"]
    assert _command.main(_command.parse(command)) == 1
    assert "echinus label: labels-000000.tar: no worker survives it" in capsys.readouterr().err


def test_an_archive_that_a_worker_lacks_memory_for_is_a_sentence(folder, tmp_path, monkeypatch):
    def without_memory(files):
        raise MemoryError

    monkeypatch.setattr(_tasks, "archive_of", without_memory)
    with pytest.raises(RuntimeError, match="labels-000000.tar: a worker does not have enough memory to write this archive"):
        _tasks.run(corpus_of(folder, tmp_path, form="webdataset").tasks(str(tmp_path))[0])


def address_space_of_a_worker():
    """In bytes, before it has a task: it differs by machine, as NumPy's threads take room for each core."""
    program = "import echinus.corpus._engines as e; print(open('/proc/self/statm').read().split()[0])"
    pages = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True).stdout
    return int(pages) * resource.getpagesize()


def test_a_mesh_that_needs_too_much_memory_is_refused(folder, tmp_path):
    memory = address_space_of_a_worker() + (80 << 20)
    ech.write_mesh(tmp_path / "large.ply", ech.make_sphere(1, 2000, 101))  # 400 000 faces, which take 200 MB
    large = corpus.Corpus(corpus.find_meshes([tmp_path / "large.ply", folder / "class_0"]), tmp_path / "out", sampling=SMALL)
    summary = corpus.label(large, workers=1, memory=memory)
    assert summary.refused == summary.again == 1 and summary.labelled == 6
    manifest = (tmp_path / "out" / "manifest.jsonl").read_text()
    assert '"again":true' in manifest and ("memory" in manifest or "died" in manifest)


def test_a_mesh_that_lacked_memory_is_labelled_by_the_next_run_with_more(folder, tmp_path, monkeypatch):
    def without_memory(mesh, sampling):
        if not sampling.distances and len(mesh.faces) == len(ech.read_mesh(folder / "class_0" / "sphere_2.ply").faces):
            raise MemoryError
        return corpus.sample(mesh, sampling)

    c = corpus_of(folder, tmp_path)
    with monkeypatch.context() as patched:
        patched.setattr(_tasks, "sample", without_memory)
        patched.setattr(_engines, "on_processes", lambda tasks, **_: ((task, _tasks.run(task)) for task in tasks))
        for _ in range(2):
            assert corpus.label(c).again == 1
    record, = (r for r in map(json.loads, (tmp_path / "manifest.jsonl").read_text().splitlines()) if "again" in r)
    assert record["again"] is True and record["refused"] == "it needs more memory than a worker has"
    found = _verification.examine(c)
    assert (found.refused, found.again) == (4, 1) and not found.sentences()
    assert str(found).splitlines() == [
        "16 meshes, 4 of them refused: each of the others has its labels once, unchanged",
        "1 of the refused may succeed another time, with more memory, more time or a file that was missing: the same command without --verify tries them again",
    ]
    summary = corpus.label(c, workers=1)
    assert (summary.already, summary.labelled, summary.again) == (15, 1, 0)
    assert str(_verification.examine(c)) == "16 meshes, 3 of them refused: each of the others has its labels once, unchanged"


def test_meshes_that_lacked_time_are_labelled_by_the_next_run_with_more(folder, tmp_path, reference):
    form = reference[0]
    usual = corpus_of(folder, tmp_path, form=form)
    hasty = replace(usual, sampling=replace(usual.sampling, time_limit=1e-9))
    assert corpus.label(hasty, workers=1).again == 13
    assert corpus.label(usual, workers=1).labelled == 13
    assert bytes_below(tmp_path) == reference[1]


def test_verification_finds_what_is_missing_changed_surplus_or_double(folder, tmp_path):
    c = corpus_of(folder, tmp_path)
    corpus.label(c, workers=1)
    assert corpus.verify(c) == []
    (tmp_path / "open" / "points.npz").unlink()
    with (tmp_path / "class_0" / "torus_0" / "points.npz").open("r+b") as file:
        file.write(b"x")
    (tmp_path / "surplus").write_text("")
    manifest = tmp_path / "manifest.jsonl"
    lines = manifest.read_text().splitlines(keepends=True)
    of_mesh = [line for line in lines if '"mesh":"class_1/torus_1"' in line]
    manifest.write_text("".join(line for line in lines if '"mesh":"class_0/sphere_0"' not in line) + "".join(of_mesh))
    complaints = "\n".join(corpus.verify(c))
    for expected in ("open/points.npz: is missing", "torus_0/points.npz: has changed since it was written", "surplus: belongs to no labelled mesh of the corpus",
                     "class_0/sphere_0: has no labels", "class_1/torus_1: is recorded 2 times"):
        assert expected in complaints
    corpus.label(c, workers=1)  # mends what is missing; what has changed shows only by its hash
    assert "open/points.npz" not in "\n".join(corpus.verify(c))


def test_meshes_are_named_by_their_places(folder, tmp_path):
    (tmp_path / "list.txt").write_text(f"{folder}/class_0/torus_0.obj\n\n{folder}/open.off\n")
    names = [name for name, _ in corpus.find_meshes([tmp_path / "list.txt"])]
    assert [pathlib.PurePath(name).name for name in names] == ["torus_0", "open"]
    assert [name for name, _ in corpus.find_meshes([folder])] == sorted(name for name, _ in corpus.find_meshes([folder]))
    (tmp_path / "a.b.obj").write_text("")
    (tmp_path / "a_b.ply").write_text("")
    with pytest.raises(ValueError, match="would both be labelled as a_b"):
        corpus.find_meshes([tmp_path])
    for line in (".", "/", "./"):
        (tmp_path / "list.txt").write_text(f"a.obj\n{line}\n")
        with pytest.raises(ValueError, match=f"list.txt, line 2: {line!r} is the path of no file"):
            corpus.find_meshes([tmp_path / "list.txt"])


def test_what_is_no_file_is_refused_and_not_waited_for(folder, tmp_path):
    meshes = tmp_path / "meshes"
    meshes.mkdir()
    os.mkfifo(meshes / "pipe.obj")  # nobody writes to it
    ech.write_mesh(meshes / "torus.obj", torus())
    summary = corpus.label(corpus_of(meshes, tmp_path / "out"), workers=1)
    assert (summary.labelled, summary.refused) == (1, 1)
    assert "pipe.obj: it is not a file" in (tmp_path / "out" / "manifest.jsonl").read_text()


def test_a_run_without_work_or_workers_is_an_error(folder, tmp_path):
    for options in ({"archive_size": 0}, {"archive_size": -1}, {"shard": (1, 1)}, {"shard": (0, 0)}):
        with pytest.raises(ValueError, match=next(iter(options))):
            corpus_of(folder, tmp_path, **options)
    for wrong in ({"workers": 0}, {"workers": -1}, {"memory": 0}, {"memory": -1}, {"memory": 1 << 63}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            corpus.label(corpus_of(folder, tmp_path), **wrong)
    with pytest.raises(FileNotFoundError, match="missing"):
        corpus.find_meshes([tmp_path / "missing"])
    with pytest.raises(ValueError, match="a path of meshes is empty"):
        corpus.find_meshes([""])
    with pytest.raises(ValueError, match="output is an empty path"):
        corpus_of(folder, "")


def test_a_list_that_is_no_text_is_named(tmp_path):
    for content in ("meshes/é.obj\n".encode("latin-1"), "a.obj\n".encode("utf-16"), "a.obj\n".encode("utf-16-be")):
        (tmp_path / "list.txt").write_bytes(content)
        with pytest.raises(ValueError, match="list.txt is not text.* a list of meshes has one path per line"):
            corpus.find_meshes([tmp_path / "list.txt"])
    (tmp_path / "list.txt").write_bytes("\ufeffa.obj\n".encode())  # as some editors begin UTF-8
    assert corpus.find_meshes([tmp_path / "list.txt"]) == [("a", str(tmp_path / "a.obj"))]


def test_without_dask_a_scheduler_is_a_sentence_and_nothing_is_touched(folder, tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "distributed", None)
    command = ["label", str(folder), "-o", str(tmp_path / "out"), "--scheduler", "tcp://127.0.0.1:1"]
    assert _command.main(_command.parse(command)) == 1
    assert "echinus label: a scheduler needs Dask, Debian's package python3-distributed" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_the_exit_code_of_verification_tells_surplus_files_from_errors(folder, tmp_path, capsys):
    command = ["label", str(folder / "class_0"), "-o", str(tmp_path), "--uniform", "9", "--near", "9", "--surface", "0", "--workers", "1"]
    verify = _command.parse([*command, "--verify"])
    assert _command.main(_command.parse(command)) == 0
    assert _command.main(verify) == 0
    (tmp_path / "notes").write_text("")
    assert _command.main(verify) == 3
    said = capsys.readouterr().out
    assert "notes: belongs to no labelled mesh of the corpus" in said
    assert "files that belong to no labelled mesh of the corpus: 1; remove those that you do not want" in said
    (tmp_path / "torus_0" / "points.npz").unlink()
    assert _command.main(verify) == 1


def test_the_command_says_what_is_wrong(tmp_path):
    command = [sys.executable, "-m", "echinus", "label"]
    nothing = subprocess.run([*command, str(tmp_path), "-o", str(tmp_path / "out")], capture_output=True, text=True)
    assert nothing.returncode == 1 and "there are no meshes in" in nothing.stderr
    ech.write_mesh(tmp_path / "torus.obj", torus())
    for memory in ("inf", "nan", "-1", "0"):
        wrong = subprocess.run([*command, str(tmp_path), "-o", str(tmp_path / "out"), "--memory", memory], capture_output=True, text=True)
        assert wrong.returncode == 2 and "echinus label: memory must be" in wrong.stderr
    for wrong in (["--shard", "3/3"], ["--shard", "1"], ["--format", "other"], ["--sigmas", "x"], ["--sigmas", ","], ["--padding", "-1"],
                  ["--workers", "0", "--verify"], ["--workers", "5000000000"], ["--shard", "0/99999999999"], ["--shard", "0/2", "--verify"], ["--memory", "1e-12"], ["--archive-size", "0"], ["--uniform", "-5"], ["--seed", "-1"]):
        refused = subprocess.run([*command, str(tmp_path), "-o", "x", *wrong], capture_output=True, text=True)
        assert refused.returncode == 2 and wrong[0].strip("-").replace("-", "_") in refused.stderr.replace("-", "_") and "_numbers" not in refused.stderr
    wrong = subprocess.run([*command, str(tmp_path), "-o", str(tmp_path / "torus.obj")], capture_output=True, text=True)
    assert wrong.returncode == 1 and "torus.obj is a file; the labels take a folder" in wrong.stderr


def test_too_little_memory_for_any_worker_is_a_sentence(own_folder, tmp_path):
    command = [sys.executable, "-m", "echinus", "label", str(own_folder), "-o", str(tmp_path / "labels"), "--workers", "1", "--memory"]
    for memory in ("0.05", "0.001"):
        failed = subprocess.run([*command, memory], capture_output=True, text=True)
        assert (failed.returncode, failed.stderr) == (1, "echinus label: a worker has too little memory even to begin with; give it more\n")
        assert not any((tmp_path / "labels").iterdir())


def test_a_folder_that_cannot_be_read_is_an_error(own_folder, monkeypatch):
    def denied(path):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(os, "scandir", denied)
    with pytest.raises(PermissionError, match="meshes"):
        corpus.find_meshes([own_folder])


def test_a_run_with_nothing_to_do_says_so_only(own_folder, tmp_path, capsys):
    command = _command.parse(["label", str(own_folder), "-o", str(tmp_path / "labels"), "--uniform", "9", "--near", "9", "--surface", "0"])
    for expected in ("3 meshes; ", "3 meshes done already\n"):
        assert _command.main(command) == 0
        said = capsys.readouterr().err
        assert said.startswith(expected) and said.count("\n") == 1


# ---- On a cluster


@pytest.mark.filterwarnings("ignore")  # Debian's Dask has deprecated ways
@pytest.mark.seldom
def test_a_cluster_gives_the_same_bytes(folder, tmp_path, reference):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, scheduler_port=0) as cluster:
        corpus.label(corpus_of(folder, tmp_path, form=reference[0]), scheduler=cluster.scheduler_address)
    assert bytes_below(tmp_path) == reference[1]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.seldom
def test_a_cluster_that_goes_ends_the_run_with_a_sentence_and_the_next_run_goes_on(own_folder, tmp_path):
    pytest.importorskip("distributed")
    program = (
        "import distributed; c = distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None, scheduler_port=0);"
        "print(c.scheduler_address, flush=True); input()"
    )
    command = [sys.executable, "-m", "echinus", "label", str(own_folder), "-o", str(tmp_path / "labels"), "--uniform"]
    with subprocess.Popen([sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, start_new_session=True) as cluster:
        try:
            address = cluster.stdout.readline().strip()
            run = subprocess.Popen([*command, "50000000", "--scheduler", address], stderr=subprocess.PIPE, text=True)
            until(lambda: (tmp_path / "labels" / "manifest.jsonl").exists())
            time.sleep(0.5)
        finally:
            os.killpg(cluster.pid, signal.SIGKILL)
    said = run.communicate(timeout=120)[1]
    assert run.returncode == 1 and f"the cluster at {address} has gone; the same command continues from here" in said
    assert "Traceback" not in said and not (tmp_path / "labels" / "manifest.jsonl").exists()
    subprocess.run([*command, "9"], check=True, capture_output=True)


@pytest.mark.parametrize("address, code, words", [
    ("foo", 2, "scheduler 'foo' is not an address, for instance tcp://host:8786"),
    ("", 2, "scheduler '' is not an address"),
    ("http://localhost:1", 2, "scheduler 'http://localhost:1' is not an address"),
    ("tcp://127.0.0.1:1", 1, "scheduler tcp://127.0.0.1:1 does not answer"),
])
@pytest.mark.seldom
def test_a_scheduler_that_is_none_is_a_sentence_and_nothing_is_touched(folder, tmp_path, address, code, words):
    pytest.importorskip("distributed")
    command = [sys.executable, "-m", "echinus", "label", str(folder), "-o", str(tmp_path / "out"), "--scheduler", address]
    hasty = {**os.environ, "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "1s"}
    wrong = subprocess.run(command, capture_output=True, text=True, timeout=60, env=hasty)
    assert wrong.returncode == code and f"echinus label: {words}" in wrong.stderr and "Traceback" not in wrong.stderr
    assert not (tmp_path / "out").exists()
