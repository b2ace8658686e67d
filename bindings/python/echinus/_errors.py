"""The exception of the library."""

from __future__ import annotations

from typing import Literal

ErrorCode = Literal[
    "unreadable",
    "unwritable",
    "wrong_format",
    "damaged",
    "unsupported_version",
    "invalid_mesh",
    "invalid_options",
    "invalid_scene",
    "diverged",
]


class Error(Exception):
    """What the library refuses.

    ``str(error)`` is one sentence that names the file, face, byte or frame at fault.

    Attributes
    ----------
    code
        The kind of error, for programs.
    """

    code: ErrorCode

    def __init__(self, sentence: str, code: ErrorCode) -> None:
        super().__init__(sentence, code)
        self.code = code

    def __str__(self) -> str:
        return str(self.args[0])
