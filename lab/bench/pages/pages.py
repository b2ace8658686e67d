#!/usr/bin/env python3
"""Fills the tables of pages in docs/ from lab/bench/results/: what lies between <!-- begin NAME --> and
<!-- end NAME --> is replaced, the prose around it stays. scripts/bench runs it."""

import argparse
import json
import pathlib
import re

from tables import Results, in_one_notation, label, number, per_set, percent, table

# ---- The pages, a function each: from the folder of results to the texts of the sections


SUMMARY = ("exact map", "distance map", "classified grid", "dense grid 0.63 MB", "OpenVDB 2R/200", "Embree", "CGAL")


def query_table(results, task, mesh, call, chosen=None):
    rows = [["system", "MB", "build, ms", "ns, U", "S", "C", "wrong, %, U", "S", "C", "farthest wrong, R"]]
    if task == "contacts":
        rows[0] += ["depth error on S, R: mean", "99 %", "worst"]
    for r in results.where(mesh=mesh, call=call, set="U"):
        if chosen and r["system"] not in chosen:
            continue
        one = dict(mesh=mesh, call=call, system=r["system"])
        near = results.where(set="S", **one)[0]
        farthest = max(float(s["farthest_wrong"]) for s in results.where(**one))
        rows.append([label(r), number(r["bytes"], 1e-6), number(r["build_ms"])]
                    + per_set(results, "ns", **one) + per_set(results, "wrong_share", percent, **one)
                    + ["none" if farthest == 0 else number(farthest)])
        if task == "contacts":
            rows[-1] += [number(near[c]) for c in ("depth_mean", "depth_99", "depth_worst")]
    return table(rows)


def particles_in(results, mesh, call):
    count = int(results.where(mesh=mesh, call=call)[0]["particles"]) if call == "whole set" else int(call)
    return f"{count:,}".replace(",", " ")


def query_tables(results, task):
    return "\n\n".join(
        f"`{mesh}`, {results.where(mesh=mesh)[0]['faces']} faces, {particles_in(results, mesh, call)} particles in a call:"
        + "\n\n" + query_table(results, task, mesh, call)
        for mesh in results.distinct("mesh") for call in results.distinct("call", mesh=mesh))


def queries(folder, task):
    results = Results(folder, task)
    mesh, call = results.records[0]["mesh"], results.records[0]["call"]
    return {task: query_tables(results, task), f"{task} machine": results.machine, f"{task} commit": results.commit,
            f"{task} summary": query_table(results, task, mesh, call, SUMMARY)}


def build(folder):
    results = Results(folder, "build")
    systems = results.distinct("system")
    rows = [["mesh", "faces"] + [f"{s}, ms" for s in systems]]
    for mesh in results.distinct("mesh"):
        for faces in results.distinct("faces", mesh=mesh):
            found = {r["system"]: number(r["ms"]) for r in results.where(mesh=mesh, faces=faces)}
            rows.append([mesh, faces] + [found.get(s, "") for s in systems])
    return {"build": table(rows), "build machine": results.machine, "build commit": results.commit}


def cloth(folder):
    results = Results(folder, "cloth")
    rows = [["collider", "particles", "MB", "ms per frame", "of it constraints, ms", "collision, ms", "frames to rest",
             "inside at the end", "deepest at the end, R", "deepest ever, R"]]
    for r in results.records:
        rest = r["frames"] if r["rested"] == "yes" else f"stopped at {r['frames']}"
        rows.append([f"{r['system']}: {r['setting']}", r["particles"], number(r["bytes"], 1e-6),
                     number(r["frame_ms"]), number(r["constraint_ms"]), number(r["collision_ms"]), rest,
                     r["inside_at_end"], number(r["deepest_at_end"]), number(r["deepest"])])
    return {"cloth": table(rows), "cloth machine": results.machine, "cloth commit": results.commit}


def strain(record):
    """Mean, 99 % and largest, in %."""
    return " / ".join(number(record[c], 100) for c in ("strain_mean", "strain_99", "strain_largest"))


