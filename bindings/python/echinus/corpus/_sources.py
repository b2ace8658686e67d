"""The mesh files of a corpus: their names, and fingerprints that reveal changes."""

from __future__ import annotations

import contextlib
import hashlib
import os
import pathlib
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TextIO

from echinus._arguments import path_of
from echinus._meshes import Path
from echinus.corpus._progress import watched

EXTENSIONS = (".obj", ".ply", ".stl", ".off", ".gltf", ".glb", ".3ds")
Mesh = tuple[str, str]  # name, path
Fingerprint = tuple["int | None", "str | None"]  # bytes and SHA-256
UNREADABLE: Fingerprint = (None, None)
SLICE = 10_000  # the number of files whose fingerprints are requested at once


def find_meshes(sources: Path | Sequence[Path]) -> list[Mesh]:
    """The name and path of each mesh file, sorted by name.

    Parameters
    ----------
    sources
        One or several of: a folder, with all its subfolders; a mesh file; a list of mesh files (``.txt``), with one path per
        line, relative to the list's folder.

    Raises
    ------
    FileNotFoundError
        A source does not exist. A file that a list names may be missing; it is refused like a damaged mesh.
    OSError
        A folder cannot be read.
    ValueError
        Two files have the same name, which is the path below the source without the extension; a path is empty; or a list is
        not text in UTF-8.
    """
    if isinstance(sources, (str, bytes, os.PathLike)):
        sources = [sources]
    if not isinstance(sources, Iterable):
        raise TypeError(f"sources must be paths, not {sources!r}")
    return by_name((name.replace(".", "_"), path) for source in sources for name, path in _meshes_of(path_of(source)))


def by_name(meshes: Iterable[tuple[str, Path]]) -> list[Mesh]:
    """Sorts the meshes, drops duplicates and makes paths absolute, since workers may run in other folders."""
    path_of_name: dict[str, str] = {}
    for name, place in meshes:
        path = os.path.abspath(path_of(place))
        if path_of_name.setdefault(name, path) != path:
            raise ValueError(f"{path_of_name[name]} and {path} would both be labelled as {name}; rename one")
    return sorted(path_of_name.items())


def _meshes_of(path: str) -> Iterator[tuple[str, pathlib.Path]]:
    if not path:
        raise ValueError("a path of meshes is empty; name folders, mesh files or lists of them")
    source = pathlib.Path(path)
    if source.suffix.lower() == ".txt" and not source.is_dir():
        for number, line in enumerate(_text_of(source).splitlines(), 1):
            if line.strip():
                relative = pathlib.PurePath(line.strip())
                if not relative.name:
                    raise ValueError(f"{source}, line {number}: {line.strip()!r} is the path of no file")
                yield str(relative.relative_to(relative.anchor).with_suffix("")), source.parent / relative
    elif source.is_dir():
        for folder, _, files in os.walk(source, onerror=_raise):
            for file in files:
                mesh = pathlib.Path(folder, file)
                if mesh.suffix.lower() in EXTENSIONS:
                    yield str(mesh.relative_to(source).with_suffix("")), mesh
    elif source.exists():
        yield source.stem, source
    else:
        raise FileNotFoundError(f"there is no folder or file {source}")


def _raise(error: OSError) -> None:
    raise error


def _text_of(source: pathlib.Path) -> str:
    try:
        text = source.read_text("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{source} is not text in UTF-8 ({error}); a list of meshes has one path per line") from None
    if "\0" in text:
        raise ValueError(f"{source} is not text: it contains a null byte; a list of meshes has one path per line, in UTF-8")
    return text


def lies_below(name: Any) -> bool:
    """Is this the plain path of a file in a folder or in one of its subfolders?"""
    if not isinstance(name, str) or "\0" in name:
        return False
    path = pathlib.PurePath(name)
    return bool(path.name) and not path.is_absolute() and ".." not in path.parts and str(path) == name


def fingerprint(path: str, most: int) -> Fingerprint:
    """The fingerprint of a file; for a file larger than ``most`` bytes it is only the size."""
    with contextlib.suppress(OSError):
        if os.path.isfile(path):
            size = os.path.getsize(path)
            return size, hash_of(path) if size <= most else None
    return UNREADABLE


def fingerprints(paths: Sequence[str], most: int, progress: TextIO | None = None) -> Iterator[Fingerprint]:
    """The fingerprints of files, on all cores; for a file this takes about a hundredth of the time of its labels."""

    def computed() -> Iterator[Fingerprint]:
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for i in range(0, len(paths), SLICE):
                yield from pool.map(lambda path: fingerprint(path, most), paths[i : i + SLICE])

    return watched(computed(), progress, len(paths), "mesh files compared with the manifest")


def hash_of(path: Path) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
