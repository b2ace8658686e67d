"""The command `python3 -m echinus label`."""

from __future__ import annotations

import argparse
import logging
import sys
from collections.abc import Sequence
from dataclasses import replace

from echinus._errors import Error
from echinus.corpus._corpus import Corpus
from echinus.corpus._engines import MalformedAddress
from echinus.corpus._progress import counted, may_succeed
from echinus.corpus._run import label
from echinus.corpus._samples import Frame, Sampling
from echinus.corpus._sources import Mesh, find_meshes
from echinus.corpus._verification import examine

DEFAULT = Sampling()
MOST = 2**32 - 1  # the largest number of workers, parts and the like
WRONG_OPTIONS = 2  # exit codes
ONLY_SURPLUS = 3  # the exit code of --verify if all labels are right, but there are surplus files


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("meshes", nargs="+", help="folders, mesh files, and lists of them (.txt, one path per line)")
    parser.add_argument("-o", "--output", required=True, help="folder of the labels")
    parser.add_argument("--format", choices=["occupancy", "deepsdf", "webdataset"], default="occupancy")
    parser.add_argument("--uniform", type=int, default=DEFAULT.uniform, help="points in the cube of the frame (%(default)s)")
    parser.add_argument("--near", type=int, default=DEFAULT.near, help="points near the surface (%(default)s)")
    parser.add_argument("--sigmas", type=_numbers, default=DEFAULT.sigmas, help="standard deviations of their offsets from the surface (0.01,0.05)")
    parser.add_argument("--surface", type=int, default=DEFAULT.surface, help="points on the surface, with normals (%(default)s)")
    parser.add_argument("--frame", choices=["cube", "sphere", "none"], help="default: cube; sphere for deepsdf")
    parser.add_argument("--padding", type=float, default=DEFAULT.padding, help="padding of the cube, as a share of its edge (%(default)s)")
    parser.add_argument("--float16", action="store_true", help="store points in 16 bits; labels are those of the rounded points")
    parser.add_argument("--no-repair", action="store_true", help="take meshes as they are")
    parser.add_argument("--close-holes", type=int, default=DEFAULT.close_holes, metavar="EDGES", help="fill holes with at most this number of edges, up to 256")
    parser.add_argument("--drop-inner-faces", action="store_true", help="drop faces that lie within the solid")
    parser.add_argument("--thicken", type=float, default=DEFAULT.thicken, metavar="SHARE", help="thicken open parts into solids; thickness as a share of the longest edge of the mesh's bounding box")
    parser.add_argument("--min-certain", type=float, default=DEFAULT.min_certain, help="refuse meshes with a smaller share of certain labels (%(default)s)")
    parser.add_argument("--max-faces", type=int, default=DEFAULT.max_faces, help="refuse larger meshes (%(default)s)")
    parser.add_argument("--time-limit", type=float, default=DEFAULT.time_limit, help="seconds for the labels of a mesh (%(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the random samples (0)")
    parser.add_argument("--archive-size", type=_count, default=64, help="meshes in each archive of webdataset (%(default)s)")
    parser.add_argument("--workers", type=_count, help="processes; default: one for each core")
    parser.add_argument("--memory", type=float, default=4, help="address space of a process, GiB (%(default)s)")
    parser.add_argument("--scheduler", help="address of a Dask scheduler, for instance tcp://host:8786")
    parser.add_argument("--shard", type=_shard, default=(0, 1), help="i/n: only the i-th of n parts, from 0")
    parser.add_argument("--verify", action="store_true", help="compute nothing; check that all labels exist and are unchanged (exit code 3: they are, but there are other files)")


def main(arguments: argparse.Namespace) -> int:
    try:
        sampling, memory = _sampling_of(arguments), _memory_of(arguments)
        # Without meshes, to find the other faults first: a missing mesh is not a fault of the options.
        corpus = Corpus([], arguments.output, arguments.format, sampling, archive_size=arguments.archive_size, shard=arguments.shard)
        if arguments.verify and corpus.shard != (0, 1):
            raise ValueError("--verify checks all parts together; leave out --shard")
    except ValueError as error:
        print(f"echinus label: {error}", file=sys.stderr)
        return WRONG_OPTIONS
    try:
        corpus = replace(corpus, meshes=_meshes_of(arguments))
        return _verify(corpus) if arguments.verify else _label(corpus, arguments, memory)
    except (Error, ValueError, OSError, RuntimeError, ModuleNotFoundError) as error:
        print(f"echinus label: {error}", file=sys.stderr)
        return WRONG_OPTIONS if isinstance(error, MalformedAddress) else 1
    except KeyboardInterrupt:
        print("\nechinus label: interrupted; the same command continues from here", file=sys.stderr)
        return 130


def _sampling_of(a: argparse.Namespace) -> Sampling:
    usual_frame: Frame = "sphere" if a.format == "deepsdf" else "cube"
    return Sampling(
        uniform=a.uniform,
        near=a.near,
        sigmas=a.sigmas,
        surface=a.surface,
        frame=a.frame or usual_frame,
        padding=a.padding,
        dtype="float16" if a.float16 else "float32",
        distances=a.format != "occupancy",
        repair=not a.no_repair,
        close_holes=a.close_holes,
        drop_inner_faces=a.drop_inner_faces,
        thicken=a.thicken,
        min_certain=a.min_certain,
        max_faces=a.max_faces,
        time_limit=a.time_limit,
        seed=a.seed,
    )


def _memory_of(a: argparse.Namespace) -> int:
    if not 1e-9 < a.memory < 1 << 33:
        raise ValueError(f"memory must be a positive number of GiB, not {a.memory:g}")
    return int(a.memory * (1 << 30))


def _meshes_of(a: argparse.Namespace) -> list[Mesh]:
    meshes = find_meshes(a.meshes)
    if not meshes:
        raise ValueError("there are no meshes in " + ", ".join(a.meshes))
    return meshes


def _label(corpus: Corpus, a: argparse.Namespace, memory: int) -> int:
    if a.scheduler is not None:
        logging.disable()  # Dask's log reports a lost connection by tracebacks, in addition to our sentence
    summary = label(corpus, workers=a.workers, scheduler=a.scheduler, memory=memory, progress=sys.stderr)
    if summary.already:
        print(f"{counted(summary.already)} done already", file=sys.stderr)
    if summary.labelled or summary.refused:
        print(summary, file=sys.stderr)
    if summary.again:
        print(f"{may_succeed(summary.again)}: the same command tries them again", file=sys.stderr)
    return 0


def _verify(corpus: Corpus) -> int:
    found = examine(corpus, sys.stderr)
    for sentence in found.sentences():
        print(sentence)
    if found.complaints:
        return 1
    print(found)
    return ONLY_SURPLUS if found.surplus else 0


def _numbers(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(number) for number in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be numbers with commas between them, not {text!r}") from None


def _count(text: str) -> int:
    if not (text.isdecimal() and 0 < int(text) <= MOST):
        raise argparse.ArgumentTypeError(f"must be a whole number from 1 to {MOST}, not {text!r}")
    return int(text)


def _shard(text: str) -> tuple[int, int]:
    i, _, n = text.partition("/")
    if not (i.isdecimal() and n.isdecimal() and int(i) < int(n) <= MOST):
        raise argparse.ArgumentTypeError(f"must be i/n, with i from 0 to n - 1, not {text!r}")
    return int(i), int(n)


def parse(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python3 -m echinus", description="Labels for learning (docs/labels.md).")
    commands = parser.add_subparsers(required=True, dest="command")
    add_arguments(commands.add_parser("label", help="label the points around each mesh of a corpus"))
    return parser.parse_args(arguments)