def solvers(folder):
    results = Results(folder, "solvers")
    designs = ("newton", "eight steps", "converged", "jakobsen")
    moving = [["a sheet", "particles", "k, N/m"] + [f"strain of {d}, %" for d in designs] + [f"{d}, ms" for d in designs]]
    for problem in results.distinct("problem", state="moving"):
        for one in results.where(state="moving", problem=problem, design="newton"):
            keys = {c: one[c] for c in ("state", "problem", "side", "stiffness")}
            found = {r["design"]: r for r in results.where(**keys)}
            moving.append([problem, f"{one['side']} x {one['side']}", one["stiffness"]]
                          + [strain(found[d]) if d in found else "" for d in designs]
                          + [number(found[d]["frame_ms"]) if d in found else "" for d in designs])
    rest = [["a sheet", "a frame, s", "strain, %", "distance from positions with 1/60 s, mm", "fastest particle, mm/s"]]
    for r in results.where(state="at rest"):
        rest.append([r["problem"], f"1/{r['frames_per_second']}", strain(r), number(r["away"], 1000), number(r["speed"], 1000)])
    return {"solvers moving": table(moving), "solvers at rest": table(rest), "solvers machine": results.machine, "solvers commit": results.commit}


def mechanics(folder):
    results = Results(folder, "mechanics")
    motion = [["a frame of", *(f"1/{p} s" for p in ("60", "120", "240")), "in theory"]]
    for what in results.distinct("what", table="motion"):
        found = {r["frames_per_second"]: r for r in results.where(table="motion", what=what)}
        one = found["60"]
        if one["unit"] == "%":
            cells = {p: number(r["measured"]) for p, r in found.items()}
        else:  # of a time or a length what matters is how far it is from theory
            cells = {p: f"{100 * float(r['measured']) / float(one['expected']):.2f} %" for p, r in found.items()}
        expected = number(one["expected"]) + ("" if one["unit"] == "%" else f" {one['unit']}")
        motion.append([what + (", %" if one["unit"] == "%" else " relative to theory")] + [cells.get(p, "") for p in ("60", "120", "240")] + [expected])
    ratios = results.distinct("poisson_ratio", table="beams")
    beams = [["", "segments", "tetrahedra"] + [f"{r}: % of theory" for r in ratios] + ["ms per frame"]]
    for r in results.where(table="beams", poisson_ratio=ratios[0]):
        keys = {c: r[c] for c in ("table", "what", "segments")}
        found = {s["poisson_ratio"]: s for s in results.where(**keys)}
        beams.append([r["what"], r["segments"], r["tetrahedra"]]
                     + [number(float(s["measured"]) / float(s["expected"]), 100) for s in found.values()] + [number(r["frame_ms"])])
    return {"mechanics motion": table(motion), "mechanics beams": table(beams), "mechanics machine": results.machine,
            "mechanics commit": results.commit}


def triangles(folder):
    results = Results(folder, "triangles")
    rows = [["question", "system", "ms for all faces", "found"]]
    rows += [[r["question"], r["system"], number(r["ms"]), r["found"]] for r in results.records]
    return {"triangles": table(rows), "triangles machine": results.machine, "triangles commit": results.commit,
            "triangles faces": f"{results.records[0]['faces']} faces on a model of {results.records[0]['model_faces']}"}


def surfaces(folder):
    results = Results(folder, "surfaces")
    rows = [["scene, contact of", "particles", "pairs with the model", "own pairs", "frames judged, number judged by CGAL", "at rest in frame", "strain, %", "most ever, %",
             "truncated per frame", "most", "unresolved", "least gap"]]
    times = [["scene, contact of", "particles", "ms per frame, mean", "99 %", "worst", "ratio"]]
    for r in results.records:
        name = f"{r['scene']}: {r['method']}"
        rest = r["frames"] if r["rested"] == "yes" else f"not in {r['frames']}"
        judged = f"{r['judged_frames']}, {r['cgal_frames']}" + (f" ({r['judges_differ']})" if r["judges_differ"] != "0" else "")
        rows.append([name, r["particles"], r["model_pairs"], r["own_pairs"], judged, rest, strain(r), number(r["strain_ever"], 100),
                     number(r["truncated_mean"]), r["truncated_most"], r["unresolved"], number(r["gap_least"])])
        times.append([name, r["particles"]] + [number(r[c]) for c in ("frame_ms", "frame_ms_99", "frame_ms_worst", "ratio")])
    return {"surfaces": table(rows), "surfaces times": table(times), "surfaces machine": results.machine,
            "surfaces commit": results.commit}


