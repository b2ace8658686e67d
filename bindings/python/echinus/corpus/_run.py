"""A run over a corpus: what is left to do, and what is done about meshes that kill workers."""

from __future__ import annotations

import contextlib
import fcntl
import os
import pathlib
import shutil
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, TextIO

from echinus.corpus import _engines
from echinus.corpus._corpus import Corpus
from echinus.corpus._manifest import Manifest
from echinus.corpus._tasks import UNFINISHED, Record, Task

LOG_SECONDS = 10  # between lines of the progress, where it is no terminal


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
    manifest = Manifest(corpus)
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
