"""The input and output of a run: the meshes, how they are labelled, and where the labels go."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from typing import get_args

from echinus import _core
from echinus._arguments import of_kind, one_of, path_of, whole
from echinus._meshes import Path
from echinus.corpus._formats import Format
from echinus.corpus._samples import Sampling
from echinus.corpus._sources import Mesh, by_name, lies_below
from echinus.corpus._tasks import Record, Task

UNFINISHED = ".unfinished"  # in the output folder: locks, and files that are being written


@dataclass(frozen=True)
class Corpus:
    """Meshes to label, the settings, and the folder of the labels.

    Attributes
    ----------
    meshes
        The result of :func:`find_meshes`, in any order.
    output
        The folder of the labels; all workers reach it by this path.
    form
        ``"occupancy"`` (Occupancy Networks), ``"deepsdf"`` or ``"webdataset"``.
    archive_size
        Number of meshes in each archive of ``"webdataset"``. The archive of a mesh depends only on the meshes.
    max_bytes
        The largest size of a mesh file; larger files are refused.
    shard
        (i, n): only part i of n parts of the work, counted from 0.
    """

    meshes: Sequence[Mesh]
    output: Path
    form: Format = "occupancy"
    sampling: Sampling = field(default_factory=Sampling)
    archive_size: int = 64
    max_bytes: int = 1 << 30
    shard: tuple[int, int] = (0, 1)

    def __post_init__(self) -> None:
        object.__setattr__(self, "meshes", tuple(by_name(_checked(self.meshes))))
        if not path_of(self.output):
            raise ValueError("output is an empty path; name the folder of the labels")
        one_of("form", self.form, get_args(Format))
        if not of_kind("sampling", self.sampling, Sampling).distances and self.form != "occupancy":
            raise ValueError(f"labels as {self.form} need distances")
        whole("archive_size", self.archive_size, 1)
        whole("max_bytes", self.max_bytes, 0, 2**63 - 1)
        if not (isinstance(self.shard, tuple) and len(self.shard) == 2):
            raise TypeError(f"shard must be (i, n), not {self.shard!r}")
        i, n = (whole("each of shard", number) for number in self.shard)
        if not i < n:
            raise ValueError(f"shard must be (i, n) with i from 0 to n - 1, not {self.shard}")

    def groups(self) -> list[tuple[str | None, tuple[Mesh, ...]]]:
        """The groups of meshes of all parts, each with the name of its archive or None. The meshes of a group are labelled
        together."""
        if self.form != "webdataset":
            return [(None, (mesh,)) for mesh in self.meshes]
        starts = range(0, len(self.meshes), self.archive_size)
        return [(f"labels-{i:06d}.tar", tuple(self.meshes[start : start + self.archive_size])) for i, start in enumerate(starts)]

    def tasks(self, unfinished: str) -> list[Task]:
        """The tasks of this part. Files are in the folder ``unfinished`` until they are complete."""
        i, n = self.shard
        return [
            Task(
                meshes=meshes,
                output=os.path.abspath(self.output),
                unfinished=unfinished,
                sampling=self.sampling,
                form=self.form,
                max_bytes=self.max_bytes,
                archive=archive,
            )
            for archive, meshes in self.groups()[i::n]
        ]

    def settings(self) -> Record:
        """The first line of the manifest: labels made with other settings do not belong in the same folder.

        The time limit is not among them: it decides which meshes get labels, but not the values of the labels.
        """
        sampling = asdict(self.sampling) | {"sigmas": list(self.sampling.sigmas)}
        del sampling["time_limit"]
        return {"echinus": _core.version, "format": self.form, "archive_size": self.archive_size, "max_bytes": self.max_bytes, "sampling": sampling}


def _checked(meshes: Iterable[Mesh]) -> Iterator[Mesh]:
    if not isinstance(meshes, Iterable):
        raise TypeError(f"meshes must be a list of (name, path), not {meshes!r}")
    for i, mesh in enumerate(meshes):
        if not (isinstance(mesh, tuple) and len(mesh) == 2):
            raise TypeError(f"meshes[{i}] must be (name, path), as find_meshes() gives them, not {mesh!r}")
        if not lies_below(mesh[0]) or mesh[0].startswith(UNFINISHED):
            raise ValueError(f"meshes[{i}]: its labels would go to {mesh[0]!r} in the output folder, where they cannot be")
        yield mesh
