"""A run over a corpus: what is left to do, the manifest, and what is done about meshes that kill workers."""

from __future__ import annotations

import collections
import contextlib
import fcntl
import hashlib
import itertools
import json
import os
import pathlib
import shutil
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TextIO

from echinus import _core
from echinus._meshes import Path
from echinus.corpus import _engines
from echinus.corpus._formats import Format
from echinus.corpus._samples import Sampling
from echinus.corpus._tasks import UNFINISHED, Record, Task

EXTENSIONS = (".obj", ".ply", ".stl", ".off", ".gltf", ".glb", ".3ds")
LOG_SECONDS = 10  # between lines of the progress, where it is no terminal
Mesh = tuple[str, str]  # name, path


def find_meshes(sources: Sequence[Path]) -> list[Mesh]:
    """Name and path of each mesh file, by name.

    Parameters
    ----------
    sources
        Folders, with all below them; mesh files; and lists of such (``.txt``), one path a line, from the list's folder.

    Raises
    ------
    FileNotFoundError
        A source does not exist. What a list names may be missing: it is refused like a broken mesh.
    ValueError
        Two files have the same name, which is their path below the source without the extension.
    """
    found: dict[str, str] = {}
    for source in sources:
        for name, path in _meshes_of(pathlib.Path(source)):
            name = name.replace(".", "_")
            if found.setdefault(name, str(path)) != str(path):
                raise ValueError(f"{found[name]} and {path} would both be labelled as {name}; rename one")
    return sorted(found.items())


def _meshes_of(source: pathlib.Path) -> Iterator[tuple[str, pathlib.Path]]:
    if source.suffix == ".txt":
        for line in source.read_text().splitlines():
            if line.strip():
                path = source.parent / line.strip()
                relative = pathlib.PurePath(line.strip())
                yield str(relative.relative_to(relative.anchor).with_suffix("")), path
    elif source.is_dir():
        for folder, _, files in os.walk(source):
            for file in files:
                path = pathlib.Path(folder, file)
                if path.suffix.lower() in EXTENSIONS:
                    yield str(path.relative_to(source).with_suffix("")), path
    elif source.exists():
        yield source.stem, source
    else:
        raise FileNotFoundError(f"there is no folder or file {source}")


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
        """The first line of the manifest: labels made with others do not belong into the same folder."""
        sampling = self.sampling.to_json() | {"sigmas": list(self.sampling.sigmas)}
        return {"echinus": _core.version, "format": self.form, "archive_size": self.archive_size, "max_bytes": self.max_bytes, "sampling": sampling}


class _Manifest:
    """manifest.jsonl: the settings, then a line for each mesh and each file, sorted in the end.

    While a run goes on, lines are added as results come; one that a crash cut short is dropped.
    """

    def __init__(self, corpus: Corpus) -> None:
        i, n = corpus.shard
        name = "manifest.jsonl" if n == 1 else f"manifest-{i}-of-{n}.jsonl"
        self.path = pathlib.Path(corpus.output, name)
        self.settings = corpus.settings()
        if self.path.exists() and self.settings not in itertools.islice(_records(self.path), 1):
            raise ValueError(f"{self.path}: the labels in this folder were made with other settings; choose another folder")

    def done(self) -> set[str]:
        """The meshes that have a record, and all files that it names."""
        records = list(_records(self.path))
        whole = {r["file"] for r in records if "file" in r and _size(self.path.parent / r["file"]) == r["bytes"]}
        return {r["mesh"] for r in records if "mesh" in r and whole.issuperset(r.get("files", []))}

    def keep(self, meshes: set[str]) -> None:
        """Forgets what is not about these meshes."""
        files = {name for r in _records(self.path) if r.get("mesh") in meshes for name in r.get("files", [])}
        self._write(r for r in _records(self.path) if r.get("mesh") in meshes or r.get("file") in files)

    def add(self, records: Iterable[Record]) -> None:
        with self.path.open("a") as file:
            file.writelines(_line(record) for record in records)

    def sort(self) -> None:
        """The same bytes for the same labels, in whatever order they came."""
        self._write(r for r in _records(self.path) if "echinus" not in r)

    def _write(self, records: Iterable[Record]) -> None:
        lines = sorted((r.get("mesh", ""), r.get("file", ""), _line(r)) for r in records)
        part = self.path.with_suffix(".part")
        with part.open("w") as file:
            file.writelines([_line(self.settings), *(line for _, _, line in lines)])
        os.replace(part, self.path)


