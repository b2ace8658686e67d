"""The programs of docs/python.md: the tests run them as they stand, and they draw the page's pictures.

    python3 tests/python/guide.py FOLDER    writes the pictures into the folder
"""

import os
import pathlib
import re
import shutil
import sys
import tempfile

import echinus as ech

ROOT = pathlib.Path(__file__).resolve().parents[2]
HORSE = ROOT / "models" / "horse.3ds"


def programs_of(document):
    return re.findall(r"^```python\n(.*?)^```", (ROOT / document).read_text(), re.MULTILINE | re.DOTALL)


def prepare(folder):
    """A folder as the documents suppose it: a horse, a scene, and its model."""
    horse, _ = ech.repair(ech.read_mesh(HORSE))
    ech.write_mesh(folder / "horse.obj", horse)
    shutil.copytree(ROOT / "scenes", folder / "scenes")
    (folder / "models").mkdir()
    shutil.copy(HORSE, folder / "models")


def run_guide():
    """One program after the other, as in one session."""
    os.environ.setdefault("MPLBACKEND", "agg")
    names = {}
    for program in programs_of("docs/python.md"):
        exec(program, names)


if __name__ == "__main__":
    images = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepare(folder)
        os.chdir(folder)
        run_guide()
        for picture in folder.glob("python_*.png"):
            shutil.copy(picture, images)
