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
"""The kinds of errors, for programs.

``unreadable``, ``unwritable``: the system refused a file; ``wrong_format``, ``damaged``, ``unsupported_version``: the
contents of a file; ``invalid_mesh``, ``invalid_options``, ``invalid_scene``: an argument; ``diverged``: a simulation
exceeded its bounds.
"""


class Error(Exception):
    """An error of the library.

    ``str(error)`` is one sentence that names the file, face, byte or frame.

    Attributes
    ----------
    code : ErrorCode
        The kind of error, for programs: ``unreadable`` and ``unwritable`` if the system refuses a file;
        ``wrong_format``, ``damaged`` and ``unsupported_version`` for the contents of a file;
        ``invalid_mesh``, ``invalid_options`` and ``invalid_scene`` for arguments; ``diverged`` for a
        simulation that exceeded its bounds.
    """

    code: ErrorCode

    def __init__(self, sentence: str, code: ErrorCode) -> None:
        super().__init__(sentence, code)
        self.code = code

    def __str__(self) -> str:
        return str(self.args[0])