def _records(manifest: pathlib.Path) -> Iterator[Record]:
    """Without a last line that was cut short."""
    if not manifest.exists():
        return
    with manifest.open(errors="replace") as file:
        for number, line in enumerate(file, 1):
            if not line.endswith("\n"):
                return
            try:
                record = json.loads(line)
            except json.JSONDecodeError as error:
                raise ValueError(f"{manifest}, line {number} is no record ({error}); remove the file to label all meshes again") from None
            yield record


def _line(record: Record) -> str:
    return json.dumps(record, sort_keys=True, separators=(",", ":")) + "\n"


def _size(path: pathlib.Path) -> int | None:
    with contextlib.suppress(OSError):
        return path.stat().st_size
    return None


@dataclass
class Summary:
    """What a run did.

    Attributes
    ----------
    labelled, refused, points
        Of this run.
    already
        Meshes that an earlier run had done.
    """

    already: int = 0
    labelled: int = 0
    refused: int = 0
    points: int = 0
    seconds: float = 0.0

    def count(self, records: Iterable[Record]) -> None:
        for record in records:
            self.labelled += "report" in record
            self.refused += "refused" in record
            self.points += record.get("report", {}).get("points", 0)

    def __str__(self) -> str:
        done, rate = self.labelled + self.refused, 1 / max(self.seconds, 1e-9)
        return f"{done} meshes, {self.refused} of them refused; {done * rate:.3g} meshes/s, {self.points * rate:.3g} points/s"


def label(
    corpus: Corpus,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    memory: int = 4 << 30,
    progress: TextIO | None = None,
) -> Summary:
    """Labels all meshes that have no labels yet. The labels are the same bytes whoever computes them.

    Parameters
    ----------
    workers
        Processes of this machine, by default as many as it has cores.
    scheduler
        The address of a Dask scheduler, whose workers are used instead.
    memory
        The address space of a worker process, in bytes: a mesh that needs more is refused.
    progress
        Where to show how far it is.

    Raises
    ------
    ValueError
        The folder has labels that were made with other settings, another run is writing them, or there are to be no
        workers.
    OSError
        A file cannot be written.
    """
    if workers is not None and workers < 1:
        raise ValueError(f"workers must be 1 or more, not {workers}")
    if not 0 < memory < 1 << 63:
        raise ValueError(f"memory must be a positive number of bytes, not {memory}")
    if os.path.exists(corpus.output) and not os.path.isdir(corpus.output):
        raise NotADirectoryError(f"{corpus.output} is a file; the labels take a folder")
    os.makedirs(corpus.output, exist_ok=True)
    with _alone(corpus):
        return _label(corpus, workers, scheduler, memory, progress)


@contextlib.contextmanager
def _alone(corpus: Corpus) -> Iterator[None]:
    """While no other run works on the same part, or on the whole. The locks go with the process, however it ends.

    All runs lock the folder: one of a part shares it. So what is in it is removed by none while another works.
    """
    i, n = corpus.shard
    folder = os.open(corpus.output, os.O_RDONLY)
    try:
        _lock(folder, fcntl.LOCK_SH if n > 1 else fcntl.LOCK_EX)
        with _part_locked(pathlib.Path(corpus.output, UNFINISHED, f"lock-{i}-of-{n}")):
            yield
    except BlockingIOError:
        raise ValueError(f"{corpus.output}: another run is writing these labels; wait for it, or choose another folder") from None
    finally:
        os.close(folder)


@contextlib.contextmanager
def _part_locked(path: pathlib.Path) -> Iterator[None]:
    path.parent.mkdir(exist_ok=True)
    file = path.open("a")
    try:
        _lock(file.fileno(), fcntl.LOCK_EX)
        while not _is(file, path):  # an earlier run removed it meanwhile
            file.close()
            file = path.open("a")
            _lock(file.fileno(), fcntl.LOCK_EX)
        yield
        if _is(file, path):  # a whole run has removed it with its folder
            path.unlink()
    finally:
        file.close()


def _lock(descriptor: int, how: int) -> None:
    """Raises BlockingIOError where another process holds the lock. Does nothing on a file system without locks."""
    try:
        fcntl.flock(descriptor, how | fcntl.LOCK_NB)
    except BlockingIOError:
        raise
    except OSError:
        pass


