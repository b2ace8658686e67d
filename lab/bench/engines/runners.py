"""The runners of scripts/bench engines: one program for each engine and configuration, all called in the same way.

    COMMAND --model model.obj --cloth cloth.obj --setup recommended|matched --frames N --out DIR [--echinus]

A runner lets the cloth fall on the model and writes into DIR, which exists:
  cloth.pc2  the cloth's vertices in the order of cloth.obj, as Blender's PC2 (version 1, start 0, rate 1): N + 1 samples,
             the first is the start, then one for each displayed frame of 1/60 s
  run.json   {"engine": "Bullet", "version": "3.24", "configuration": "with Echinus", "platform": "native" | "wasm",
              "substeps": n, "settings": {"what": "as text", ...}, "frame_seconds": [N numbers]}
frame_seconds are processor seconds of the steps alone: no set-up, no writing, and what Echinus adds is in them.
Exit status: 0 done, 77 the engine is not installed (one sentence on stderr; the run is left out), else it failed.

The model is closed, has its bounding sphere's centre at the origin and its radius R = 1; y is up. The cloth is a square of
1.6 R with n x n particles, flat, 0.05 R above the model, at rest. Gravity is (0, -9.81, 0) R/s^2, the whole cloth weighs 1 and
is neither pinned nor blown at. Friction is 0.5 where the engine has one number for it. What the setups mean:
  recommended  what the engine's own documentation or demo of a cloth has, at whatever substeps that needs
  matched      one step of 1/60 s a frame, 10 iterations, thickness (margin, radius) 0.01 R
"""

import dataclasses
import pathlib
import shutil

ROOT = pathlib.Path(__file__).resolve().parents[3]
FOLDER = "lab/bench/engines"


@dataclasses.dataclass(frozen=True)
class Runner:
    name: str  # as tables have it
    command: tuple  # relative to the repository; the first word is a program
    setups: tuple = ("recommended", "matched")

    def missing(self):
        """Describes missing dependencies; the runner itself detects the rest (exit status 77)."""
        for word in self.command:
            if word.startswith(("build/", FOLDER)) and not (ROOT / word).exists():
                return f"{word} is not there"
        program = self.command[0]
        return None if "/" in program or shutil.which(program) else f"the program {program} is not installed"


def _native(name, *options):
    return Runner(name, ("build/bench/lab/bench/echinus_bench_engine", *options))


def _node(name, file, *options):
    return Runner(name, ("node", f"{FOLDER}/node/{file}", *options))


RUNNERS = (
    _native("Bullet", "--engine", "bullet"),
    _native("Bullet with Echinus", "--engine", "bullet", "--echinus"),
    _node("Jolt", "jolt.mjs"),
    _node("Jolt with Echinus", "jolt.mjs", "--echinus"),
    _node("Rapier", "rapier.mjs"),
    _node("Rapier with Echinus", "rapier.mjs", "--echinus"),
    _node("MuJoCo", "mujoco.mjs"),
    Runner("Blender", ("blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                       f"{FOLDER}/blender/cloth.py", "--")),
    _native("Echinus particles only", "--engine", "particles"),
    _native("Echinus", "--engine", "surfaces"),
    _node("Echinus particles only wasm", "echinus.mjs", "--particles"),
    _node("Echinus wasm", "echinus.mjs"),
)
