"""Engines, which run tasks in processes of this machine or on a Dask cluster.

An engine yields each task when it is finished, in any order, with its records, or with the reason why no worker survived it.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import contextlib
import ctypes
import functools
import importlib
import itertools
import mmap
import multiprocessing
import os
import resource
import signal
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
from typing import Any, TextIO

from echinus.corpus._tasks import Record, Task, run

Outcome = tuple[Task, "list[Record] | str"]
Engine = Callable[[Iterable[Task]], Iterator[Outcome]]
ATTEMPTS = 3  # a worker may be killed for other reasons than its task


class MalformedAddress(ValueError):
    """The address of a scheduler is malformed; an address at which nothing answers gives an OSError."""


class _Worker:
    def __init__(self, memory: int) -> None:
        # Not by fork: the child would lack the threads of this process, but have the locks that they hold.
        context = multiprocessing.get_context("spawn")
        self.pipe, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, memory), daemon=True)
        with _deaf_to_interrupts():
            self.process.start()
        theirs.close()
        self.task: Task | None = None

    def give(self, task: Task) -> None:
        self.task = task
        try:
            self.pipe.send(task)
        except OSError:
            pass  # it has died, which the pipe reports as well

    def take(self) -> list[Record] | None:
        """Returns the records of the task, or None if the worker died."""
        try:
            result = self.pipe.recv()
        except (EOFError, OSError):
            self.process.join()
            return None
        if isinstance(result, MemoryError):
            raise RuntimeError("a worker has too little memory even to begin with; give it more")
        if isinstance(result, BaseException):
            raise result
        records: list[Record] = result
        return records

    def stop(self) -> None:
        self.pipe.close()
        self.process.terminate()
        self.process.join()


def _serve(pipe: Connection, memory: int) -> None:
    """The main loop of a worker, whose address space is limited so that a mesh that needs more is refused."""
    _end_with_parent()
    resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    _keep_freed_memory()
    try:
        mmap.mmap(-1, 1).close()  # not malloc, which may have kept a page although the process already exceeds the limit
    except OSError:
        pipe.send(MemoryError())
        return
    while True:
        try:
            task = pipe.recv()
        except EOFError:
            return
        try:
            pipe.send(run(task))
        except Exception as error:  # the process that started the run raises it: a full disk, or a fault of ours
            pipe.send(error)


@contextlib.contextmanager
def _deaf_to_interrupts() -> Iterator[None]:
    """Makes processes that are started in this context ignore Ctrl-C; the process that distributes the tasks handles
    it, and ends its workers."""
    resource_tracker.ensure_running()  # it would otherwise start with the first process, and unblock the signal
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _end_with_parent() -> None:
    """Ends this worker with its parent. Otherwise the worker of a killed run would continue to write while the next run
    has the lock."""
    with contextlib.suppress(AttributeError):  # Linux only
        set_death_signal = 1
        ctypes.CDLL(None).prctl(set_death_signal, signal.SIGKILL)
    parent = multiprocessing.parent_process()
    if parent is not None and not parent.is_alive():
        os._exit(1)


def _keep_freed_memory() -> None:
    """Makes the C library keep freed memory. Samples and labels are arrays of about a megabyte. By default the C library returns
    each freed array to the system, and mapping the pages of the next one takes longer than computing its numbers."""
    with contextlib.suppress(AttributeError):  # other C libraries have no such options
        set_option = ctypes.CDLL(None).mallopt
        trim_threshold, mmap_threshold = -1, -3
        set_option(trim_threshold, 64 << 20)
        set_option(mmap_threshold, 32 << 20)


def on_processes(tasks: Iterable[Task], worker_count: int, memory: int) -> Iterator[Outcome]:
    """Runs the tasks; a worker that dies is replaced, and its task is tried again."""
    again: deque[Task] = deque()
    source = iter(tasks)
    deaths: dict[Task, int] = {}
    workers: list[_Worker] = []
    try:
        for task in itertools.islice(source, worker_count):
            workers.append(_Worker(memory))
            workers[-1].give(task)
        while any(worker.task is not None for worker in workers):
            ready = wait([worker.pipe for worker in workers if worker.task is not None])
            for i, worker in enumerate(workers):
                if worker.pipe not in ready:
                    continue
                given, records = worker.task, worker.take()
                assert given is not None
                if records is None:
                    worker.stop()
                    workers[i] = worker = _Worker(memory)
                    deaths[given] = deaths.get(given, 0) + 1
                    if deaths[given] < ATTEMPTS:
                        again.append(given)
                _next(worker, source, again)
                if records is not None:
                    deaths.pop(given, None)
                    yield given, records
                elif deaths[given] >= ATTEMPTS:
                    yield given, f"{ATTEMPTS} workers died of it"
    finally:
        for worker in workers:
            worker.stop()


def _next(worker: _Worker, source: Iterator[Task], again: deque[Task]) -> None:
    worker.task = None
    if again:
        worker.give(again.popleft())
    else:
        for task in itertools.islice(source, 1):
            worker.give(task)


@contextlib.contextmanager
def dask_cluster(scheduler: str, progress: TextIO | None) -> Iterator[Engine]:
    """Runs the tasks on the workers of an existing cluster, which reach the same files by the same paths.

    The scheduler repeats the tasks of workers that died, at most as often as its setting ``allowed-failures`` allows.
    """
    dask = _distributed()
    try:
        dask.comm.get_address_host_port(scheduler)  # the client would complain only after seconds, with a traceback
    except ValueError as error:
        raise MalformedAddress(f"scheduler {scheduler!r} is not an address, for instance tcp://host:8786 ({error})") from None
    try:
        client = dask.Client(scheduler, set_as_default=False)
    except OSError as error:
        raise OSError(f"scheduler {scheduler} does not answer ({error})") from None
    with client:
        if progress is not None and not client.scheduler_info()["workers"]:
            print(f"{scheduler} has no workers yet; waiting for some", file=progress, flush=True)
        yield functools.partial(_on_dask, dask, client)


def _distributed() -> Any:
    try:
        return importlib.import_module("distributed")
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(f"a scheduler needs Dask, Debian's package python3-distributed ({error})", name=error.name) from None


def _on_dask(dask: Any, client: Any, tasks: Iterable[Task], window: int = 1000) -> Iterator[Outcome]:
    source = iter(tasks)
    task_of: dict[Any, Task] = {}

    def submitted(task: Task) -> Any:
        future = client.submit(run, task, pure=False)
        task_of[future] = task
        return future

    completed = dask.as_completed([submitted(task) for task in itertools.islice(source, window)], loop=client.loop)
    for future in completed:
        task = task_of.pop(future)
        for following in itertools.islice(source, 1):
            completed.add(submitted(following))
        try:
            yield task, future.result()
        except dask.KilledWorker:
            yield task, "the cluster's workers died of it"
        except ModuleNotFoundError as error:
            raise RuntimeError(f"the workers of {client.scheduler.address} cannot import echinus ({error}); install it there") from None
        except (asyncio.CancelledError, concurrent.futures.CancelledError):
            raise RuntimeError(f"the cluster at {client.scheduler.address} has gone; the same command continues from here") from None
