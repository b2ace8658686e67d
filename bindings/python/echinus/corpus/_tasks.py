"""The work of a worker: one task, whose meshes become the files of a folder or the members of one archive."""

from __future__ import annotations

import contextlib
import hashlib
import os
import pathlib
import secrets
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, BinaryIO

from echinus._errors import Error
from echinus._meshes import read_mesh
from echinus.corpus._formats import Format, archive_of, files_of
from echinus.corpus._samples import Refused, Sampling, sample
from echinus.corpus._sources import fingerprint

Record = dict[str, Any]  # a line of the manifest


@dataclass(frozen=True)
class Task:
    """Meshes that are labelled together.

    Attributes
    ----------
    meshes
        The name and path of each mesh.
    unfinished
        The folder of files that are being written. The run creates and removes it, so that afterwards no worker that still
        computes can finish a file.
    archive
        The archive that contains their files, or None if the files are separate.
    refused
        The name of each mesh that is not tried because it crashed workers, and the reason for its refusal.
    """

    meshes: tuple[tuple[str, str], ...]
    output: str
    unfinished: str
    sampling: Sampling
    form: Format
    max_bytes: int
    archive: str | None = None
    refused: tuple[tuple[str, str], ...] = ()

    def alone(self) -> list[Task]:
        """One task for each mesh, to find the mesh that crashes workers. Their files go to a folder that is removed."""
        return [replace(self, meshes=(mesh,), archive=None, output=self.place_alone) for mesh in self.meshes]

    @property
    def place_alone(self) -> str:
        return os.path.join(self.unfinished, f"alone-{self.archive}")


def run(task: Task) -> list[Record]:
    """Labels the meshes and writes their files, each completely or not at all; the same task gives the same records."""
    reasons = dict(task.refused)
    records: list[Record] = []
    members: dict[str, bytes] = {}
    for name, path in task.meshes:
        # Before the mesh is read: if the file changes meanwhile, the next run sees it.
        size, digest = fingerprint(path, task.max_bytes)
        source = {"mesh": name, "source": path, "source_bytes": size, "source_sha256": digest}
        try:
            if name in reasons:
                raise Refused(reasons[name], again=True)
            files, report = _labelled(name, path, size, task)
        except (Refused, Error, MemoryError) as error:
            records.append(source | _refusal(error, path))
            continue
        if task.archive is None:
            written = [_write(task, file, content) for file, content in files.items()]
            records += [source | {"files": sorted(files), "report": report}, *written]
        else:
            members |= files
            records.append(source | {"files": [task.archive], "report": report})
    if task.archive is not None:
        try:
            records.append(_write(task, task.archive, archive_of(members)))
        except MemoryError:
            raise RuntimeError(f"{task.archive}: a worker does not have enough memory to write this archive; give the workers more memory, or put fewer meshes into an archive") from None
    return records


def _refusal(error: Refused | Error | MemoryError, path: str) -> Record:
    """The next run tries a mesh again if, as far as is known, its own file is not the cause."""
    if isinstance(error, MemoryError):
        error = Refused("it needs more memory than a worker has", again=True)
    again = isinstance(error, Refused) and error.again or path.lower().endswith(".gltf")  # its other files may have been missing
    return {"refused": str(error)} | ({"again": True} if again else {})


def _labelled(name: str, path: str, size: int | None, task: Task) -> tuple[dict[str, bytes], Record]:
    if os.path.exists(path) and not os.path.isfile(path):
        raise Refused(f"{path}: it is not a file")  # a pipe could block the worker forever
    if size is not None and size > task.max_bytes:
        raise Refused(f"{path}: the file has {size} bytes; at most {task.max_bytes} are accepted")
    samples = sample(read_mesh(path), task.sampling)
    return files_of(samples, name, task.form), samples.report | {"points": len(samples.points)}


def _write(task: Task, name: str, content: bytes) -> Record:
    with whole_file(pathlib.Path(task.output, name), task.unfinished) as file:
        file.write(content)
    return {"file": name, "sha256": hashlib.sha256(content).hexdigest(), "bytes": len(content)}


@contextlib.contextmanager
def whole_file(target: pathlib.Path, unfinished: str) -> Iterator[BinaryIO]:
    """A file that is in the folder ``unfinished``, under another name, until it is complete. Errors of the system name the
    target."""
    with naming(target):
        target.parent.mkdir(parents=True, exist_ok=True)
        part = os.path.join(unfinished, secrets.token_hex(8))
        try:
            with open(part, "xb") as file:
                yield file
                file.flush()
                os.fsync(file.fileno())
            os.replace(part, target)
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(part)
            raise


@contextlib.contextmanager
def naming(path: pathlib.Path) -> Iterator[None]:
    """Adds the path to an error of the system, since that of a full disk names no file."""
    try:
        yield
    except OSError as error:
        if error.filename is not None or error.errno is None:
            raise
        raise OSError(error.errno, error.strerror, str(path)) from None

