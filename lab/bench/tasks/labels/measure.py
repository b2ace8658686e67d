"""The task labels of scripts/bench, which sets it up: sides and signed distances by all systems, a corpus by echinus.corpus
and by VTK, and what Python costs. Processor time of all threads, on one core."""

import argparse
import csv
import pathlib
import shutil
import sys

import numpy as np

import corpus_speed
import echinus as ech
import echinus_bench
import meshes
import systems

QUERIES = {"contains": bool, "signed_distance": np.float32}
COLUMNS = ("task", "mesh", "kind", "faces", "set", "points", "call", "system", "role", "ns", "spread", "bytes", "build_ms",
           "asked", "wrong_share", "farthest_wrong", "distance_error")


def rounded(value):
    return f"{value:.4g}" if isinstance(value, float) else value


def write(path, records, commit):
    """Whole or not at all, in the form of lab/bench/records.hpp."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_suffix(".part")
    with unfinished.open("w", newline="") as file:
        file.write(f"# {echinus_bench.describe_machine()}\n# {commit}\n")
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: rounded(value) for key, value in record.items()} for record in records)
    unfinished.replace(path)


def errors(query, asked, answers, inside, distance, radius):
    """Of the points that a system was asked about; the distance of wrong ones in radii."""
    answers, inside, distance = answers[asked], inside[asked], distance[asked]
    wrong = (answers if query == "contains" else answers < 0) != inside
    found = {"asked": int(asked.sum()), "wrong_share": float(wrong.mean()), "farthest_wrong": float(distance[wrong].max(initial=0)) / radius}
    if query == "signed_distance":
        found["distance_error"] = float(np.abs(np.abs(answers.astype(float)) - distance).max()) / radius
    return found


def takes_part(system, query):
    return hasattr(system, query) and not (query == "signed_distance" and system.name == "Embree parity")  # Embree's are there once


def race(query, points, contestants, options):
    """For each system: its pace, its answers, and which points it was asked about. Only ours are faster in large calls."""
    runs, racers = [], []
    for system in contestants:
        answers, asked = np.zeros(len(points), QUERIES[query]), np.zeros(len(points), bool)

        call = getattr(system, "call", options.judged)

        def run(begin, end, ask=getattr(system, query), answers=answers):
            ask(points[begin:end], answers[begin:end])

        if getattr(system, "slow", False):
            parts = echinus_bench.parts_for(run, options.judged, options.patience)
        else:
            parts = [(0, min(call, len(points)))]
        for begin, end in parts:
            asked[begin:end] = True
        runs.append((answers, asked))
        racers.append((run, parts))
    paces = echinus_bench.take_turns(racers, options.passes, options.enough)
    return [(pace, *run) for pace, run in zip(paces, runs)]


def measure_mesh(name, kind, mesh, options):
    contestants = systems.systems_on(mesh)
    radius = contestants[0].map.radius
    for set_name in "US":
        points = echinus_bench.point_set(mesh.vertices, mesh.faces, set_name, options.points)
        judged = points[: options.judged]
        truth = echinus_bench.judged(name.replace(" ", "_"), mesh.vertices, mesh.faces, set_name, judged, kind != "clean", options.truth)
        for query in QUERIES:
            able = [system for system in contestants if takes_part(system, query)]
            for system, ((ns, spread, _), answers, asked) in zip(able, race(query, points, able, options)):
                ns -= getattr(system, "call_ns", 0) / options.judged
                yield {"task": query, "mesh": name, "kind": kind, "faces": len(mesh.faces), "set": set_name, "call": getattr(system, "call", options.judged),
                       "system": system.name, "role": system.role, "ns": ns, "spread": spread, "bytes": system.byte_count,
                       "build_ms": system.build_ms, **errors(query, asked[: options.judged], answers[: options.judged], *truth, radius)}
        print(f"labels: {name}, {set_name}", file=sys.stderr)


def python_overhead(mesh, options):
    """The same calls from C++ and from Python, by turns; the fastest turn of each."""
    points = echinus_bench.point_set(mesh.vertices, mesh.faces, "U", options.python_points)
    native, exact = echinus_bench.NativeMap(mesh.vertices, mesh.faces), ech.ExactMap(mesh, threads=1)
    asks = {"contains": exact.contains, "contacts": exact.contacts, "signed_distance": exact.signed_distance}
    for call in (n for n in (1000, 10_000, 100_000, 1_000_000) if n <= len(points)):
        for query, ask in asks.items():
            kept = ask(points[:call])  # as a caller in C++ keeps an array

            def from_python(begin, end, out=kept, ask=ask, call=call):
                for first in range(begin, end, call):
                    ask(points[first : first + call], out=out)

            def without_out(begin, end, ask=ask, call=call):
                for first in range(begin, end, call):
                    ask(points[first : first + call])

            def from_cpp(begin, end, query=query, call=call):
                native.ask(query, points[begin:end], call)

            whole = [(0, max(call, 100_000) if call < len(points) else len(points))]
            paces = echinus_bench.take_turns([(run, whole) for run in (from_cpp, from_python, without_out)], options.python_passes, np.inf)
            for system, (_, spread, pass_ns) in zip(("C++", "Python, out=", "Python"), paces):
                yield {"task": "python", "set": "U", "points": whole[0][1], "call": call, "kind": query,
                       "system": system, "role": "ours", "ns": min(pass_ns), "spread": spread}
        print(f"labels: Python, calls of {call}", file=sys.stderr)


def measured(options):
    echinus_bench.pin_to_one_core()
    all_meshes = meshes.meshes(options.debian_horse, options.meshes)
    yield from python_overhead(all_meshes[0][2], options)
    folder = pathlib.Path("out/labels")
    shutil.rmtree(folder, ignore_errors=True)
    if systems.has_vtk:
        yield from corpus_speed.compare(folder, options)
    for name, kind, mesh in all_meshes:
        if not (options.short and len(mesh.faces) > 50_000):
            yield from measure_mesh(name, kind, mesh, options)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--debian-horse", required=True, help="horse.3ds of glmark2-data")
    parser.add_argument("--meshes", help="folder of further meshes")
    parser.add_argument("--truth", type=pathlib.Path, required=True, help="folder that keeps what the judge found")
    parser.add_argument("--commit", default="", help="that is measured, and when")
    parser.add_argument("--short", action="store_true", help="few points, few passes: to see that all works")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="CSV file")
    options = parser.parse_args()
    vars(options).update(
        dict(points=100_000, judged=10_000, passes=1, enough=0.3, patience=0.3, python_points=100_000, python_passes=3, corpus_meshes=8)
        if options.short
        else dict(points=1_000_000, judged=100_000, passes=3, enough=1, patience=1, python_points=1_000_000, python_passes=9, corpus_meshes=30)
    )
    write(options.output, list(measured(options)), options.commit)


main()
