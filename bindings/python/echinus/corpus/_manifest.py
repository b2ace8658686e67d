"""The manifest of a folder: the settings of its labels, and a record of each mesh and each file."""

from __future__ import annotations

import collections
import contextlib
import json
import pathlib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Literal, TextIO

from echinus.corpus._corpus import Corpus
from echinus.corpus._formats import names_of
from echinus.corpus._sources import UNREADABLE, Mesh, fingerprints, lies_below
from echinus.corpus._tasks import Record, Task, naming, whole_file

Change = Literal["changed", "unreadable"]


class Manifest:
    """manifest.jsonl: the settings, then a line for each mesh and each file, sorted at the end.

    During a run, lines are appended as results arrive; a line that a crash truncated is dropped.
    """

    def __init__(self, corpus: Corpus, unfinished: str) -> None:
        i, n = corpus.shard
        name = "manifest.jsonl" if n == 1 else f"manifest-{i}-of-{n}.jsonl"
        self.path = pathlib.Path(corpus.output, name)
        self.settings = corpus.settings()
        self._unfinished = unfinished
        for path, parts in manifests(pathlib.Path(corpus.output)):
            if parts != n:
                raise ValueError(f"{path}: the labels in this folder are made in {_parts(parts)}, now {_parts(n)}; choose another folder")
            if sentence := difference(path, self.settings):
                raise ValueError(sentence)
        if not self.path.exists():
            self._write([])

    def divide(self, tasks: Sequence[Task], progress: TextIO | None) -> tuple[list[Task], list[Task]]:
        """Divides tasks into those that are finished and those that remain.

        A task is finished if each of its meshes has a record, need not be tried again and has an unchanged mesh file, and if
        the files that the records name exist.
        """
        records = list(records_of(self.path))
        whole = {r["file"] for r in records if "file" in r and _size(self.path.parent / r["file"]) == r["bytes"]}
        record_of = {r["mesh"]: r for r in records if "mesh" in r}
        meshes_of: dict[str, set[str]] = collections.defaultdict(set)
        for name, record in record_of.items():
            for file in record.get("files", []):
                meshes_of[file].add(name)

        def is_complete(task: Task) -> bool:
            names = {name for name, _ in task.meshes}
            if not all(name in record_of and "again" not in record_of[name] for name in names):
                return False
            files = {file for name in names for file in record_of[name].get("files", [])}
            if task.archive is not None:  # no other archive and no other mesh: a changed corpus fills its archives differently
                return files <= {task.archive} <= whole and meshes_of[task.archive] <= names
            return files <= whole

        complete = [task for task in tasks if is_complete(task)]
        meshes = [mesh for task in complete for mesh in task.meshes]
        # A mesh that cannot be read now keeps its labels.
        changed = {mesh for mesh, change in changes_of(meshes, record_of, self.settings["max_bytes"], progress) if change == "changed"}
        finished = {task.meshes for task in complete if changed.isdisjoint(task.meshes)}
        return [task for task in tasks if task.meshes in finished], [task for task in tasks if task.meshes not in finished]

    def keep(self, finished: Sequence[Task], left: Iterable[Task]) -> None:
        """Keeps only the records of finished tasks, and removes the files of the tasks that are left, since a mesh that is
        labelled again may be refused. Archives are overwritten, and files that belong to no task stay."""
        for name in (name for task in left for name, _ in task.meshes):
            for file in names_of(name, self.settings["format"]):
                _remove(file, self.path.parent)
        meshes = {name for task in finished for name, _ in task.meshes}
        files = {task.archive for task in finished}
        files |= {file for r in records_of(self.path) if r.get("mesh") in meshes for file in r.get("files", [])}
        self._write(r for r in records_of(self.path) if r.get("mesh") in meshes or ("file" in r and r["file"] in files))

    def add(self, records: Iterable[Record]) -> None:
        with naming(self.path), self.path.open("a") as file:
            file.writelines(_line(record) for record in records)

    def sort(self) -> None:
        """Sorts the lines, so that the bytes do not depend on the order in which the labels arrived."""
        self._write(r for r in records_of(self.path) if "echinus" not in r)

    def discard_settings(self) -> None:
        """Removes the settings of a run that ended without a record, so that they do not bind the next one."""
        with contextlib.suppress(OSError, ValueError):  # the error that ended the run says more
            if all("echinus" in record for record in records_of(self.path)):
                self.path.unlink()

    def _write(self, records: Iterable[Record]) -> None:
        lines = sorted((r.get("mesh", ""), r.get("file", ""), _line(r)) for r in records)
        with whole_file(self.path, self._unfinished) as file:
            file.writelines(line.encode() for line in [_line(self.settings), *(line for _, _, line in lines)])


