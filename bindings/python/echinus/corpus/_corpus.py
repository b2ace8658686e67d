"""What a run is about: meshes, how they are labelled, and to where."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field

from echinus import _core
from echinus._meshes import Path
from echinus.corpus._formats import Format
from echinus.corpus._samples import Sampling
from echinus.corpus._sources import Mesh
from echinus.corpus._tasks import Record, Task


@dataclass(frozen=True)
class Corpus:
    """What is labelled, how, and to where.

    Attributes
    ----------
    meshes
        What :func:`find_meshes` gives.
    output
        The folder of the labels; all workers see it under this name.
    form
        ``"occupancy"`` (Occupancy Networks), ``"deepsdf"`` or ``"webdataset"``.
    archive_size
        Meshes in each archive of ``"webdataset"``. Which mesh comes into which depends on the meshes only.
    max_bytes
        Larger mesh files are refused.
    shard
        (i, n): only the i-th of n parts of the work, from 0.
    """

    meshes: Sequence[Mesh]
    output: Path
    form: Format = "occupancy"
    sampling: Sampling = field(default_factory=Sampling)
    archive_size: int = 64
    max_bytes: int = 1 << 30
    shard: tuple[int, int] = (0, 1)

    def __post_init__(self) -> None:
        if not os.fspath(self.output):
            raise ValueError("output is an empty path; name the folder of the labels")
        if self.form != "occupancy" and not self.sampling.distances:
            raise ValueError(f"labels as {self.form} need distances")
        if self.archive_size < 1:
            raise ValueError(f"archive_size must be 1 or more, not {self.archive_size}")
        i, n = self.shard
        if not 0 <= i < n:
            raise ValueError(f"shard must be (i, n) with i from 0 to n - 1, not {self.shard}")

    def tasks(self) -> list[Task]:
        size = self.archive_size if self.form == "webdataset" else 1
        groups = [tuple(self.meshes[i : i + size]) for i in range(0, len(self.meshes), size)]
        tasks = [
            Task(
                meshes=group,
                output=os.path.abspath(self.output),
                sampling=self.sampling,
                form=self.form,
                max_bytes=self.max_bytes,
                archive=f"labels-{i:06d}.tar" if self.form == "webdataset" else None,
            )
            for i, group in enumerate(groups)
        ]
        return tasks[self.shard[0] :: self.shard[1]]

    def settings(self) -> Record:
        """The first line of the manifest: labels made with others do not belong into the same folder.

        The time limit is not among them: it decides which meshes have labels, but not what these are.
        """
        sampling = self.sampling.to_json() | {"sigmas": list(self.sampling.sigmas)}
        del sampling["time_limit"]
        return {"echinus": _core.version, "format": self.form, "archive_size": self.archive_size, "max_bytes": self.max_bytes, "sampling": sampling}