def engines(folder):
    results = Results(folder, "engines")
    values = {"engines machine": results.machine, "engines commit": results.commit}
    for model in results.distinct("model"):
        values[f"engines {model}"] = "\n\n".join(
            f"{side} x {side} particles, {setup}:\n\n{engines_table(results.where(model=model, side=side, setup=setup))}"
            for side in sorted(results.distinct("side", model=model), key=int) for setup in results.distinct("setup", model=model, side=side))
    how = [["engine, setup", "version", "steps per frame", "settings"]]
    for name in results.distinct("engine"):
        for setup in results.distinct("setup", engine=name):
            done = results.where(engine=name, setup=setup, status="done")
            how += [[f"{name}, {setup}", r["version"], r["substeps"], r["settings"]] for r in done[:1]]
    values["engines settings"] = table(how).replace("| --: |", "| --- |")
    return values


def engines_table(records):
    """At the end, and in brackets in the worst frame judged; times of the first half second, and in brackets of all frames."""
    rows = [["engine", "inside", "deepest, R", "pairs with the model", "own pairs", "stretch, %", "lost", "rests from frame", "ms per frame, native",
             "wasm"]]
    for r in records:
        if r["status"] != "done":
            rows.append([r["engine"], r["status"]] + [""] * (len(rows[0]) - 2))
            continue
        times = [f"{number(r['contact_ms'])} ({number(r['frame_ms'])})" if r["contact_ms"] and r["platform"] == platform else ""
                 for platform in ("native", "wasm")]
        pairs = [f"{r[c]} ({r[f'{c}_worst']})" if r[c] else "" for c in ("inside", "model_pairs", "own_pairs")]
        deepest = f"{number(r['deepest'])} ({number(r['deepest_worst'])})" if r["deepest"] else ""
        rows.append([r["engine"], pairs[0], deepest, pairs[1], pairs[2], number(r["stretch"], 100), r["lost"], r["rest_frame"] or "not", *times])
    return table(rows)


def figures(folder):
    results = Results(folder, "figures")
    values = {"figures machine": results.machine, "figures commit": results.commit}
    for mesh in results.distinct("mesh"):
        ask = dict(mesh=mesh, task="contains")
        largest = results.distinct("call", **ask)[0]
        rows = [["system", "MB", "build, ms", "wrong side, %, U", "S", "C", "farthest wrong, R",
                 "depth error on S, R: mean", "worst"]]
        for r in results.where(call=largest, set="U", **ask):
            one = dict(mesh=mesh, call=largest, system=r["system"])
            farthest = max(float(s["farthest_wrong"]) for s in results.where(task="contains", **one))
            depth = results.where(task="contacts", set="S", **one)[0]
            rows.append([label(r), number(r["bytes"], 1e-6), number(r["build_ms"])]
                        + per_set(results, "wrong_share", percent, task="contains", **one)
                        + ["none" if farthest == 0 else number(farthest), number(depth["depth_mean"]),
                           number(depth["depth_worst"])])
        values[f"{mesh} sizes"] = table(rows)
        rows = [["particles in a call, system", "inside or outside, ns, U", "S", "C", "contact, ns, U", "S", "C"]]
        for call in results.distinct("call", **ask):
            for r in results.where(call=call, set="U", **ask):
                one = dict(mesh=mesh, call=call, system=r["system"])
                rows.append([f"{particles_in(results, mesh, call)}, {label(r)}"] + per_set(results, "ns", task="contains", **one)
                            + per_set(results, "ns", task="contacts", **one))
        values[f"{mesh} times"] = table(rows)
    rows = [["model, system", "particles", "MB", "ms per frame", "frames per second", "frames to rest", "inside at the end",
             "deepest ever, R"]]
    for r in results.where(task="cloth"):
        rest = r["frames"] if r["rested"] == "yes" else f"not within {r['frames']}"
        rows.append([f"{r['mesh']}, {r['system']}", r["particles"], number(r["bytes"], 1e-6), number(r["frame_ms"]),
                     number(1000 / float(r["frame_ms"])), rest, r["inside_at_end"], number(r["deepest"])])
    values["cloth"] = table(rows)
    values["readme"] = readme_table(results, "horse")
    return values


