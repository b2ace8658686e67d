"""The task engines of scripts/bench, which sets it up: the same cloth on the same model in every engine that is there
(runners.py), judged from positions alone."""

import argparse
import csv
import dataclasses
import functools
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import time

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as pyplot  # noqa: E402: after the choice of the backend
import numpy as np  # noqa: E402

import echinus as ech  # noqa: E402
import judge  # noqa: E402
from runners import ROOT, RUNNERS  # noqa: E402

MISSING = 77  # exit status of a runner without its engine
FRAMES, SIZES, SETUPS = 300, (24, 50, 100), ("matched", "recommended")
LARGEST = 200  # for the plot of time against particles only: the horse, recommended
CONTACT_FRAMES = 30  # in which every cloth meets the model; what falls on costs nothing
PATIENCE = 600  # processor seconds; slower runs are stopped and recorded as that
WAIT = 4  # times as long, whatever the processor does
KEYS = ("model", "side", "setup", "engine")
COLUMNS = (*KEYS, "platform", "version", "substeps", "status", "frames", *judge.COLUMNS, "contact_ms", "frame_ms",
           "frame_ms_99", "settings")
PICTURED = (50, "recommended")
SHEET_COLUMNS = 4
BULLET_FRAME = 16  # of the picture in docs/bullet.md: its own cloth is halfway through


@dataclasses.dataclass(frozen=True)
class Run:
    model: str
    side: int
    setup: str
    runner: object

    @property
    def folder(self):
        return pathlib.Path(self.model, str(self.side), self.setup, self.runner.name.replace(" ", "_").replace(",", ""))

    @property
    def keys(self):
        return dict(zip(KEYS, (self.model, str(self.side), self.setup, self.runner.name)))


# ---- What falls on what


def unit_model(mesh):
    """The bounding sphere's centre at the origin, R = 1."""
    report = ech.inspect(mesh)
    return ech.Mesh((mesh.vertices - np.asarray(report.centre)) / report.radius, mesh.faces)


def models(debian_horse):
    """Name -> mesh, y up."""
    ring = ech.make_torus(1, 0.4, 60, 24)
    lying = ring.vertices[:, [1, 2, 0]]  # a rotation: z up to y up
    horse, _ = ech.repair(ech.read_mesh(debian_horse), drop_duplicate_faces=False, flip_inside_out=False)
    return {"horse": unit_model(horse), "torus": unit_model(ech.Mesh(lying, ring.faces))}


def sheet(model, side):
    """Level, 1.6 R wide, 0.05 R above the model; row by row along z, fronts up."""
    line = np.linspace(-0.8, 0.8, side)
    z, x = np.meshgrid(line, line, indexing="ij")
    height = model.vertices[:, 1].max() + 0.05
    vertices = np.stack([x, np.full_like(x, height), z], axis=-1).reshape(-1, 3)
    row, column = np.meshgrid(np.arange(side - 1), np.arange(side - 1), indexing="ij")
    a = (row * side + column).ravel()
    faces = np.stack([a, a + side, a + 1, a + 1, a + side, a + side + 1], axis=1).reshape(-1, 3)
    return ech.Mesh(vertices, faces)


# ---- One run


def call(run, options):
    """The runner's status: "done", "missing", or a sentence."""
    folder = options.work / run.folder
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    command = [*run.runner.command, "--model", options.work / run.model / "model.obj", "--cloth",
               options.work / run.model / f"cloth_{run.side}.obj", "--setup", run.setup, "--frames", str(options.frames),
               "--out", folder]
    limit = functools.partial(resource.setrlimit, resource.RLIMIT_CPU, (options.patience, options.patience))
    try:
        done = subprocess.run(command, cwd=ROOT, preexec_fn=limit, timeout=WAIT * options.patience, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True)
    except subprocess.TimeoutExpired:
        return f"stopped after {options.patience} s"
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return f"stopped after {options.patience} s"
    said = done.stderr.strip().splitlines()
    if done.returncode == MISSING:
        print(f"engines: {run.runner.name} is left out: {said[-1] if said else 'not installed'}", file=sys.stderr)
        return "missing"
    if done.returncode != 0:
        print(f"engines: {run.runner.name} failed on {run.folder}:\n{done.stderr}", file=sys.stderr)
        return "failed"
    return "done"


