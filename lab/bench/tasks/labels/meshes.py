"""The meshes of the task labels: clean, open, overlapping, self-crossing, and soups. All generated but Debian's horse."""

import pathlib

import numpy as np

import echinus as ech


def holed_horse(horse):
    """Without the faces around eight of its vertices."""
    centres = horse.vertices[np.random.default_rng(1).integers(len(horse.vertices), size=8)]
    middles = horse.vertices[horse.faces].mean(axis=1)
    reach = 0.05 * np.ptp(horse.vertices, axis=0).max()
    kept = (np.linalg.norm(middles[:, None] - centres, axis=2) > reach).all(axis=1)
    return ech.Mesh(horse.vertices, horse.faces[kept])


def figure_of_eight(around=96, along=384):
    """A tube that runs through itself, with the winding number 2 where it does."""
    t, v = np.meshgrid(np.arange(along) * 2 * np.pi / along, np.arange(around) * 2 * np.pi / around, indexing="ij")
    tangent = np.stack([np.cos(t), np.cos(2 * t)], axis=-1)
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    sideways = 0.25 * np.cos(v)
    vertices = np.stack([np.sin(t) - sideways * tangent[..., 1], np.sin(2 * t) / 2 + sideways * tangent[..., 0], 0.25 * np.sin(v)], axis=-1)
    i, j = np.meshgrid(np.arange(along), np.arange(around), indexing="ij")
    a, b, c, d = (((i + x) % along * around + (j + y) % around).ravel() for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
    return ech.Mesh(vertices.reshape(-1, 3), np.stack([a, c, b, a, d, c], axis=1).reshape(-1, 3))


def parts(count, torn):
    """Boxes, rings and balls that overlap and are not joined, some without a tenth of their faces: like a car, if torn."""
    random = np.random.default_rng(2)
    vertices, faces, first = [], [], 0
    for n in range(count):
        size = random.uniform(0.1, 0.6)
        part = (ech.make_box(size * random.uniform(0.2, 1, 3), 3), ech.make_torus(size, 0.3 * size, 24, 12), ech.make_sphere(size / 2, 24, 12))[n % 3]
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        if np.linalg.det(turn) < 0:
            turn[:, 0] *= -1
        vertices.append(part.vertices @ turn.T + random.uniform(-1, 1, 3) * (2, 0.8, 0.6))
        faces.append(part.faces[len(part.faces) // 10 if torn and n % 2 else 0 :] + first)
        first += len(part.vertices)
    return ech.Mesh(np.concatenate(vertices), np.concatenate(faces))


def exploded(mesh):
    """Each face for itself, shrunk a little."""
    corners = mesh.vertices[mesh.faces]
    middle = corners.mean(axis=1, keepdims=True)
    return ech.Mesh((middle + 0.97 * (corners - middle)).reshape(-1, 3), np.arange(corners.size // 3).reshape(-1, 3))


def of_folder(folder):
    paths = sorted(p for p in pathlib.Path(folder).iterdir() if p.suffix in (".obj", ".off", ".ply", ".stl"))
    return [(path.stem, "from a folder", ech.weld(ech.read_mesh(path))) for path in paths]


def meshes(debian_horse, folder):
    """(name, kind, mesh). Only those of the kind `clean` are judged by CGAL's exact parity."""
    horse, _ = ech.repair(ech.read_mesh(debian_horse))
    return [
        ("horse", "clean", horse),
        ("torus", "clean", ech.make_torus(1, 0.4, 320, 160)),
        ("horse with eight holes", "open", holed_horse(horse)),
        ("sixty closed parts", "overlapping", parts(60, torn=False)),
        ("figure of eight", "self-crossing", figure_of_eight()),
        ("two hundred torn parts", "open, overlapping", parts(200, torn=True)),
        ("exploded torus", "soup", exploded(ech.make_torus(1, 0.4, 80, 32))),
        *(of_folder(folder) if folder else []),
    ]
