"""The progress of a run, and the phrases that runs and verification share."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from typing import Self, TextIO, TypeVar

Item = TypeVar("Item")
TERMINAL_SECONDS, LOG_SECONDS = 0.1, 10  # between updates


def counted(meshes: int) -> str:
    return "1 mesh" if meshes == 1 else f"{meshes} meshes"


def may_succeed(refused: int) -> str:
    return f"{refused} of the refused may succeed another time, with more memory, more time or a file that was missing"


class Bar:
    """Progress as one line that is overwritten on a terminal, or as several lines in a log."""

    def __init__(self, stream: TextIO | None, total: int) -> None:
        self._stream, self._total = stream, total
        self._is_terminal = stream is not None and stream.isatty()
        self._shown = time.monotonic()

    def show(self, done: int, text: str) -> None:
        now = time.monotonic()
        if self._stream is None or now - self._shown < (TERMINAL_SECONDS if self._is_terminal else LOG_SECONDS):
            return
        self._shown = now
        bar = ("#" * (20 * done // max(self._total, 1))).ljust(20, ".")
        line = f"[{bar}] of {self._total}: {text}"
        print(f"\r{line}\033[K" if self._is_terminal else line, end="" if self._is_terminal else "\n", file=self._stream, flush=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._is_terminal:
            print("\r\033[K", end="", file=self._stream, flush=True)


def watched(items: Iterable[Item], stream: TextIO | None, total: int, text: str) -> Iterator[Item]:
    with Bar(stream, total) as bar:
        for done, item in enumerate(items, 1):
            bar.show(done, f"{done} {text}")
            yield item
