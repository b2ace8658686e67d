"""The files of motions. Each run writes a new file, so that undo and blend files saved earlier keep their own.

Motions that no saved blend file plays are removed when another file is opened, which ends undo, or when Blender closes;
motions that the scene plays at that time are kept, for File > Recover > Last Session.
"""

import contextlib
import itertools
import os
import pathlib

import bpy

from . import Refusal

FOLDER = "echinus_cache"

#: Files that this session wrote and that no blend file saved by it plays.
_unsaved = set()


def place_of_motion(cloth, chosen):
    """The file for the next motion of a cloth: the one that the user has chosen, or one that does not exist yet.

    Raises
    ------
    Refusal
        The file cannot be written, or another cloth plays it.
    """
    if chosen:
        path = writable_place(chosen, "cache")
        _require_no_other_player(cloth, path)
        return path
    folder = _folder()
    require_writable(folder)
    name = bpy.path.clean_name(cloth.name)
    names = itertools.chain([name], (f"{name}_{number}" for number in itertools.count(2)))
    return next(path for each in names if not (path := folder / f"{each}.pc2").exists())


def _folder():
    """A folder for each blend file: next to it, or among the user's data if it has never been saved."""
    if not bpy.data.filepath:
        return pathlib.Path(bpy.utils.user_resource("DATAFILES", path=FOLDER))
    blend = pathlib.Path(bpy.data.filepath)
    return blend.parent / FOLDER / blend.stem


def remember(path):
    """Records that a run wrote a file of its own."""
    _unsaved.add(path.resolve())


def _played_by(thing):
    caches = (each for each in thing.modifiers if each.type == "MESH_CACHE" and each.filepath)
    return {pathlib.Path(bpy.path.abspath(each.filepath, library=thing.library)).resolve() for each in caches}


def _played():
    return set().union(*(_played_by(thing) for thing in bpy.data.objects))


def _require_no_other_player(cloth, path):
    for thing in bpy.data.objects:
        if thing != cloth and path.resolve() in _played_by(thing):
            raise Refusal(f"{path.name} has the motion of {thing.name}: name another cache for {cloth.name}")


@bpy.app.handlers.persistent
def _keep_what_is_played(_):
    _unsaved.difference_update(_played())


@bpy.app.handlers.persistent
def _forget_undo(_):
    _remove_what_is_not_played()


def _remove_what_is_not_played():
    removed = _unsaved - _played()
    _unsaved.difference_update(removed)
    for path in removed:
        with contextlib.suppress(OSError):  # a file that cannot be removed stays
            path.unlink()


def register():
    bpy.app.handlers.save_post.append(_keep_what_is_played)
    bpy.app.handlers.load_post.append(_forget_undo)


def unregister():
    """Blender also calls this when it closes."""
    bpy.app.handlers.save_post.remove(_keep_what_is_played)
    bpy.app.handlers.load_post.remove(_forget_undo)
    _remove_what_is_not_played()
    _unsaved.clear()


# Whether a file may be written where the user wants it.


def writable_place(text, what):
    """The path of a file that the user named.

    Raises
    ------
    Refusal
        The path is not complete, or something other than a file exists there, or the folder cannot be written.
    """
    path = pathlib.Path(bpy.path.abspath(text))
    if not path.is_absolute():
        remedy = "save the blend file first, or name" if text.startswith("//") else "name"
        raise Refusal(f'The {what} "{text}" has no folder: {remedy} a whole path')
    if path.exists() and not path.is_file():
        raise Refusal(f"{path} is not a file that may be replaced: name another {what}")
    require_writable(path.parent)
    return path


def require_writable(folder):
    """
    Raises
    ------
    Refusal
        The folder cannot be written, or it does not exist and cannot be created.
    """
    existing = next(each for each in (folder, *folder.parents) if each.exists())
    if not existing.is_dir():
        raise Refusal(f"{existing} is not a folder: remove it, or name another place")
    if not os.access(existing, os.W_OK):
        raise Refusal(f"{existing} cannot be written: name another place")
