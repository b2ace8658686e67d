#!/usr/bin/env python3
"""Draws the plots of docs/performance_tables.md, docs/calls.md, docs/surfaces_measured.md and docs/engines.md from lab/bench/results/: time
against error, time and error against bytes, build time against faces, time against the size of calls, time of a frame against particles.
scripts/bench runs it."""

import argparse
import csv
import pathlib

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams.update({"svg.hashsalt": "echinus", "svg.fonttype": "none", "font.size": 9,
                            "axes.spines.top": False, "axes.spines.right": False})
import matplotlib.pyplot as pyplot  # noqa: E402: after the choice of the backend

COLOURS = 10  # then they come again
SMALLEST_ERROR = 1e-4  # per cent: an error of 0 is drawn at the edge


def records(folder, task):
    lines = (folder / f"{task}.csv").read_text().splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def plot(panels, path, columns=1, sharey=False, size=(7, 4.2)):
    """Diagrams in rows of so many, with one legend: a system looks alike in all of them.
    panels: of each the curves (name -> points, is ours), the labels of its axes and its title"""
    rows = len(panels) // columns
    figure, all_axes = pyplot.subplots(rows, columns, figsize=size, layout="constrained", sharey=sharey, squeeze=False)
    names = list(dict.fromkeys(name for curves, *_ in panels for name in curves))
    drawn = {}
    for axes, (curves, x_label, y_label, title) in zip(all_axes.flat, panels):
        for name, (points, ours) in curves.items():
            number = names.index(name)
            style = "s--" if not ours else "o-" if number < COLOURS else "^-."
            drawn[name], = axes.plot(*zip(*sorted(points)), style, color=f"C{number % COLOURS}", markersize=4, linewidth=1.2)
        axes.set(xscale="log", yscale="log", xlabel=x_label, ylabel=y_label, title=title)
        axes.grid(True, which="major", alpha=0.3)
    middle = all_axes[(rows - 1) // 2, -1]
    middle.legend([drawn[name] for name in names], names, loc="center left", bbox_to_anchor=(1, 0.5 if rows % 2 else 0), frameon=False)
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)


def sets(rows, x, x_label, title=""):
    """A diagram for each of U, S and C."""
    return [(curves_of([r for r in rows if r["set"] == name], x, nanoseconds), x_label, "ns per particle" if name == "U" else "",
             f"{title}{name}") for name in "USC"]


def call_size(r):
    return float(r["particles"] if r["call"] == "whole set" else r["call"])


def curves_of(rows, x, y):
    curves = {}
    for r in rows:
        curves.setdefault(r["system"], ([], r.get("role") == "ours"))[0].append((x(r), y(r)))
    return curves


def nanoseconds(r):
    return float(r["ns"])


def megabytes(r):
    return float(r["bytes"]) / 1e6


def wrong_percent(r):
    return max(100 * float(r["wrong_share"]), SMALLEST_ERROR)


def depth_percent(r):
    return max(100 * float(r["depth_mean"]), SMALLEST_ERROR)


def draw(task, folder, images):
    rows = records(folder, task)
    ns, wrong, size = "ns per particle", "on the wrong side, %", "MB"
    if task in ("contains", "contacts"):
        first = [r for r in rows if r["mesh"] == rows[0]["mesh"] and r["set"] == "S" and r["call"] == rows[0]["call"]]
        plot([(curves_of(first, wrong_percent, nanoseconds), wrong, ns, "")], images / f"{task}_time_error.svg")
    elif task == "bytes":
        panels = []
        for question, error, error_label in (("contains", wrong_percent, wrong), ("contacts", depth_percent, "mean error of the depth, % of R")):
            some = [r for r in rows if r["task"] == question]
            panels += [(curves_of(some, megabytes, nanoseconds), size, ns, question),
                       (curves_of(some, megabytes, error), size, error_label, question)]
        plot(panels, images / "bytes.svg", columns=2, size=(9, 7))
    elif task == "build":
        tori = [r for r in rows if r["mesh"].startswith("torus")]
        curves = curves_of(tori, lambda r: float(r["faces"]), lambda r: float(r["ms"]))
        plot([(curves, "faces", "ms", "")], images / "build_faces.svg")
    elif task == "calls":
        calls = [r for r in rows if r["kind"] == "calls" and r["mesh"] == rows[0]["mesh"]]
        of_tasks = {t: sets([r for r in calls if r["task"] == t], call_size, "particles in a call", f"{t}, ") for t in ("contains", "contacts", "distances")}
        plot(of_tasks["contacts"], images / "calls_contacts.svg", columns=3, sharey=True, size=(9, 3.4))
        plot(of_tasks["contains"] + of_tasks["distances"], images / "calls_others.svg", columns=3, sharey="row", size=(9, 6.4))
        faces = [r for r in rows if r["kind"] == "faces" and r["task"] == "contacts"]
        panels = [sets([r for r in faces if r["call"] == call], lambda r: float(r["faces"]), "faces", title)
                  for call, title in (("1000", "calls of 1000, "), ("1", "single calls, "))]
        plot(panels[0] + panels[1], images / "calls_faces.svg", columns=3, sharey="row", size=(9, 6.4))
    elif task == "surfaces":
        falls = [r for r in rows if r["scene"] == "horse the fall alone"]
        curves = {}
        for r in falls:
            curves.setdefault(r["method"], ([], True))[0].append((float(r["particles"]), float(r["frame_ms"])))
        plot([(curves, "particles", "ms per frame", "")], images / "surfaces_particles.svg")
    elif task == "engines":
        curves = {}
        for r in rows:
            if (r["model"], r["setup"], r["status"]) == ("horse", "recommended", "done") and r["contact_ms"]:
                point = (float(r["side"]) ** 2, float(r["contact_ms"]))
                curves.setdefault(r["engine"], ([], "Echinus" in r["engine"]))[0].append(point)
        plot([(curves, "particles", "ms per frame", "")], images / "engines_particles.svg")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("task", choices=["contains", "contacts", "calls", "bytes", "build", "surfaces", "engines"])
    parser.add_argument("--results", type=pathlib.Path, required=True)
    parser.add_argument("--images", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    arguments.images.mkdir(parents=True, exist_ok=True)
    draw(arguments.task, arguments.results, arguments.images)


main()
