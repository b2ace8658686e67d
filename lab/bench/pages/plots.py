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


def plot(curves, x_label, y_label, path):
    """curves: name -> (points, is ours)"""
    figure, axes = pyplot.subplots(figsize=(7, 4.2), layout="constrained")
    for number, (name, (points, ours)) in enumerate(curves.items()):
        style = "s--" if not ours else "o-" if number < COLOURS else "^-."
        axes.plot(*zip(*sorted(points)), style, label=name, markersize=4, linewidth=1.2)
    axes.set(xscale="log", yscale="log", xlabel=x_label, ylabel=y_label)
    axes.grid(True, which="major", alpha=0.3)
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)


def plot_sets(rows, x, x_label, path):
    """One diagram for each of U, S and C, in one picture with one scale of times."""
    figure, all_axes = pyplot.subplots(1, 3, figsize=(9, 3.4), layout="constrained", sharey=True)
    for name, axes in zip("USC", all_axes):
        for system, (points, ours) in curves_of([r for r in rows if r["set"] == name], x, nanoseconds).items():
            axes.plot(*zip(*sorted(points)), "o-" if ours else "s--", label=system, markersize=4, linewidth=1.2)
        axes.set(xscale="log", yscale="log", xlabel=x_label, title=name)
        axes.grid(True, which="major", alpha=0.3)
    all_axes[0].set_ylabel("ns a particle")
    all_axes[-1].legend(loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)


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
    ns, wrong, size = "ns a particle", "on the wrong side, %", "MB"
    if task in ("contains", "contacts"):
        first = [r for r in rows if r["mesh"] == rows[0]["mesh"] and r["set"] == "S" and r["call"] == rows[0]["call"]]
        plot(curves_of(first, wrong_percent, nanoseconds), wrong, ns, images / f"{task}_time_error.svg")
    elif task == "bytes":
        for question in ("contains", "contacts"):
            some = [r for r in rows if r["task"] == question]
            plot(curves_of(some, megabytes, nanoseconds), size, ns, images / f"{question}_time_bytes.svg")
        sides = [r for r in rows if r["task"] == "contains"]
        plot(curves_of(sides, megabytes, wrong_percent), size, wrong, images / "contains_error_bytes.svg")
        depths = [r for r in rows if r["task"] == "contacts"]
        plot(curves_of(depths, megabytes, depth_percent), size, "mean error of the depth, % of R",
             images / "contacts_error_bytes.svg")
    elif task == "build":
        tori = [r for r in rows if r["mesh"].startswith("torus")]
        plot(curves_of(tori, lambda r: float(r["faces"]), lambda r: float(r["ms"])), "faces", "ms",
             images / "build_faces.svg")
    elif task == "calls":
        for question in ("contains", "contacts", "distances"):
            some = [r for r in rows if r["kind"] == "calls" and r["mesh"] == rows[0]["mesh"] and r["task"] == question]
            plot_sets(some, call_size, "particles in a call", images / f"calls_{question}.svg")
        for call, name in (("1", "single"), ("1000", "1000")):
            some = [r for r in rows if r["kind"] == "faces" and r["task"] == "contacts" and r["call"] == call]
            plot_sets(some, lambda r: float(r["faces"]), "faces", images / f"calls_faces_{name}.svg")
    elif task == "surfaces":
        falls = [r for r in rows if r["scene"] == "horse the fall alone"]
        curves = {}
        for r in falls:
            curves.setdefault(r["method"], ([], True))[0].append((float(r["particles"]), float(r["frame_ms"])))
        plot(curves, "particles", "ms a frame", images / "surfaces_particles.svg")
    elif task == "engines":
        curves = {}
        for r in rows:
            if (r["model"], r["setup"], r["status"]) == ("horse", "recommended", "done") and r["contact_ms"]:
                point = (float(r["side"]) ** 2, float(r["contact_ms"]))
                curves.setdefault(r["engine"], ([], "Echinus" in r["engine"]))[0].append(point)
        plot(curves, "particles", "ms a frame", images / "engines_particles.svg")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("task", choices=["contains", "contacts", "calls", "bytes", "build", "surfaces", "engines"])
    parser.add_argument("--results", type=pathlib.Path, required=True)
    parser.add_argument("--images", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    arguments.images.mkdir(parents=True, exist_ok=True)
    draw(arguments.task, arguments.results, arguments.images)


main()
