"""Whether a file may be written where the user wants it."""

import os
import pathlib

import bpy

from .refusal import Refusal


def writable_place(text, what):
    """The path of a file that the user named.

    Raises
    ------
    Refusal
        It is not a whole path, or something else than a file is there, or the folder cannot be written.
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
        Neither is it a folder that can be written, nor can it be made.
    """
    existing = next(each for each in (folder, *folder.parents) if each.exists())
    if not existing.is_dir():
        raise Refusal(f"{existing} is not a folder: remove it, or name another place")
    if not os.access(existing, os.W_OK):
        raise Refusal(f"{existing} cannot be written: name another place")
