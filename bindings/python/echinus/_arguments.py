"""Conversion of arguments to the types of the library.

A wrong type raises a TypeError and a wrong value a ValueError; the message names the argument.
"""

from __future__ import annotations

import json
import math
import operator
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

Kind = TypeVar("Kind")

_MOST_WHOLE = 2**32 - 1
_MOST_THREADS = 2**31 - 1


def kind_name(value: object) -> str:
    return type(value).__name__


def number(name: str, value: Any) -> float:
    if isinstance(value, (str, bytes, bytearray)) or not hasattr(value, "__float__"):
        raise TypeError(f"{name} must be a number, not {value!r}")
    try:
        return float(value)
    except (TypeError, OverflowError, ValueError) as error:  # an array of several numbers, or beyond a double
        raise type(error)(f"{name} must be one number: {error}") from None


def whole(name: str, value: Any, least: int = 0, most: int = _MOST_WHOLE) -> int:
    try:
        result = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {value!r}") from None
    if not least <= result <= most:
        raise ValueError(f"{name} must be a whole number from {least} to {most}, not {result}")
    return result


def index(name: str, value: Any) -> int:
    """Checks an index; the library checks that it is in range."""
    return whole(name, value, -(2**63), 2**63 - 1)


def threads_of(value: Any) -> int:
    """Checks a number of threads; 0 means all cores."""
    return whole("threads", value, 0, _MOST_THREADS)


def flag(name: str, value: Any) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} must be True or False, not {value!r}")
    return bool(value)


def one_of(name: str, value: Any, choices: Sequence[str]) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name} must be a str, not {value!r}")
    if value not in choices:
        raise ValueError(f"{name} must be {', '.join(map(repr, choices[:-1]))} or {choices[-1]!r}, not {value!r}")
    return value


def numbers(name: str, values: Any, words: str = "numbers") -> tuple[float, ...]:
    if isinstance(values, (str, bytes, bytearray)) or not isinstance(values, Iterable):
        raise TypeError(f"{name} must be {words}, not {values!r}")
    return tuple(number(f"each of {name}", entry) for entry in values)


def _numbers(name: str, values: Any, count: int, words: str) -> tuple[float, ...]:
    entries = numbers(name, values, words)
    if len(entries) != count:
        raise ValueError(f"{name} must be {words}, not {values!r}")
    return entries


def vector(name: str, values: Any) -> tuple[float, float, float]:
    x, y, z = _numbers(name, values, 3, "three numbers")
    return x, y, z


def quaternion(name: str, values: Any) -> tuple[float, float, float, float]:
    w, x, y, z = _numbers(name, values, 4, "the four numbers w, x, y, z of a quaternion")
    return w, x, y, z


def of_kind(name: str, value: Any, kind: type[Kind], made_by: str = "") -> Kind:
    if not isinstance(value, kind):
        raise TypeError(f"{name} must be of the class {kind.__name__}, not {kind_name(value)}" + made_by)
    return value


def list_of_kind(name: str, values: Any, kind: type[Kind]) -> list[Kind]:
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        raise TypeError(f"{name} must be a list of {kind.__name__}, not {kind_name(values)}")
    return [of_kind(f"{name}[{i}]", value, kind) for i, value in enumerate(values)]


def path_of(value: Any, name: str = "a path") -> str:
    """Converts the path of a file or folder."""
    if not isinstance(value, (str, bytes, os.PathLike)):
        raise TypeError(f"{name} must be a str or os.PathLike, not {kind_name(value)}")
    path = os.fsdecode(value)
    if "\0" in path:
        raise ValueError(f"{name} must not contain a null byte: {path!r}")
    return path


def json_of(values: Mapping[str, Any]) -> str:
    """Converts values to JSON; NaN, infinity and other objects raise errors that name their keys."""
    return json.dumps(_plain("", values))


def _plain(key: str, value: Any) -> Any:
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(k): _plain(f"{key}.{k}" if key else str(k), v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(f"{key}[{i}]", v) for i, v in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError(f"{key} must be finite, not {value!r}")
    if value is not None and not isinstance(value, (str, int, float)):
        raise TypeError(f"{key} must be a number, a text, a list or a mapping, not {value!r}")
    return value
