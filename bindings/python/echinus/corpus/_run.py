"""A run over a corpus: the remaining tasks, and the treatment of meshes that crash workers."""

from __future__ import annotations

import contextlib
import functools
import os
import shutil
import time
from collections.abc import Generator, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TextIO

from echinus._arguments import of_kind, whole
from echinus.corpus import _engines
from echinus.corpus._corpus import Corpus
from echinus.corpus._locks import alone, one_at_a_time, unfinished_files
from echinus.corpus._manifest import Manifest
from echinus.corpus._progress import Bar, counted
from echinus.corpus._tasks import Record, Task


@dataclass
class Summary:
    """The result of a run.

    Attributes
    ----------
    labelled, refused, points
        The numbers of meshes labelled and refused, and of points, in this run.
    again
        Number of refused meshes that the next run tries again: memory or time did not suffice, or other files of a glTF may
        have been missing.
    already
        Number of meshes that an earlier run labelled or refused.
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
        refused = f", {self.refused} of them refused" if self.refused else ""
        return f"{counted(done)}{refused}; {done * rate:.3g} meshes/s, {self.points * rate:.3g} points/s"


def label(
    corpus: Corpus,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    memory: int = 4 << 30,
    progress: TextIO | None = None,
) -> Summary:
    """Labels all meshes that have no labels yet or whose files have changed since, and those that were refused because memory
    or time did not suffice.

    The bytes of the labels do not depend on the workers.

    Parameters
    ----------
    workers
        Processes of this machine, by default as many as it has cores.
    scheduler
        The address of a Dask scheduler, whose workers are used instead. They need the package, and must reach the files of the
        meshes and of the labels by the same absolute paths.
    memory
        The address space of a worker process, in bytes: a mesh that needs more is refused.
    progress
        The stream on which to show the progress.

    Raises
    ------
    ValueError
        The folder has labels that were made with other settings, another run is writing to it, ``workers`` is not positive, or
        ``scheduler`` is not an address.
    OSError
        A file cannot be written, or the scheduler does not answer.
    ModuleNotFoundError
        A scheduler is given, and Dask is not installed.
    RuntimeError
        Memory does not suffice to write an archive, although each of its meshes can be labelled; workers die before they label
        anything; or the cluster is no longer available.
    """
    of_kind("corpus", corpus, Corpus)
    worker_count = whole("workers", workers, 1) if workers is not None else os.cpu_count() or 1
    whole("memory", memory, 1, 2**63 - 1)
    if os.path.exists(corpus.output) and not os.path.isdir(corpus.output):
        raise NotADirectoryError(f"{corpus.output} is a file; the labels take a folder")
    engine: contextlib.AbstractContextManager[_engines.Engine]
    if scheduler is not None:
        engine = _engines.dask_cluster(of_kind("scheduler", scheduler, str), progress)
    else:
        engine = contextlib.nullcontext(functools.partial(_engines.on_processes, worker_count=worker_count, memory=memory))
    with engine as run:
        os.makedirs(corpus.output, exist_ok=True)
        with alone(corpus), unfinished_files(corpus) as unfinished:
            return _label(corpus, unfinished, run, progress)


def _label(corpus: Corpus, unfinished: str, run: _engines.Engine, progress: TextIO | None) -> Summary:
    with one_at_a_time(corpus):
        manifest = Manifest(corpus, unfinished)
    try:
        finished, left = manifest.divide(corpus.tasks(unfinished), progress)
        manifest.keep(finished, left)
        summary, began = Summary(already=sum(len(task.meshes) for task in finished)), time.monotonic()
        bar = Bar(progress, sum(len(task.meshes) for task in left))
        with bar, contextlib.closing(_all_records(left, run)) as results:  # closing it ends the workers
            for records in results:
                manifest.add(records)
                summary.count(records)
                summary.seconds = time.monotonic() - began
                bar.show(summary.labelled + summary.refused, str(summary))
        manifest.sort()
    except BaseException:
        manifest.discard_settings()
        raise
    return summary


def _all_records(tasks: Sequence[Task], run: _engines.Engine) -> Generator[list[Record], None, None]:
    """Yields the records of all tasks. A mesh that crashes every worker is identified and refused."""
    deadly: list[tuple[Task, str]] = []
    for task, result in run(tasks) if tasks else ():
        if isinstance(result, str):
            deadly.append((task, result))
        else:
            yield result
    for task, reason in deadly:
        single = task.alone() if len(task.meshes) > 1 else []
        culprits = [one.meshes[0][0] for one, result in run(single) if isinstance(result, str)] if single else [task.meshes[0][0]]
        shutil.rmtree(task.place_alone, ignore_errors=True)
        again = replace(task, refused=tuple((name, reason) for name in culprits))
        for _, result in run([again]):
            if isinstance(result, str):
                raise RuntimeError(_of_dead_workers(again))
            yield result


def _of_dead_workers(task: Task) -> str:
    if task.archive is not None and len(task.refused) < len(task.meshes):
        return f"{task.archive}: no worker survives it, though each of its meshes alone; give workers more memory, or archives fewer meshes"
    return 'workers die before their first mesh; give them more memory, and in a script call label() below `if __name__ == "__main__":`'
