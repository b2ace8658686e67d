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
import re
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
        Two files have the same name, which is their path below the source without the extension; a path is empty, or
        a list no text in UTF-8.
    """
    found: dict[str, str] = {}
    for source in sources:
        if not os.fspath(source):
            raise ValueError("a path of meshes is empty; name folders, mesh files or lists of them")
        for name, path in _meshes_of(pathlib.Path(source)):
            name = name.replace(".", "_")
            if found.setdefault(name, str(path)) != str(path):
                raise ValueError(f"{found[name]} and {path} would both be labelled as {name}; rename one")
    return sorted(found.items())


def _meshes_of(source: pathlib.Path) -> Iterator[tuple[str, pathlib.Path]]:
    if source.suffix == ".txt":
        for line in _text_of(source).splitlines():
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


def _text_of(source: pathlib.Path) -> str:
    try:
        text = source.read_text("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{source} is no text in UTF-8 ({error}); a list of meshes has a path a line") from None
    if "\0" in text:
        raise ValueError(f"{source} is no text, it has a null byte; a list of meshes has a path a line, in UTF-8")
    return text


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


class _Manifest:
    """manifest.jsonl: the settings, then a line for each mesh and each file, sorted in the end.

    While a run goes on, lines are added as results come; one that a crash cut short is dropped.
    """

    def __init__(self, corpus: Corpus) -> None:
        i, n = corpus.shard
        name = "manifest.jsonl" if n == 1 else f"manifest-{i}-of-{n}.jsonl"
        self.path = pathlib.Path(corpus.output, name)
        self.settings = corpus.settings()
        for path, parts in _manifests(pathlib.Path(corpus.output)):
            if parts != n:
                raise ValueError(f"{path}: the labels in this folder are made in {_parts(parts)}, now {_parts(n)}; choose another folder")
            if difference := _difference(path, self.settings):
                raise ValueError(difference)

    def finished(self, tasks: Iterable[Task]) -> list[Task]:
        """Those with a record of each mesh that need not be tried again, and with the files that the records name."""
        records = list(_records(self.path))
        whole = {r["file"] for r in records if "file" in r and _size(self.path.parent / r["file"]) == r["bytes"]}
        record_of = {r["mesh"]: r for r in records if "mesh" in r}
        meshes_of: dict[str, set[str]] = collections.defaultdict(set)
        for name, record in record_of.items():
            for file in record.get("files", []):
                meshes_of[file].add(name)

        def is_finished(task: Task) -> bool:
            names = {name for name, _ in task.meshes}
            if not all(name in record_of and "again" not in record_of[name] for name in names):
                return False
            files = {file for name in names for file in record_of[name].get("files", [])}
            if task.archive is not None:  # no other one: a corpus that has changed fills its archives anew
                return files <= {task.archive} <= whole and meshes_of[task.archive] <= names
            return files <= whole

        return [task for task in tasks if is_finished(task)]

    def keep(self, tasks: Iterable[Task]) -> None:
        """Forgets what is not about these tasks."""
        meshes = {name for task in tasks for name, _ in task.meshes}
        files = {task.archive for task in tasks}
        files |= {name for r in _records(self.path) if r.get("mesh") in meshes for name in r.get("files", [])}
        self._write(r for r in _records(self.path) if r.get("mesh") in meshes or ("file" in r and r["file"] in files))

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
            except (ValueError, RecursionError) as error:
                raise ValueError(_no_record(manifest, number, str(error))) from None
            if not _is_record(record):
                raise ValueError(_no_record(manifest, number, "neither settings nor a mesh nor a file"))
            yield record


def _is_record(value: Any) -> bool:
    if not isinstance(value, dict):
        return False
    if "mesh" in value:
        files = value.get("files", [])
        return "file" not in value and isinstance(files, list) and all(isinstance(name, str) for name in [value["mesh"], *files])
    if "file" in value:
        return isinstance(value["file"], str) and {"sha256", "bytes"} <= value.keys()
    return "echinus" in value


def _no_record(manifest: pathlib.Path, number: int, why: str) -> str:
    return f"{manifest}, line {number} is no record ({why}); remove the file to label all meshes again"


def _manifests(folder: pathlib.Path) -> list[tuple[pathlib.Path, int]]:
    """The manifests of a folder, and of how many parts each is."""
    names = ((path, re.fullmatch(r"manifest(?:-\d+-of-(\d+))?\.jsonl", path.name)) for path in sorted(folder.glob("manifest*.jsonl")))
    return [(path, int(match[1] or 1)) for path, match in names if match]


def _parts(count: int) -> str:
    return f"{count} parts (--shard i/{count})" if count > 1 else "one part (no --shard)"


def _difference(manifest: pathlib.Path, settings: Record) -> str | None:
    """Says which setting of a manifest is another."""
    theirs: Record = next(_records(manifest), {})
    if "echinus" not in theirs:
        return f"{manifest}: there are no settings in its first line; remove the file to label all meshes again"
    was, now = _flat(theirs), _flat(settings)
    for name in now | was:
        if was.get(name) != now.get(name):
            return (
                f"{manifest}: the labels in this folder were made with other settings: "
                f"{name} was {was.get(name)}, and is {now.get(name)} now; choose another folder"
            )
    return None


def _flat(settings: Record) -> Record:
    sampling = settings.get("sampling")
    return settings | sampling | {"sampling": None} if isinstance(sampling, dict) else settings


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
    again
        Those of the refused that the next run tries again: what they lacked is memory or time.
    already
        Meshes that an earlier run had done.
    """

    already: int = 0
    labelled: int = 0
    refused: int = 0
    again: int = 0
    points: int = 0
    seconds: float = 0.0

    def count(self, records: Iterable[Record]) -> None:
        for record in records:
            self.labelled += "report" in record
            self.refused += "refused" in record
            self.again += "again" in record
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
    """Labels all meshes that have no labels yet, also those that were refused for want of memory or time.

    The labels are the same bytes whoever computes them.

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
    ModuleNotFoundError
        A scheduler is given, and Dask is not installed.
    RuntimeError
        An archive cannot be written for want of memory, though each of its meshes can be labelled.
    """
    if scheduler is not None:
        _engines.require_dask()
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
        try:
            yield
        finally:
            if _is(file, path):  # else a whole run has removed it with its folder
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
    finished = manifest.finished(mine)
    manifest.keep(finished)
    done = {task.meshes for task in finished}
    tasks = [task for task in mine if task.meshes not in done]
    summary, began = Summary(already=sum(map(len, done))), time.monotonic()
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
                raise RuntimeError(
                    f"{task.archive}: no worker survives it, though each of its meshes alone; give workers more memory, or archives fewer meshes"
                )
            yield result