def _is(file: TextIO, path: pathlib.Path) -> bool:
    try:
        return os.path.samestat(os.fstat(file.fileno()), path.stat())
    except FileNotFoundError:
        return False


def _label(corpus: Corpus, workers: int | None, scheduler: str | None, memory: int, progress: TextIO | None) -> Summary:
    manifest = _Manifest(corpus)
    mine = corpus.tasks()
    done = manifest.done()
    tasks = [task for task in mine if not all(name in done for name, _ in task.meshes)]
    finished = {name for task in mine for name, _ in task.meshes} - {name for task in tasks for name, _ in task.meshes}
    manifest.keep(finished)
    summary, began = Summary(already=len(finished)), time.monotonic()
    shown = began
    total = sum(len(task.meshes) for task in tasks)

    def run(these: Iterable[Task]) -> Iterator[_engines.Outcome]:
        if scheduler is not None:
            return _engines.on_dask(these, scheduler)
        return _engines.on_processes(these, workers or os.cpu_count() or 1, memory)

    for records in _all_records(tasks, run):
        manifest.add(records)
        summary.count(records)
        summary.seconds = time.monotonic() - began
        if progress is not None and (progress.isatty() or time.monotonic() - shown > LOG_SECONDS):
            shown = time.monotonic()
            _show(summary, total, progress)
    manifest.sort()
    if corpus.shard[1] == 1:
        shutil.rmtree(pathlib.Path(corpus.output, UNFINISHED), ignore_errors=True)
    return summary


def _show(summary: Summary, total: int, progress: TextIO) -> None:
    done = summary.labelled + summary.refused
    bar = ("#" * (20 * done // max(total, 1))).ljust(20, ".")
    print(f"[{bar}] of {total}: {summary}", end="\r" if progress.isatty() else "\n", file=progress, flush=True)


def _all_records(tasks: Sequence[Task], run: Any) -> Iterator[list[Record]]:
    """The records of all tasks. A mesh that no worker survives is found, and refused like any other."""
    deadly: list[tuple[Task, str]] = []
    for task, result in run(tasks) if tasks else ():
        if isinstance(result, str):
            deadly.append((task, result))
        else:
            yield result
    for task, reason in deadly:
        alone = task.alone() if len(task.meshes) > 1 else []
        culprits = [one.meshes[0][0] for one, result in run(alone) if isinstance(result, str)] if alone else [task.meshes[0][0]]
        shutil.rmtree(task.place_alone, ignore_errors=True)
        again = replace(task, refused=tuple((name, reason) for name in culprits))
        for _, result in run([again]):
            if isinstance(result, str):
                raise RuntimeError(f"no worker survives {task.archive}, though each survives its meshes one by one")
            yield result


def verify(corpus: Corpus) -> list[str]:
    """What is wrong with the labels in a folder; nothing, if each mesh has its labels once, with the bytes of the manifests."""
    folder = pathlib.Path(corpus.output)
    manifests = sorted(folder.glob("manifest*.jsonl"))
    records = list(itertools.chain.from_iterable(map(_records, manifests)))
    settings = [r for r in records if "echinus" in r]
    complaints = [f"{folder}: there are labels of other settings" for r in settings if r != corpus.settings()][:1]
    times = collections.Counter(r["mesh"] for r in records if "mesh" in r)
    complaints += [f"{name}: is recorded {n} times" for name, n in sorted(times.items()) if n > 1]
    complaints += [f"{name}: has no labels" for name, _ in corpus.meshes if name not in times]
    named = {name for r in records for name in r.get("files", [])}
    files = {r["file"]: r["sha256"] for r in records if "file" in r}
    complaints += [f"{name}: has no hash" for name in sorted(named - set(files))]
    for name, expected in sorted(files.items()):
        path = folder / name
        if not path.exists():
            complaints.append(f"{name}: is missing")
        elif _hash_of(path) != expected:
            complaints.append(f"{name}: has other bytes than it had")
    present = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file() and UNFINISHED not in path.parts}
    complaints += [f"{name}: is in no manifest" for name in sorted(present - set(files) - {path.name for path in manifests})]
    return complaints


def _hash_of(path: pathlib.Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
