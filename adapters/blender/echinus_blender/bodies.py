"""The objects that a cloth collides with."""

from . import Refusal
from .meshes import hindrance, require_mesh

#: Types of objects that have a surface but are not meshes.
SURFACES = {"CURVE", "FONT", "META", "SURFACE"}


def bodies_of(context):
    """The bodies without duplicates, and the omitted members of *More Bodies* with reasons, as texts.

    Raises
    ------
    Refusal
        There is no body, or one has no faces.
    """
    settings = context.scene.echinus
    more = [each for each in settings.more_bodies.all_objects if each != settings.cloth] if settings.more_bodies else []
    left_out = {each: why for each in more if (why := _why_left_out(context, each))}
    meshes = [each for each in more if each.type == "MESH" and each not in left_out]
    chosen = ([settings.body] if settings.body and settings.body != settings.cloth else []) + meshes
    skipped = [f"{each.name} ({why})" for each, why in left_out.items() if each != settings.body]
    if not chosen:
        raise Refusal("Choose a mesh other than the cloth as the body" + said_of(skipped))
    for body in chosen:
        require_mesh(body, "body")
    return list(dict.fromkeys(chosen)), skipped


def said_of(skipped):
    """The end of a sentence that names what was skipped; empty if nothing was."""
    return f"; without {', '.join(skipped)}" if skipped else ""


def _why_left_out(context, thing):
    """The reason why an object is left out; empty for bodies and for objects without a surface, such as lamps."""
    if thing.type in SURFACES:
        return "not a mesh"
    if thing.type == "EMPTY" and thing.instance_type == "COLLECTION":
        return "an instance"
    found = hindrance(context, thing)
    return found[0] if found and thing.type == "MESH" else ""