@dataclass(frozen=True)
class Findings:
    """What is there of the labels of a corpus.

    Attributes
    ----------
    complaints
        What is wrong with its labels.
    surplus
        Files that belong to no mesh with labels, for instance because their mesh was taken out of the corpus.
    refused, again
        Meshes without labels, and those of them that the next run tries again.
    """

    complaints: list[str]
    surplus: list[str]
    meshes: int
    refused: int
    again: int

    def sentences(self) -> list[str]:
        return self.complaints + [f"{name}: belongs to no labelled mesh of the corpus" for name in self.surplus]

    def __str__(self) -> str:
        refused = f", {self.refused} of them refused: each of the others" if self.refused else ": each"
        text = f"{self.meshes} meshes{refused} has its labels once, unchanged"
        if self.again:
            text += f"\n{self.again} of the refused may succeed with more memory or time: the same command without --verify tries them again"
        if self.surplus:
            text += f"\nfiles that belong to no labelled mesh of the corpus: {len(self.surplus)}; remove those that you do not want"
        return text


def verify(corpus: Corpus) -> list[str]:
    """What is wrong with the labels in a folder, and which files there belong to no labelled mesh; nothing, if each mesh
    was refused or has its labels once, with the bytes of the manifests."""
    return examine(corpus).sentences()


def examine(corpus: Corpus) -> Findings:
    folder, settings = pathlib.Path(corpus.output), corpus.settings()
    manifests = [path for path, _ in _manifests(folder)]
    records = list(itertools.chain.from_iterable(map(_records, manifests)))
    complaints = [difference for path in manifests if (difference := _difference(path, settings))]
    archive_of = {name: task.archive for task in replace(corpus, shard=(0, 1)).tasks() for name, _ in task.meshes}
    ours = [r for r in records if r.get("mesh") in archive_of]
    times = collections.Counter(r["mesh"] for r in ours)
    complaints += [f"{name}: is recorded {n} times" for name, n in sorted(times.items()) if n > 1]
    complaints += [f"{name}: has no labels" for name in archive_of if name not in times]
    complaints += _misplaced(records, archive_of)
    named = {name for r in ours for name in r.get("files", [])}
    hashes = {r["file"]: r["sha256"] for r in records if "file" in r}
    complaints += [f"{name}: has no hash" for name in sorted(named - set(hashes))]
    used = named | {archive for archive in archive_of.values() if archive is not None and archive in hashes}
    complaints += _changed(folder, {name: hashes[name] for name in sorted(used) if name in hashes})
    present = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file() and UNFINISHED not in path.parts}
    surplus = sorted(present - used - {path.name for path in manifests})
    refused = [r for r in ours if "refused" in r]
    return Findings(complaints, surplus, len(archive_of), len(refused), sum("again" in r for r in refused))


def _misplaced(records: Iterable[Record], archive_of: dict[str, str | None]) -> Iterator[str]:
    """Archives as they were before meshes came into the corpus or went."""
    archives = {archive for archive in archive_of.values() if archive is not None}
    for record in records:
        for file in record.get("files", []):
            place = archive_of.get(record["mesh"])
            if file != place and (place is not None or file in archives):
                yield f"{record['mesh']}: has labels in {file}, as before the corpus changed; the same command without --verify mends that"


def _changed(folder: pathlib.Path, hashes: dict[str, str]) -> Iterator[str]:
    for name, expected in hashes.items():
        path = folder / name
        if not path.exists():
            yield f"{name}: is missing"
        elif _hash_of(path) != expected:
            yield f"{name}: has other bytes than it had"


def _hash_of(path: pathlib.Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