def write_recording(run, options):
    """Writes the files that `echinus render` and echinus-check read, besides the runner's cloth.pc2."""
    folder = options.work / run.folder
    shutil.copy(options.work / run.model / f"cloth_{run.side}.obj", folder / "cloth.obj")
    shutil.copy(options.work / run.model / "model.obj", folder / "collider.obj")
    pose = {"frame": 0, "translation": [0, 0, 0], "rotation": [1, 0, 0, 0]}
    report = {"collider": {"mesh": "collider.obj", "poses": [pose]}, "gravity": [0, -9.81, 0], "frames_to_rest": None}
    (folder / "report.json").write_text(json.dumps(report))


def record_of(run, options, model, status):
    if status != "done":
        return {**run.keys, "status": status}
    write_recording(run, options)
    folder = options.work / run.folder
    report = json.loads((folder / "run.json").read_text())
    cloth = ech.read_mesh(folder / "cloth.obj")
    samples = judge.read_samples(folder / "cloth.pc2", len(cloth.vertices))
    milliseconds = 1e3 * np.asarray(report["frame_seconds"])
    settings = "; ".join(f"{name}: {value}" for name, value in report["settings"].items())
    return {**run.keys, "platform": report["platform"], "version": report["version"], "substeps": report["substeps"], "status": status,
            "frames": len(milliseconds), **judge.judge(model, cloth.faces, samples),
            "contact_ms": float(np.mean(milliseconds[:CONTACT_FRAMES])), "frame_ms": float(np.mean(milliseconds)),
            "frame_ms_99": float(np.percentile(milliseconds, 99)), "settings": settings.replace(",", " ")}


# ---- All of them


def runs_of(options, names):
    wanted = [r for r in RUNNERS if not options.only or r.name in options.only]
    for runner in [r for r in wanted if r.missing()]:
        print(f"engines: {runner.name} is left out: {runner.missing()}", file=sys.stderr)
    there = [r for r in wanted if not r.missing()]
    for name in names:
        for side in options.sizes:
            for setup in options.setups:
                yield from (Run(name, side, setup, r) for r in there if setup in r.setups)
    if not options.short:
        yield from (Run("horse", LARGEST, "recommended", r) for r in there if "recommended" in r.setups)


def read_records(path):
    """Machines, commits, and records by their keys."""
    if not path.exists():
        return "", "", {}
    lines = path.read_text().splitlines()
    machines, commits = (line.removeprefix("# ") for line in lines if line.startswith("#"))
    records = csv.DictReader(line for line in lines if not line.startswith("#"))
    return machines, commits, {tuple(r[k] for k in KEYS): r for r in records}


def with_one_more(names, name):
    return names if name in names.split("; ") else "; ".join(filter(None, [names, name]))


def rounded(value):
    return f"{value:.4g}" if isinstance(value, float) else value


def write_records(path, records, machines, commits):
    """Whole or not at all, in the form of lab/bench/records.hpp; in the order of runners.py."""
    order = {r.name: i for i, r in enumerate(RUNNERS)}
    records = sorted(records, key=lambda r: (r["model"], int(r["side"]), r["setup"], order.get(r["engine"], len(order))))
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_suffix(".part")
    with unfinished.open("w", newline="") as file:
        file.write(f"# {machines}\n# {commits}\n")
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n", extrasaction="ignore")
        writer.writeheader()
        writer.writerows({key: rounded(value) for key, value in record.items()} for record in records)
    unfinished.replace(path)


def draw(options, names):
    """A sheet for each model: the cloth of each engine at the end, by the project's renderer."""
    side, setup = (options.sizes[-1], options.setups[0]) if options.short else PICTURED
    for name in names:
        pictures = {}
        for runner in RUNNERS:
            folder = options.work / Run(name, side, setup, runner).folder
            if (folder / "report.json").exists():
                pictures[runner.name] = folder / "end.png"
        for picture in pictures.values():
            if not picture.exists():
                render(options, picture)
        if pictures:
            write_sheet(options.images / f"engines_{name}.png", pictures)
    draw_bullet(options, side)


