"""The tables of docs/labels_measured.md."""

from tables import Results, label, number, percent, table


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
    rows = [["query", "points in a call", "C++, ns a point", "Python with `out=`, %", "Python, %"]]
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
