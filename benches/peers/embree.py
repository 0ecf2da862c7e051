#!/usr/bin/env python3
"""Ray rates of malus against Embree on the same rays, in alternation.

    benches/peers/embree.py FILE [--malus PATH] [--rounds N] [--seconds T]

FILE is a scene or a mesh, as `malus bench-bvh` takes it. The script makes a virtual environment of its own with
embreex (Embree 4, single rays) from PyPI in target/peers/embree. PATH is that of the variable MALUS unless it is given.
Both programs trace pieces of 2048 rays on one thread; a round takes one after the other, and a rate is that of the
median, or of the fastest, of all repetitions of each piece.

Embree is called through a loop in compiled Python that allocates no memory a ray, in single precision, at the quality
that embreex chooses; malus decides in double precision.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HOME = ROOT / "target" / "peers" / "embree"
CHUNK = 2048
# Column of malus, file of the rays, Embree's query.
KINDS = [
    ("primary", "primary", "INTERSECT"),
    ("cosine", "cosine", "INTERSECT"),
    ("pairs", "pairs", "OCCLUDED"),
    ("sensors", "sensors", "OCCLUDED"),
    ("sensor-packets", "sensors", "OCCLUDED"),
]


def environment():
    """The Python of the virtual environment, made where it is not there yet."""
    python = HOME / "bin" / "python"
    if not (HOME / "complete").exists():
        venv.create(HOME, with_pip=True, clear=True)
        subprocess.run(
            [python, "-m", "pip", "install", "--quiet", "embreex==4.4.0.post1", "numpy"],
            check=True,
        )
        (HOME / "complete").touch()
    return python


def summary(pieces):
    """Rays, and the sums over all pieces of the medians and of the least of their times."""
    rays = sum(count for count, _ in pieces)
    median = sum(sorted(times)[len(times) // 2] for _, times in pieces)
    best = sum(min(times) for _, times in pieces)
    return rays / median / 1e6, rays / best / 1e6


def trace(folder, seconds):
    """Embree's times of each piece, as JSON on stdout; this runs in the virtual environment."""
    import numpy as np
    from embreex import rtcore_scene
    from embreex.mesh_construction import TriangleMesh

    def rows(name, kind, width):
        return np.fromfile(folder / name, dtype=kind).reshape(-1, width)

    vertices = rows("vertices.f64", "<f8", 3)
    # Embree is single precision: relative to the middle, as malus does it.
    centre = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    scene = rtcore_scene.EmbreeScene()
    started = time.perf_counter()
    faces = rows("triangles.u32", "<u4", 3).astype(np.int32)
    TriangleMesh(scene, (vertices - centre).astype(np.float32), faces)
    work = []
    for name, file, query in KINDS[:4]:
        first, second = np.split(rows(f"{file}.f64", "<f8", 6), 2, axis=1)
        origins = (first - centre).astype(np.float32)
        # A segment's direction reaches from end to end: Embree is asked for distances up to 1.
        ends = query == "OCCLUDED"
        along = (second - first if ends else second).astype(np.float32)
        for start in range(0, len(origins), CHUNK):
            part = slice(start, start + CHUNK)
            piece = (np.ascontiguousarray(origins[part]), np.ascontiguousarray(along[part]))
            work.append((name, query, ends, *piece, []))
    scene.run(work[0][3][:1], work[0][4][:1])
    built = time.perf_counter() - started
    until = time.perf_counter() + seconds
    while True:
        for _, query, ends, origins, along, times in work:
            # embreex writes distances back.
            dists = np.ones(len(origins), dtype=np.float32) if ends else None
            started = time.perf_counter()
            scene.run(origins, along, dists=dists, query=query)
            times.append(time.perf_counter() - started)
        if time.perf_counter() > until:
            break
    times = [(name, len(origins), times) for name, _, _, origins, _, times in work]
    json.dump({"build_seconds": built, "times": times}, sys.stdout)


def race(file, malus, rounds, seconds):
    python = environment()
    pieces, rates, answers = {}, {}, None
    with tempfile.TemporaryDirectory() as folder:
        measure = [malus, "bench-bvh", file, "--threads", "1", "--json", "--seconds", str(seconds)]
        for turn in range(rounds):
            print(f"round {turn + 1} of {rounds}", file=sys.stderr)
            run = subprocess.run([*measure, "--rays", folder], stdout=subprocess.PIPE, check=True)
            answers = json.loads(run.stdout)
            for tree in answers["trees"]:
                for rate in tree["rates"]:
                    key = (tree["layout"], rate["rays"])
                    rates.setdefault(key, []).append((rate["median"], rate["best"]))
            run = subprocess.run(
                [python, __file__, "--trace", folder, "--seconds", str(seconds)],
                stdout=subprocess.PIPE,
                check=True,
                env={**os.environ, "OMP_NUM_THREADS": "1"},
            )
            for place, (name, count, times) in enumerate(json.loads(run.stdout)["times"]):
                pieces.setdefault((name, place), (count, []))[1].extend(times)

    print(f"{file}: {answers['triangles']} triangles; {answers['cpu']}; one thread, {rounds} rounds")
    print("10⁶ rays a second by the median (by the fastest), and the share of Embree's by the median")
    print(f"{'rays':<16}{'Embree':>16}{'wide':>24}{'bvh2':>24}{'cwbvh':>24}")
    for kind, name, _ in KINDS:
        embree = summary([piece for (of, _), piece in pieces.items() if of == name])
        row = f"{kind:<16}{embree[0]:>8.2f} ({embree[1]:.2f})"
        for layout in ("wide", "bvh2", "cwbvh"):
            found = rates[layout, kind]
            median = sorted(rate[0] for rate in found)[len(found) // 2]
            best = max(rate[1] for rate in found)
            row += f"{median:>11.2f} ({best:.2f}) {median / embree[0]:>4.2f}×"
        print(row)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", nargs="?", help="a scene or a mesh")
    parser.add_argument("--malus", default=os.environ.get("MALUS", ROOT / "target" / "release" / "malus"))
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=4.0, help="of each program in each round")
    parser.add_argument("--trace", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.trace:
        trace(options.trace, options.seconds)
    elif options.file:
        race(options.file, options.malus, max(options.rounds, 1), options.seconds)
    else:
        parser.error("a scene or a mesh is needed")


if __name__ == "__main__":
    main()
