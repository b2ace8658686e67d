"""The error of the add-on itself. No Blender is needed here."""


class Refusal(Exception):
    """What the add-on cannot do with what it was given: one sentence for the user."""
