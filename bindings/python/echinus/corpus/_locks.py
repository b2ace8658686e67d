"""Locks, so that no two runs write the same labels at the same time.

The locks are released when the process ends, for whatever reason. :func:`unfinished_files` removes the unfinished files of a
run at its end or, if it was killed, when the next run begins.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import pathlib
import secrets
import shutil
from collections.abc import Iterator
from typing import TextIO

from echinus.corpus._corpus import UNFINISHED, Corpus


@contextlib.contextmanager
def alone(corpus: Corpus) -> Iterator[None]:
    """Holds the locks that exclude other runs on the same part, or on the whole.

    All runs lock the folder; runs on parts share this lock. So no run removes files while a different run is in progress.

    Raises
    ------
    ValueError
        Another run holds them.
    """
    i, n = corpus.shard
    folder = os.open(corpus.output, os.O_RDONLY)
    try:
        _lock(folder, fcntl.LOCK_NB | (fcntl.LOCK_SH if n > 1 else fcntl.LOCK_EX))
        with _part_locked(pathlib.Path(corpus.output, UNFINISHED, f"lock-{i}-of-{n}")):
            yield
    except BlockingIOError:
        raise ValueError(f"{corpus.output}: another run is writing these labels; wait for it, or choose another folder") from None
    finally:
        os.close(folder)


@contextlib.contextmanager
def one_at_a_time(corpus: Corpus) -> Iterator[None]:
    """Holds a lock while a part reads the files that other parts, which run at the same time, have written.

    Within :func:`alone`.
    """
    unfinished = os.open(pathlib.Path(corpus.output, UNFINISHED), os.O_RDONLY)
    try:
        _lock(unfinished, fcntl.LOCK_EX)
        yield
    finally:
        os.close(unfinished)


@contextlib.contextmanager
def unfinished_files(corpus: Corpus) -> Iterator[str]:
    """The path of a new folder for the files that a run is writing. Used within :func:`alone`."""
    i, n = corpus.shard
    unfinished, prefix = pathlib.Path(corpus.output, UNFINISHED), f"part-{i}-of-{n}-"
    for left in unfinished.glob(f"{prefix}*"):  # the folder of a run that was killed
        shutil.rmtree(left, ignore_errors=True)
    folder = os.path.abspath(unfinished / f"{prefix}{secrets.token_hex(8)}")
    os.mkdir(folder)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@contextlib.contextmanager
def _part_locked(path: pathlib.Path) -> Iterator[None]:
    with contextlib.ExitStack() as stack:
        while True:
            file = stack.enter_context(_opened(path))
            _lock(file.fileno(), fcntl.LOCK_NB | fcntl.LOCK_EX)
            if _is(file, path):  # otherwise an earlier run has removed it in the meantime
                break
        try:
            yield
        finally:
            if _is(file, path):  # otherwise a run on the whole corpus has removed it with its folder
                path.unlink()
            with contextlib.suppress(OSError):  # other files are in it, or it is gone
                path.parent.rmdir()


def _opened(path: pathlib.Path) -> TextIO:
    while True:
        path.parent.mkdir(exist_ok=True)
        with contextlib.suppress(FileNotFoundError):  # another run has just ended
            return path.open("a")


def _lock(descriptor: int, how: int) -> None:
    """Raises BlockingIOError if another process holds the lock. Does nothing on a file system without locks."""
    try:
        fcntl.flock(descriptor, how)
    except BlockingIOError:
        raise
    except OSError:
        pass


def _is(file: TextIO, path: pathlib.Path) -> bool:
    try:
        return os.path.samestat(os.fstat(file.fileno()), path.stat())
    except FileNotFoundError:
        return False
