"""The mesh files of a corpus, and their names."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Iterator, Sequence

from echinus._meshes import Path

EXTENSIONS = (".obj", ".ply", ".stl", ".off", ".gltf", ".glb", ".3ds")
Mesh = tuple[str, str]  # name, path


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
        if not os.fspath(source):
            raise ValueError("a path of meshes is empty; name folders, mesh files or lists of them")
        for name, path in _meshes_of(pathlib.Path(source)):
            name = name.replace(".", "_")
            if found.setdefault(name, str(path)) != str(path):
                raise ValueError(f"{found[name]} and {path} would both be labelled as {name}; rename one")
    return sorted(found.items())


def _meshes_of(source: pathlib.Path) -> Iterator[tuple[str, pathlib.Path]]:
    if source.suffix == ".txt":
        for line in _text_of(source).splitlines():
            if line.strip():
                path = source.parent / line.strip()
                relative = pathlib.PurePath(line.strip())
                yield str(relative.relative_to(relative.anchor).with_suffix("")), path
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
