"""Judges a recorded cloth from its positions alone: sides and depths by an exact map, which echinus-check compares with CGAL's
exact predicates (docs/accuracy.md); pairs of faces by predicates that are exact on the float coordinates."""

import dataclasses

import numpy as np

import echinus as ech

HEADER = 32  # bytes of PC2
JUDGED_EVERY = 15  # frames, and the last
REST_SPEED, REST_FRAMES = 0.1, 15  # R/s, of all but 1 % of the particles; frames to the end
LOST = 2.0  # R from the model's middle

COLUMNS = ("inside", "inside_worst", "deepest", "deepest_worst", "model_pairs", "model_pairs_worst", "own_pairs", "own_pairs_worst",
           "stretch", "stretch_99", "stretch_worst", "rest_frame", "lost")


class Model:
    """R = 1 around the origin."""

    def __init__(self, mesh):
        self.mesh = mesh
        self.map = ech.ExactMap(mesh)


@dataclasses.dataclass
class Moment:
    inside: int
    deepest: float  # of the particles inside, R
    model_pairs: int
    own_pairs: int
    stretch: float  # the longest edge over its first length, less 1
    stretch_99: float


def read_samples(path, point_count):
    """[sample, point, 3]"""
    data = path.read_bytes()
    count = int.from_bytes(data[28:32], "little")
    if not data.startswith(b"POINTCACHE2\0") or int.from_bytes(data[16:20], "little") != point_count:
        raise SystemExit(f"{path}: is no PC2 file of {point_count} points")
    return np.frombuffer(data, "<f4", offset=HEADER).reshape(count, point_count, 3)


def edges_of(faces):
    pairs = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    return np.unique(pairs, axis=0)


def lengths(positions, edges):
    return np.linalg.norm(positions[edges[:, 0]].astype(float) - positions[edges[:, 1]], axis=1)


def look_at(model, faces, positions, edges, rest_lengths):
    distances = model.map.signed_distance(positions)
    strains = lengths(positions, edges) / rest_lengths - 1
    cloth = ech.Mesh(positions, faces)
    return Moment(inside=int(np.signbit(distances).sum()), deepest=float(max(0, -distances.min())),
                  model_pairs=len(ech.intersecting_pairs(cloth, model.mesh)), own_pairs=len(ech.self_intersecting_pairs(cloth)),
                  stretch=float(strains.max()), stretch_99=float(np.percentile(strains, 99)))


def rest_frame(samples):
    """The first frame from which on the cloth rests to the end, or nothing."""
    ways = np.linalg.norm(np.diff(samples, axis=0), axis=2)
    moving = np.percentile(ways, 99, axis=1) * 60 > REST_SPEED
    first = int(np.flatnonzero(moving).max(initial=-1)) + 1
    return first if first <= len(moving) - REST_FRAMES else ""


def judge(model, faces, samples):
    if not np.isfinite(samples).all():
        return {"lost": samples.shape[1]}
    edges = edges_of(np.asarray(faces))
    rest_lengths = lengths(samples[0], edges)
    frames = sorted({*range(JUDGED_EVERY, len(samples), JUDGED_EVERY), len(samples) - 1})
    moments = [look_at(model, faces, samples[f], edges, rest_lengths) for f in frames]
    last = dataclasses.asdict(moments[-1])
    worst = {f"{name}_worst": max(getattr(m, name) for m in moments)
             for name in ("inside", "deepest", "model_pairs", "own_pairs", "stretch")}
    lost = int((np.linalg.norm(samples[-1], axis=1) > LOST).sum())
    return {**last, **worst, "rest_frame": rest_frame(samples), "lost": lost}