def changes_of(
    meshes: Sequence[Mesh], record_of: Mapping[str, Record], most: int, progress: TextIO | None
) -> Iterator[tuple[Mesh, Change]]:
    """Meshes whose files differ from those of their records, for instance because a file could not be read then, or cannot be
    read now."""
    for mesh, now in zip(meshes, fingerprints([path for _, path in meshes], most, progress), strict=True):
        record = record_of[mesh[0]]
        before = (record.get("source_bytes"), record.get("source_sha256"))
        if now == UNREADABLE:
            if before != UNREADABLE:
                yield mesh, "unreadable"
        elif now != before or _extension(record.get("source", "")) != _extension(mesh[1]):  # the extension determines the format
            yield mesh, "changed"


def _extension(path: Any) -> str:
    return pathlib.PurePath(str(path)).suffix.lower()


def records_of(manifest: pathlib.Path) -> Iterator[Record]:
    """The records of a manifest, without a truncated last line."""
    if not manifest.exists():
        return
    if not manifest.is_file():
        raise ValueError(f"{manifest} is not a file; remove it, or choose another folder")
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
    kinds = {"echinus", "mesh", "file"} & value.keys()
    if kinds == {"mesh"}:
        files = value.get("files", [])
        is_labelled = isinstance(files, list) and len(files) > 0 and all(map(lies_below, files))
        return lies_below(value["mesh"]) and is_labelled != ("refused" in value)
    if kinds == {"file"}:
        return lies_below(value["file"]) and isinstance(value.get("sha256"), str) and isinstance(value.get("bytes"), int)
    return kinds == {"echinus"} and isinstance(value.get("sampling"), dict)


def _no_record(manifest: pathlib.Path, number: int, why: str) -> str:
    return f"{manifest}, line {number} is not a record ({why}); remove the file to label all meshes again"


def manifests(folder: pathlib.Path) -> list[tuple[pathlib.Path, int]]:
    """The manifests of a folder, each with the number of parts of its run."""
    names = ((path, re.fullmatch(r"manifest(?:-\d+-of-([1-9]\d*))?\.jsonl", path.name)) for path in sorted(folder.glob("manifest*.jsonl")))
    return [(path, int(match[1] or 1)) for path, match in names if match]


def _parts(count: int) -> str:
    return f"{count} parts (--shard i/{count})" if count > 1 else "one part (no --shard)"


def difference(manifest: pathlib.Path, settings: Record) -> str | None:
    """A sentence that names a setting in which a manifest differs; None if there is none."""
    theirs: Record = next(records_of(manifest), {})
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
    flat: Record = settings | settings["sampling"] | {"sampling": None}
    return flat


def _line(record: Record) -> str:
    return json.dumps(record, sort_keys=True, separators=(",", ":")) + "\n"


def _size(path: pathlib.Path) -> int | None:
    return path.stat().st_size if path.is_file() else None


def _remove(name: str, folder: pathlib.Path) -> None:
    """Removes a file, and those folders of its path that are then empty."""
    path = folder / name
    path.unlink(missing_ok=True)
    with contextlib.suppress(OSError):  # other files are in it, or it is not there
        for parent in path.parents[: len(pathlib.PurePath(name).parts) - 1]:
            parent.rmdir()
