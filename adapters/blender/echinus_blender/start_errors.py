"""What the library says of a start, in the words of the panel. No Blender is needed here."""

import re

#: Numbers of triangles and particles, which Blender does not show.
PLACES = re.compile(r"(: (face|particle|the edge) |; the first is particle ).*")


def in_words_of_the_panel(sentence, cloth_name):
    """Sentences that name the cloth, and the remedy where its start intersects something."""
    what, is_start, remedy = sentence.partition("; move the start until they are apart")
    if not is_start:
        return f"{cloth_name}: {sentence}"
    what = re.sub(r"( in \d+ pairs?)\b", r"\1 of faces", PLACES.sub("", what))
    what = what.replace("the deformable begins", f"{cloth_name} begins", 1)
    what = what.replace(" particles begin", f" vertices of {cloth_name} begin", 1)
    what = what.replace("untangle could not", '"Part the Start" could not', 1)
    is_itself = "switch self_collision off" in remedy
    ways = ['tick "Part the Start"'] if "set untangle" in remedy else []
    ways += ["move them apart"] + (['switch "Self Collision" off'] if is_itself else [])
    finder = "Check Mesh" if is_itself else "Check Collisions in the first frame"
    shown = "" if " begins touching " in what else f"{finder} shows where; "
    return f"{what}: {shown}{' or '.join(ways)}"