def calls(folder):
    results = Results(folder, "calls")
    values = {"calls machine": results.machine, "calls commit": results.commit}
    for mesh in results.distinct("mesh", kind="calls"):
        ask = dict(kind="calls", mesh=mesh)
        rows = [["particles in a call, system", "inside or outside, ns, U", "S", "C", "contact, ns, U", "S", "C", "signed distance, ns, U", "S", "C"]]
        for call in results.distinct("call", **ask):
            for r in results.where(call=call, set="U", task="contains", **ask):
                one = dict(call=call, system=r["system"], **ask)
                rows.append([f"{particles_in(results, mesh, call)}, {label(r)}"]
                            + [cell for task in ("contains", "contacts", "distances") for cell in per_set(results, "ns", task=task, **one)])
        values[f"calls {'torus' if mesh == 'torus' else 'horse'}"] = table(rows)
    times = {(r["task"], r["set"], r["call"], r["system"]): float(r["ns"])
             for r in results.where(kind="calls", mesh=results.distinct("mesh", kind="calls")[0])}
    rows = [["times as fast as Embree, calls of", "inside or outside, U", "S", "C", "contact, U", "S", "C", "signed distance, U", "S", "C"]]
    for call in results.distinct("call", kind="calls"):
        rows.append([particles_in(results, results.records[0]["mesh"], call) if call != "whole set" else "all"]
                    + [f"{times[t, s, call, 'Embree'] / times[t, s, call, 'exact map']:.1f}" for t in ("contains", "contacts", "distances")
                       for s in "USC"])
    values["calls ratios"] = table(rows)
    rows = [["faces, system", "one call a particle, ns, U", "S", "C", "calls of 1000, U", "S", "C", "one call, U", "S", "C"]]
    ask = dict(kind="faces", task="contacts")
    for faces in results.distinct("faces", **ask):
        for system in results.distinct("system", **ask):
            rows.append([f"{faces}, {system}"] + [cell for call in results.distinct("call", **ask)
                                                  for cell in per_set(results, "ns", faces=faces, system=system, call=call, **ask)])
    values["calls faces"] = table(rows)
    rows = [["set, system", "median, ns", "99.9 %, ns", "worst, ns", "worst undisturbed, ns"]]
    rows += [[f"{r['set']}, {label(r)}"] + [f"{float(r[c]):.0f}" for c in ("median", "p999", "worst", "worst_undisturbed")]
             for r in results.where(kind="latency")]
    values["calls latency"] = table(rows)
    return values


def readme_table(results, mesh):
    """In short: a question a row, a number a cell, near the surface unless the row says otherwise; the
    numbers of a row in one notation."""
    colliders = {"exact map": "exact map", "distance map": "distance map", "dense grid 0.63 MB 16 bit": "dense grid 16 bit",
                 "Embree": "Embree's tree"}

    def row(question, task, column, call="whole set", set="S", unit="", scale=1.0):
        found = {r["system"]: r[column] for r in results.where(mesh=mesh, task=task, call=call, set=set)}
        texts = [found.get(s, "") for s in colliders]
        cells = [percent(t) if t else "" for t in texts] if unit == " %" else in_one_notation(texts, scale)
        return [question] + [f"{cell}{unit}" if cell else "" for cell in cells]

    cloth = {r["system"]: r for r in results.where(mesh=mesh, task="cloth")}

    many = particles_in(results, mesh, "whole set")
    return table([
        ["", "exact map", "distance map", "dense grid, 16 bits", "Embree"],
        row("memory", "contains", "bytes", unit=" MB", scale=1e-6),
        row("build", "contains", "build_ms", unit=" ms"),
        row("on the wrong side", "contains", "wrong_share", unit=" %"),
        row("the farthest of them from the surface", "contains", "farthest_wrong", unit=" R"),
        row("error of the depth, mean", "contacts", "depth_mean", unit=" R"),
        row(f"inside or outside, calls of {many}", "contains", "ns", unit=" ns"),
        row("the same, anywhere in the bounding sphere", "contains", "ns", set="U", unit=" ns"),
        row(f"contacts, calls of {many}", "contacts", "ns", unit=" ns"),
        row("contacts, calls of 10 000", "contacts", "ns", "10000", unit=" ns"),
        row("contacts, calls of 1000", "contacts", "ns", "1000", unit=" ns"),
        row("contacts, one call per particle", "contacts", "ns", "1", unit=" ns"),
        ["cloth of 10 000 particles, per frame"] + [f"{number(cloth[s]['frame_ms'])} ms" for s in colliders.values()],
        ["particles of it inside at rest"] + [cloth[s]["inside_at_end"] for s in colliders.values()],
    ])


