"""A corpus of a thousand generated meshes, labelled in every way that there is; the labels must be the same bytes.

    python3 tests/python/corpus_trial.py FOLDER [MESH_COUNT]    prints a line for each way, and the cost by mesh size

A tenth of the meshes is dirty (holes, faces twice, faces turned round, soups) and a fiftieth is broken. Too slow for a
test: docs/labels.md shows what it printed.
"""

import contextlib
import hashlib
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace

import numpy as np

import echinus as ech
from echinus import corpus

SAMPLING = corpus.Sampling(uniform=300, near=300, surface=100)


def deformed(mesh, random):
    """The mesh, stretched, turned by a shear, and with waves, so that no two are alike."""
    v = mesh.vertices.astype(float)
    v = v + 0.05 * np.sin(random.uniform(2, 8, 3) * v[:, [1, 2, 0]] + random.uniform(0, 6, 3))
    return ech.Mesh(v @ (np.diag(random.uniform(0.3, 3, 3)) + random.uniform(-0.3, 0.3, (3, 3))), mesh.faces)


def clean_mesh(random, finest=90):
    n = int(np.exp(random.uniform(np.log(6), np.log(finest))))
    kind = random.integers(3)
    shape = [ech.make_torus(1, random.uniform(0.1, 0.6), 2 * n, n), ech.make_sphere(1, 2 * n, n), ech.make_box((1, 1, 1), max(n // 3, 1))]
    return deformed(shape[kind], random)


def dirty_mesh(random):
    mesh = clean_mesh(random, finest=25)
    some = random.permutation(len(mesh.faces))[: max(len(mesh.faces) // 20, 1)]
    kind = random.integers(4)
    if kind == 0:
        return ech.Mesh(mesh.vertices, np.delete(mesh.faces, some, axis=0))
    if kind == 1:
        return ech.Mesh(mesh.vertices, np.concatenate([mesh.faces, mesh.faces[some]]))
    if kind == 2:
        faces = mesh.faces.copy()
        faces[some] = faces[some][:, ::-1]
        return ech.Mesh(mesh.vertices, faces)
    corners = mesh.vertices[mesh.faces].reshape(-1, 3) + random.normal(0, 0.003, (3 * len(mesh.faces), 3)).astype(np.float32)
    return ech.Mesh(corners[: 3 * 400], np.arange(min(len(corners), 3 * 400)).reshape(-1, 3))


def make_corpus(folder, count):
    for i in range(count):
        random = np.random.default_rng(i)
        path = folder / f"class_{i % 7}" / f"mesh_{i:05d}.{['ply', 'obj', 'off', 'stl'][i % 4]}"
        path.parent.mkdir(parents=True, exist_ok=True)
        ech.write_mesh(path, dirty_mesh(random) if i % 10 == 0 else clean_mesh(random))
        if i % 50 == 7:  # broken: cut short, or filled with noise
            content = bytearray(path.read_bytes())
            path.write_bytes(content[: len(content) // 2] if i % 100 == 7 else bytes(random.integers(0, 256, 500, np.uint8)))


def hash_of(output):
    total = hashlib.sha256()
    for path in sorted(p for p in output.rglob("*") if p.is_file() and "manifest" not in p.name):
        total.update(str(path.relative_to(output)).encode() + path.read_bytes())
    lines = {line for path in output.glob("manifest*.jsonl") for line in path.read_text().splitlines()[1:]}
    total.update("\n".join(sorted(lines)).encode())
    return total.hexdigest()[:16]


def killing(find_workers, count, done):
    """Kills workers at random times."""
    random = np.random.default_rng(1)
    killed = 0
    while killed < count and not done.wait(random.uniform(0.5, 2)):
        with contextlib.suppress(OSError):  # one may end by itself meanwhile
            workers = find_workers()
            if workers:
                os.kill(int(random.choice(workers)), signal.SIGKILL)
                killed += 1
    return killed


def processes_below(pid):
    children = [c for task in pathlib.Path(f"/proc/{pid}/task").glob("*/children") for c in task.read_text().split()]
    return [int(c) for child in children for c in (child, *processes_below(int(child)))]


def spawned_by(pid):
    """Worker processes below a process; of Dask's, the nannies that restart them are in the process itself."""
    found = []
    for p in processes_below(pid):
        try:
            if b"spawn_main" in pathlib.Path(f"/proc/{p}/cmdline").read_bytes():
                found.append(p)
        except OSError:
            pass
    return found


def with_kills(label, count):
    done, killed = threading.Event(), []
    killer = threading.Thread(target=lambda: killed.append(killing(lambda: spawned_by(os.getpid()), count, done)))
    killer.start()
    try:
        summary = label()
    finally:
        done.set()
        killer.join()
    return summary, killed[0]


def on_local_cluster(made, kills):
    import dask
    import distributed

    dask.config.set({"distributed.scheduler.allowed-failures": 100})
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster:
        return with_kills(lambda: corpus.label(made, scheduler=cluster.scheduler_address), kills)


def run_ways(meshes, folder, form):
    sampling = replace(SAMPLING, distances=form != "occupancy")

    def made(name, shard=(0, 1)):
        return corpus.Corpus(meshes, folder / f"{form}_{name}", form, sampling, archive_size=16, shard=shard)

    def report(name, summary, killed=0):
        complaints = corpus.verify(made(name))
        print(f"{form} {name}: {summary}; {killed} workers killed; hash {hash_of(folder / f'{form}_{name}')}; {len(complaints)} complaints", flush=True)

    report("one_process", corpus.label(made("one_process"), workers=1))
    report("two_processes", corpus.label(made("two_processes"), workers=2))
    report("two_processes_killed", *with_kills(lambda: corpus.label(made("two_processes_killed"), workers=2), 10))
    report("cluster_killed", *on_local_cluster(made("cluster_killed"), 10))
    for i in (1, 2, 0):
        summary = corpus.label(made("parts", (i, 3)), workers=2)
    report("parts", summary)


def cost_by_size():
    """Seconds and memory for a mesh with the default 100 000 samples, in a process of its own."""
    program = (
        "import sys, time, resource, echinus as ech; from echinus import corpus; n = int(sys.argv[1]);"
        "m = ech.make_torus(1, 0.4, 2 * n, n); t = time.process_time();"
        "corpus.sample(m, corpus.Sampling(distances=sys.argv[2] == 'distances'));"
        "print(len(m.faces), sys.argv[2], round(time.process_time() - t, 3), 's',"
        " resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024, 'MB')"
    )
    for n in (16, 50, 160, 500):
        for what in ("sides", "distances"):
            subprocess.run([sys.executable, "-c", program, str(n), what], check=True)


def main():
    folder = pathlib.Path(sys.argv[1])
    shutil.rmtree(folder, ignore_errors=True)
    make_corpus(folder / "meshes", int(sys.argv[2]) if len(sys.argv) > 2 else 1000)
    meshes = corpus.find_meshes([folder / "meshes"])
    print(f"{len(meshes)} meshes", flush=True)
    cost_by_size()
    began = time.monotonic()
    for form in ("occupancy", "webdataset"):
        run_ways(meshes, folder, form)
    print(f"{time.monotonic() - began:.0f} s; {resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024} MB in the largest worker")


if __name__ == "__main__":
    main()
