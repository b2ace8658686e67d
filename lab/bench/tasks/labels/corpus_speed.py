"""A corpus labelled by echinus.corpus, and its points labelled once more by VTK, each by one process."""

import os
import resource
import subprocess
import sys
import time

import numpy as np

import echinus as ech
import systems
from echinus import corpus

sys.path.append("tests/python")
import corpus_trial


def seconds_of(command):
    """Processor time of a program and of those that it started."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def labelled(folder, name, form):
    """(points, inside, loc, scale): point = point_in_frame * scale + loc."""
    if form == "occupancy":
        with np.load(folder / name / "points.npz") as file:
            points = file["points"]
            return points, np.unpackbits(file["occupancies"])[: len(points)].astype(bool), file["loc"], float(file["scale"])
    with np.load(folder / f"{name}.npz") as file:
        points = np.concatenate([file["neg"], file["pos"]])
        return points[:, :3].copy(), np.arange(len(points)) < len(file["neg"]), -file["offset"], 1 / float(file["scale"])


def by_system(path, points, loc, scale, kind, query):
    """Sides of points in the mesh's frame, and the seconds that the build of a system took and they."""
    mesh, _ = ech.repair(ech.read_mesh(path))  # as echinus.corpus does
    framed = ech.Mesh((mesh.vertices.astype(float) - loc) / scale, mesh.faces)
    inside = np.empty(len(points), bool)
    began = time.process_time()
    if query == "contains":
        kind(framed).contains(points, inside)
    else:
        distances = np.empty(len(points), np.float32)
        kind(framed).signed_distance(points, distances)
        inside = distances < 0
    return inside, time.process_time() - began


def compare(folder, options):
    corpus_trial.make_corpus(folder / "meshes", options.corpus_meshes)
    found = corpus.find_meshes([folder / "meshes"])
    for form, query, vtk in (("occupancy", "contains", systems.VtkEnclosed), ("deepsdf", "signed_distance", systems.VtkDistance)):
        command = [sys.executable, "-m", "echinus", "label", folder / "meshes", "-o", folder / form, "--format", form, "--workers", "1"]
        whole = "echinus.corpus, all of it"
        seconds = {whole: seconds_of(command), systems.ExactMap.name: 0.0, vtk.name: 0.0}
        differing = dict.fromkeys((systems.ExactMap.name, vtk.name), 0)
        count = 0
        for name, path in found:
            if not os.path.exists(folder / form / (f"{name}.npz" if form == "deepsdf" else f"{name}/points.npz")):
                continue  # refused
            points, ours, loc, scale = labelled(folder / form, name, form)
            count += len(points)
            for kind in (systems.ExactMap, vtk):
                sides, took = by_system(path, points, loc, scale, kind, query)
                seconds[kind.name] += took
                differing[kind.name] += int((sides != ours).sum())
        for system, took in seconds.items():
            yield {"task": "corpus", "kind": form, "mesh": f"{len(found)} meshes", "points": count, "system": system,
                   "role": "rival" if system == vtk.name else "ours", "ns": 1e9 * took / count,
                   "wrong_share": differing[system] / count if system in differing else None}
        print(f"labels: corpus, {form}", file=sys.stderr)