def reproduction(folder):
    results = Results(folder, "reproduction")
    sizes, wrong = [], []
    for mesh in results.distinct("mesh"):
        size_rows = [["pole", "entries per direction, mean", "most", "float32, flat: MB", "unorm16, flat: MB",
                      "12 + 4 bytes: MB", "12 + 4 bytes: MiB"]]
        wrong_rows = [["pole, correction", "U", "S", "S missed", "S invented", "C"]]
        for r in results.where(mesh=mesh):
            if r["correction"] == "none":
                arrays = float(r["bytes_dynamic_arrays"])
                size_rows.append([r["pole"], r["mean_entries"], r["max_entries"]]
                                 + [f"{float(r[c]) / 1e6:.3f}" for c in ("bytes_float", "bytes_16_bit")]
                                 + [f"{arrays / 1e6:.3f}", f"{arrays / 2**20:.3f}"])
            invented = float(r["wrong_S"]) - float(r["missed_S"])
            wrong_rows.append([f"{r['pole']}, {r['correction']}", f"{float(r['wrong_U']):.3f}"]
                              + [f"{v:.2f}" for v in (float(r["wrong_S"]), float(r["missed_S"]), invented,
                                                      float(r["wrong_C"]))])
        sizes.append(f"**{mesh}**\n\n{table(size_rows)}")
        wrong.append(f"**{mesh}**\n\n{table(wrong_rows)}")
    rows = [["scene", "particles", "constraints", "iterations", "queries per frame", "ns per query", "ms per frame",
             "frames per second", "frames to rest", "inside at rest", "deepest / R"]]
    for name in ("horse", "torus"):
        r = json.loads(pathlib.Path(f"out/reproduction/{name}/report.json").read_text())
        rows.append([name, r["particles"], r["constraints"], r["iterations"], round(r["queries_per_frame"]),
                     number(r["ns_per_query"]), number(r["ms_per_frame"]["total"]), number(r["frames_per_second"]),
                     r["frames_to_rest"] or "not reached", r["inside_at_rest"], number(r["deepest"]["in_radii"])])
    return {"sizes": "\n\n".join(sizes), "wrong sides": "\n\n".join(wrong), "rates": table(rows),
            "machine": results.machine}


def label_table(results, mesh):
    """A system a row; sides and distances on both sets beside each other."""
    rows = [["system", "MB", "build, ms", "sides, ns, U", "S", "wrong, %, U", "S", "signed distance, ns, U", "S", "wrong sign, %, U", "S",
             "error of the distance, R"]]
    for system in results.distinct("system", mesh=mesh):
        asked = {query: [next(iter(results.where(mesh=mesh, system=system, task=query, set=s)), {}) for s in "US"]
                 for query in ("contains", "signed_distance")}
        first = next(r for found in asked.values() for r in found if r)
        row = [label(first), number(first["bytes"], 1e-6), number(first["build_ms"])]
        for found in asked.values():
            row += [number(r.get("ns")) for r in found] + [percent(r["wrong_share"]) if r else "" for r in found]
        distances = [float(r["distance_error"]) for r in asked["signed_distance"] if r]
        rows.append(row + [number(max(distances)) if distances else ""])
    return table(rows)


