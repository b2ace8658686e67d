"""Finds faults in the labels of a corpus."""

from __future__ import annotations

import collections
import itertools
import os
import pathlib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TextIO

from echinus._arguments import of_kind
from echinus.corpus._corpus import UNFINISHED, Corpus
from echinus.corpus._manifest import changes_of, difference, manifests, records_of
from echinus.corpus._progress import counted, may_succeed, watched
from echinus.corpus._sources import hash_of
from echinus.corpus._tasks import Record


@dataclass(frozen=True)
class Findings:
    """The result of the verification of a corpus.

    Attributes
    ----------
    complaints
        The faults of its labels.
    surplus
        Files that belong to no labelled mesh, for instance because their mesh was removed from the corpus.
    refused, again
        Numbers of meshes without labels, and of those that the next run tries again.
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
        text = f"{counted(self.meshes)}{refused} has its labels once, unchanged"
        if self.again:
            text += f"\n{may_succeed(self.again)}: the same command without --verify tries them again"
        if self.surplus:
            text += f"\nfiles that belong to no labelled mesh of the corpus: {len(self.surplus)}; remove those that you do not want"
        return text


def verify(corpus: Corpus) -> list[str]:
    """The faults of the labels in a folder, and the files there that belong to no labelled mesh. There are none if each
    mesh was refused or has its labels once, with the bytes of the manifests."""
    return examine(corpus).sentences()


def examine(corpus: Corpus, progress: TextIO | None = None) -> Findings:
    folder, settings = pathlib.Path(of_kind("corpus", corpus, Corpus).output), corpus.settings()
    if folder.exists():
        os.listdir(folder)  # raises an error if it cannot be read
    found = [path for path, _ in manifests(folder)]
    records = list(itertools.chain.from_iterable(map(records_of, found)))
    complaints = [sentence for path in found if (sentence := difference(path, settings))]
    archive_of = {name: archive for archive, meshes in corpus.groups() for name, _ in meshes}
    ours = [r for r in records if r.get("mesh") in archive_of]
    times = collections.Counter(r["mesh"] for r in ours)
    complaints += [f"{name}: is recorded {n} times" for name, n in sorted(times.items()) if n > 1]
    complaints += [f"{name}: has no labels" for name in archive_of if name not in times]
    complaints += _of_other_meshes(corpus, ours, progress)
    complaints += _misplaced(records, archive_of)
    named = {name for r in ours for name in r.get("files", [])}
    hashes = {r["file"]: r["sha256"] for r in records if "file" in r}
    complaints += [f"{name}: has no hash" for name in sorted(named - set(hashes))]
    used = named | {archive for archive in archive_of.values() if archive is not None and archive in hashes}
    complaints += _changed(folder, {name: hashes[name] for name in sorted(used) if name in hashes}, progress)
    present = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file() and UNFINISHED not in path.parts}
    sources = {os.path.relpath(path, os.path.abspath(folder)) for _, path in corpus.meshes}
    surplus = sorted(present - used - sources - {path.name for path in found})
    refused = [r for r in ours if "refused" in r]
    return Findings(complaints, surplus, len(archive_of), len(refused), sum("again" in r for r in refused))


def _of_other_meshes(corpus: Corpus, records: Iterable[Record], progress: TextIO | None) -> Iterator[str]:
    """The labels and refusals of mesh files that have changed since."""
    record_of = {record["mesh"]: record for record in records if "again" not in record}
    meshes = [mesh for mesh in corpus.meshes if mesh[0] in record_of]
    for (name, path), change in changes_of(meshes, record_of, corpus.max_bytes, progress):
        what = "refused" if "refused" in record_of[name] else "labelled"
        if change == "unreadable":
            yield f"{name}: {path} cannot be read any more; the mesh was {what}, and stays so"
        else:
            yield f"{name}: {path} has changed since it was {what}; the same command without --verify labels it again"


def _misplaced(records: Iterable[Record], archive_of: dict[str, str | None]) -> Iterator[str]:
    """Labels in archives that were made before meshes were added to the corpus or removed from it."""
    archives = {archive for archive in archive_of.values() if archive is not None}
    for record in (record for record in records if "mesh" in record):
        for file in record.get("files", []):
            place = archive_of.get(record["mesh"])
            if file != place and (place is not None or file in archives):
                yield f"{record['mesh']}: has labels in {file}, as before the corpus changed; the same command without --verify corrects this"


def _changed(folder: pathlib.Path, hashes: Mapping[str, str], progress: TextIO | None) -> Iterator[str]:
    for name, expected in watched(hashes.items(), progress, len(hashes), "files of labels compared with the manifest"):
        path = folder / name
        try:
            if not path.is_file():
                yield f"{name}: is missing; the same command without --verify makes it again"
            elif hash_of(path) != expected:
                yield f"{name}: has changed since it was written; remove it, and the same command without --verify makes it again"
        except OSError as error:
            yield f"{name}: cannot be read ({error.strerror})"
