"""The mesh files of a corpus: their names, and what tells that one has changed."""

from __future__ import annotations

import contextlib
import hashlib
import os
import pathlib
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TextIO

from echinus._arguments import path_of
from echinus._meshes import Path
from echinus.corpus._progress import watched

EXTENSIONS = (".obj", ".ply", ".stl", ".off", ".gltf", ".glb", ".3ds")
Mesh = tuple[str, str]  # name, path
Fingerprint = tuple["int | None", "str | None"]  # bytes and SHA-256; None for what cannot be read


def find_meshes(sources: Sequence[Path]) -> list[Mesh]:
    """Name and path of each mesh file, by name.

    Parameters
    ----------
    sources
        Folders, with all below them; mesh files; and lists of such (``.txt``), one path a line, from the list's folder.

    Raises
    ------
    FileNotFoundError
        A source does not exist. What a list names may be missing: it is refused like a broken mesh.
    ValueError
        Two files have the same name, which is their path below the source without the extension; a path is empty, or
        a list no text in UTF-8.
    """
    found: dict[str, str] = {}
    for source in sources:
        if not path_of(source):
            raise ValueError("a path of meshes is empty; name folders, mesh files or lists of them")
        for name, path in _meshes_of(pathlib.Path(source)):
            name = name.replace(".", "_")
            if found.setdefault(name, str(path)) != str(path):
                raise ValueError(f"{found[name]} and {path} would both be labelled as {name}; rename one")
    return sorted(found.items())


def _meshes_of(source: pathlib.Path) -> Iterator[tuple[str, pathlib.Path]]:
    if source.suffix == ".txt":
        for number, line in enumerate(_text_of(source).splitlines(), 1):
            if line.strip():
                relative = pathlib.PurePath(line.strip())
                if not relative.name:
                    raise ValueError(f"{source}, line {number}: {line.strip()!r} is the path of no file")
                yield str(relative.relative_to(relative.anchor).with_suffix("")), source.parent / relative
    elif source.is_dir():
        for folder, _, files in os.walk(source):
            for file in files:
                path = pathlib.Path(folder, file)
                if path.suffix.lower() in EXTENSIONS:
                    yield str(path.relative_to(source).with_suffix("")), path
    elif source.exists():
        yield source.stem, source
    else:
        raise FileNotFoundError(f"there is no folder or file {source}")


def _text_of(source: pathlib.Path) -> str:
    try:
        text = source.read_text("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{source} is no text in UTF-8 ({error}); a list of meshes has a path a line") from None
    if "\0" in text:
        raise ValueError(f"{source} is no text, it has a null byte; a list of meshes has a path a line, in UTF-8")
    return text


def lies_below(name: Any) -> bool:
    """Is it the name of a file in a folder, or in one below it?"""
    if not isinstance(name, str) or "\0" in name:
        return False
    path = pathlib.PurePath(name)
    return bool(path.name) and not path.is_absolute() and ".." not in path.parts


def fingerprint(path: str, most: int) -> Fingerprint:
    """Of a file larger than ``most`` bytes only its size."""
    size = digest = None
    with contextlib.suppress(OSError):
        if os.path.isfile(path):
            size = os.path.getsize(path)
            digest = hash_of(path) if size <= most else None
    return size, digest


def fingerprints(paths: Sequence[str], most: int, progress: TextIO | None = None) -> list[Fingerprint]:
    """On all cores: for a file this takes about a hundredth of the time of its labels."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = pool.map(lambda path: fingerprint(path, most), paths)
        return list(watched(found, progress, len(paths), "mesh files compared with the manifest"))


def hash_of(path: Path) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