def label_ratios(results):
    """How many times as long as the exact map others take, where they answer."""
    def ratio(mesh, our_name, query, system, points):
        found = results.where(mesh=mesh, task=query, system=system, set=points)
        ours = results.where(mesh=mesh, task=query, system=our_name, set=points)
        return number(float(found[0]["ns"]) / float(ours[0]["ns"])) if found else ""

    rivals = {"contains": ["VTK vtkSelectEnclosedPoints", "Embree"], "signed_distance": ["VTK vtkImplicitPolyDataDistance", "Embree"]}
    rows = [["mesh", "sides: VTK, U", "S", "Embree, U", "S", "signed distance: VTK, U", "S", "Embree, U", "S"]]
    for mesh in results.distinct("mesh", task="contains"):
        for ours in results.distinct("system", mesh=mesh, role="ours"):
            rows.append([ours.replace("exact map", mesh)]
                        + [ratio(mesh, ours, query, system, s) for query, systems in rivals.items() for system in systems for s in "US"])
    return table(rows)


def label_corpus(results):
    rows = [["labels", "system", "meshes", "points", "points a second", "times VTK's", "labels that differ, %"]]
    for form, name in (("occupancy", "sides"), ("deepsdf", "signed distances")):
        found = results.where(task="corpus", kind=form)
        for r in found:
            ratio = float(found[-1]["ns"]) / float(r["ns"])
            rows.append([name, label(r), r["mesh"], r["points"], f"{1e9 / float(r['ns']):,.0f}".replace(",", " "), number(ratio),
                         percent(r["wrong_share"]) if r["wrong_share"] else ""])
    return table(rows)


def label_python(results):
    rows = [["query", "points in a call", "C++, ns per point", "Python with `out=`, %", "Python, %"]]
    for query in results.distinct("kind", task="python"):
        for call in results.distinct("call", task="python"):
            cpp, kept, new = (float(results.where(task="python", kind=query, call=call, system=s)[0]["ns"]) for s in ("C++", "Python, out=", "Python"))
            rows.append([f"`{query}`", call, number(cpp), f"{100 * (kept / cpp - 1):+.1f}", f"{100 * (new / cpp - 1):+.1f}"])
    return table(rows)


def labels(folder):
    results = Results(folder, "labels")
    tables = []
    for mesh in results.distinct("mesh", task="contains"):
        r = results.where(mesh=mesh)[-1]
        tables.append(f"**{mesh}** ({r['kind']}), {r['faces']} faces:\n\n{label_table(results, mesh)}")
    return {"labels": "\n\n".join(tables), "labels ratios": label_ratios(results), "labels corpus": label_corpus(results),
            "labels python": label_python(results) if results.where(task="python") else "Not recorded yet.", "labels machine": results.machine, "labels commit": results.commit}


TASKS = {
    "contains": (["performance.md", "performance_tables.md"], lambda folder: queries(folder, "contains")),
    "contacts": (["performance.md", "performance_tables.md"], lambda folder: queries(folder, "contacts")),
    "build": (["performance_tables.md"], build),
    "cloth": (["cloth_on_each.md"], cloth),
    "triangles": (["performance_tables.md"], triangles),
    "surfaces": (["surfaces_measured.md"], surfaces),
    "solvers": (["solvers.md"], solvers),
    "mechanics": (["mechanics.md", "soft_bodies.md"], mechanics),
    "engines": (["engines.md"], engines),
    "calls": (["calls.md"], calls),
    "labels": (["labels_measured.md"], labels),
    "figures": (["figures.md"], figures),
    "reproduction": (["reproduction.md"], reproduction),
}


def filled(text, values):
    for section, value in values.items():
        begin, end = f"<!-- begin {section} -->", f"<!-- end {section} -->"
        pattern = re.escape(begin) + "(\n?).*?\n?" + re.escape(end)
        text = re.sub(pattern, lambda m: f"{begin}{m[1]}{value}{m[1]}{end}", text, flags=re.DOTALL)
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("task", choices=TASKS)
    parser.add_argument("--results", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True, help="folder for the pages")
    arguments = parser.parse_args()
    pages, sections = TASKS[arguments.task]
    values = sections(arguments.results)
    arguments.output.mkdir(parents=True, exist_ok=True)
    for page in pages:
        (arguments.output / page).write_text(filled((pathlib.Path("docs") / page).read_text(), values))
        print(f"See {arguments.output / page}")


main()