def render(options, picture, *more):
    subprocess.run([options.program, "render", "moment", picture.parent, "-o", picture, "--width", "420", "--height", "360", "--view",
                    "35,15", "--close-up", "0,0,0,1.05", "--samples", "48", *more], check=True)


def draw_bullet(options, side):
    """For docs/bullet.md: the same moment with Bullet's own shape and with a map."""
    captions = {"Bullet": "btBvhTriangleMeshShape", "Bullet with Echinus": "echinus::bullet::MapShape"}
    folders = {r.name: options.work / Run("torus", side, "matched", r).folder for r in RUNNERS if r.name in captions}
    if all((folder / "report.json").exists() for folder in folders.values()):
        for folder in folders.values():
            render(options, folder / "falling.png", "--frame", str(BULLET_FRAME))
        write_sheet(options.images / "bullet_torus.png", {captions[name]: folder / "falling.png" for name, folder in folders.items()})


def write_sheet(path, pictures):
    columns = min(len(pictures), SHEET_COLUMNS)
    rows = -(-len(pictures) // columns)
    figure, places = pyplot.subplots(rows, columns, figsize=(2.8 * columns, 2.7 * rows), layout="constrained", squeeze=False)
    for place in places.flat:
        place.set_axis_off()
    for place, (name, picture) in zip(places.flat, pictures.items()):
        place.imshow(pyplot.imread(picture))
        place.set_title(name, fontsize=9)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=120, metadata={"Software": None})
    pyplot.close(figure)


def options_of_command_line():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--debian-horse", type=pathlib.Path, required=True)
    parser.add_argument("--programs", type=pathlib.Path, required=True, help="the build's folder")
    parser.add_argument("--commit", required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the recordings")
    parser.add_argument("--images", type=pathlib.Path, required=True, help="folder for the sheets of pictures")
    parser.add_argument("--short", action="store_true", help="one small cloth, one second")
    parser.add_argument("--only", action="append", default=[], metavar="NAME", help="measures this engine; the others' records stay")
    parser.add_argument("--resume", action="store_true", help="goes on after the runs that are recorded")
    parser.add_argument("-o", dest="output", type=pathlib.Path, required=True)
    options = parser.parse_args()
    options.frames, options.sizes, options.setups, options.patience = FRAMES, SIZES, SETUPS, PATIENCE
    if options.short:
        options.frames, options.sizes, options.setups = 60, SIZES[:1], SETUPS[:1]
    options.work = options.work.resolve()
    options.program = options.programs.resolve() / "tools/echinus"
    machine = [options.programs.resolve() / "lab/bench/echinus_bench_engine", "--machine"]
    options.machine = subprocess.run(machine, check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
    return options


def main():
    options = options_of_command_line()
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})  # as for the other tasks, for this process and the runners
    judged = {}
    for name, mesh in models(options.debian_horse).items():
        (options.work / name).mkdir(parents=True, exist_ok=True)
        ech.write_mesh(options.work / name / "model.obj", mesh)
        mesh = ech.read_mesh(options.work / name / "model.obj")
        judged[name] = judge.Model(mesh)
        for side in (*options.sizes, LARGEST):
            ech.write_mesh(options.work / name / f"cloth_{side}.obj", sheet(mesh, side))
    keeps = options.only or options.resume
    machines, commits, records = read_records(options.output) if keeps else ("", "", {})
    machines, commits = with_one_more(machines, options.machine), with_one_more(commits, options.commit)
    missing, stopped = set(), {}
    for run in runs_of(options, judged):
        slow = stopped.get((run.runner.name, run.setup), 1 << 30)
        keys = tuple(run.keys.values())
        if run.runner.name in missing or (options.resume and keys in records):
            continue
        start = time.monotonic()
        # An engine that was too slow with fewer particles is too slow with more.
        status = call(run, options) if run.side <= slow else f"stopped after {options.patience} s"
        if status == "missing":
            missing.add(run.runner.name)
            continue
        if status.startswith("stopped"):
            stopped[run.runner.name, run.setup] = min(slow, run.side)
        record = record_of(run, options, judged[run.model], status)
        records[keys] = record
        write_records(options.output, records.values(), machines, commits)
        print(f"engines: {run.folder}: {status} in {time.monotonic() - start:.0f} s", file=sys.stderr)
    draw(options, judged)


main()
