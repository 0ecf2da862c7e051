#!/usr/bin/env python3
"""How the cost of a run grows: tables of docs/performance.md.

    python3 benches/scaling.py                      all tables, with target/release/malus
    python3 benches/scaling.py threads depth        some of them
    python3 benches/scaling.py --malus PATH --runs 21

What is compared runs in alternation, each run by another seed where its length is chance; a time is the median of the
solve times that the program reports (trees built, files read). Needs nothing but Python and the program.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

ROOM = """
[material.wall]
rho = {rho}
a = {a}
[material.lamp]
rho = 0
exitance = 1
[[shape]]
kind = "rectangle"
origin = [0.45, 0.45, 0.99]
u = [0, 0.1, 0]
v = [0.1, 0, 0]
material = "lamp"
[[sensor]]
name = "floor"
grid = {{ origin = [0.05, 0.05, 0], u = [0.9, 0, 0], v = [0, 0.9, 0], counts = [{columns}, {rows}] }}
normal = [0, 0, 1]
[run]
compare = []
"""

BOX = """
[[shape]]
kind = "box"
min = [0, 0, 0]
max = [1, 1, 1]
inward = true
material = "wall"
"""

MESH = """
[[mesh]]
file = "{file}"
up = "z"
"""


def room(rho=0.5, a=0.6, counts=(3, 3), walls=BOX):
    return walls + ROOM.format(rho=rho, a=a, columns=counts[0], rows=counts[1])


def cube(parts):
    """The inside of the unit cube as OBJ, every face cut into parts × parts squares of two triangles."""
    lines = ["usemtl wall"]
    steps = [index / parts for index in range(parts + 1)]
    corner = 1
    for axis in range(3):
        for side in (0, 1):
            for second in steps:
                for first in steps:
                    point = [0.0, 0.0, 0.0]
                    point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3] = side, first, second
                    lines.append("v {:.9g} {:.9g} {:.9g}".format(*point))
            for row in range(parts):
                for column in range(parts):
                    a = corner + row * (parts + 1) + column
                    b, c, d = a + 1, a + parts + 2, a + parts + 1
                    # Normals inwards: along the axis on the near side, against it on the far side.
                    square = (a, b, c, d) if side == 0 else (a, d, c, b)
                    lines.append("f {} {} {}".format(square[0], square[1], square[2]))
                    lines.append("f {} {} {}".format(square[0], square[2], square[3]))
            corner += (parts + 1) ** 2
    return "\n".join(lines) + "\n"


class Bench:
    def __init__(self, malus, runs, folder):
        self.malus, self.runs, self.folder = malus, runs, Path(folder)

    def scene(self, name, text):
        path = self.folder / f"{name}.toml"
        path.write_text(text)
        return path

    def command(self, scene, words, out="out"):
        command = [self.malus, "run", str(scene), "-o", str(self.folder / out), "--quiet", "--no-pictures"]
        return command + [str(word) for word in words]

    def summary(self, scene, words):
        """One run; its summary."""
        subprocess.run(self.command(scene, words), check=True, stderr=subprocess.DEVNULL)
        return json.loads((self.folder / "out" / "summary.json").read_text())

    def compare(self, settings):
        """Median solve time of each (scene, words), in alternation, and the last summary of each."""
        seconds = [[] for _ in settings]
        last = [None] * len(settings)
        for seed in range(1, self.runs + 1):
            for index, (scene, words) in enumerate(settings):
                last[index] = self.summary(scene, [*words, "--seed", seed])
                seconds[index].append(last[index]["seconds"])
        return [statistics.median(times) for times in seconds], last

    def peak_megabytes(self, scene, words):
        """Peak resident memory of one run."""
        code = "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True, stderr=subprocess.DEVNULL); " \
               "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"
        told = subprocess.run([sys.executable, "-c", code, *self.command(scene, words)], check=True, capture_output=True)
        return int(told.stdout) / 1024


def table(title, columns, rows):
    print(f"\n### {title}\n")
    print("| " + " | ".join(columns) + " |")
    print("|" + "---|" * len(columns))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    sys.stdout.flush()


def sensors(bench):
    counts = [(3, 3), (10, 9), (30, 30), (100, 90)]
    scenes = [bench.scene(f"sensors-{a * b}", room(counts=(a, b))) for a, b in counts]
    words = ["--relative-error", 0.01]
    seconds, last = bench.compare([(scene, words) for scene in scenes])
    rows = []
    for (a, b), time_s, summary, scene in zip(counts, seconds, last, scenes):
        memory = bench.peak_megabytes(scene, words)
        rows.append([f"{a * b:,}", f"{summary['samples']:,}", f"{time_s:.3g}", f"{time_s / seconds[0]:.3g}",
                     f"{memory:.0f}"])
    table("Sensors, at the same worst error (1 % at every point)",
          ["sensor points", "samples", "s", "times that of 9", "peak MB"], rows)


def triangles(bench):
    parts = [9, 29, 91, 289]
    scenes = []
    for part in parts:
        (bench.folder / f"cube-{part}.obj").write_text(cube(part))
        scenes.append(bench.scene(f"cube-{part}", room(walls=MESH.format(file=f"cube-{part}.obj"))))
    words = ["--samples", 16384]
    seconds, last = bench.compare([(scene, words) for scene in scenes])
    rows = []
    for time_s, summary, scene in zip(seconds, last, scenes):
        memory = bench.peak_megabytes(scene, words)
        rows.append([f"{summary['triangles']:,}", f"{time_s:.3g}", f"{time_s / seconds[0]:.3g}", f"{memory:.0f}"])
    table("Triangles, a subdivided cube, 16,384 samples at nine points",
          ["triangles", "s", "times that of the first", "peak MB"], rows)


def depth(bench):
    rhos = [0.2, 0.5, 0.8, 0.9, 0.95]
    scenes = [bench.scene(f"depth-{rho}", room(rho=rho, a=0)) for rho in rhos]
    fixed, _ = bench.compare([(scene, ["--samples", 65536]) for scene in scenes])
    aimed, last = bench.compare([(scene, ["--relative-error", 0.005]) for scene in scenes])
    rows = [[f"{rho}", f"{1 / (1 - rho):.3g}", f"{a:.3g}", f"{a / fixed[0]:.3g}", f"{summary['samples']:,}", f"{b:.3g}"]
            for rho, a, b, summary in zip(rhos, fixed, aimed, last)]
    table("Depth, a diffuse cube, nine points",
          ["ρ", "1/(1 − ρ)", "s for 65,536 samples", "times that of the first", "samples to 0.5 %", "s to 0.5 %"], rows)


def threads(bench):
    """Two threads against two one-thread processes side by side, the same work in all."""
    rows = []
    for name, scene, samples in [
        ("unit room, a = 0.6, 9 points", bench.scene("threads", room()), 262144),
        ("office", ROOT / "scenes" / "office.toml", 4096),
        ("cube of 10⁶ triangles, 9 points", million(bench), 65536),
    ]:
        ones, twos, pairs = [], [], []
        fixed = ["--set", "run.compare=[]"]
        for seed in range(1, bench.runs + 1):
            words = [*fixed, "--seed", seed]
            twos.append(bench.summary(scene, [*words, "--threads", 2, "--samples", 2 * samples])["seconds"])
            half = [*words, "--threads", 1, "--samples", samples]
            ones.append(bench.summary(scene, half)["seconds"])
            side = [subprocess.Popen(bench.command(scene, half, f"side-{index}"), stderr=subprocess.DEVNULL)
                    for index in (0, 1)]
            if any(process.wait() for process in side):
                sys.exit("a run failed")
            both = [json.loads((bench.folder / f"side-{index}" / "summary.json").read_text())["seconds"]
                    for index in (0, 1)]
            pairs.append(max(both))
        two, one, pair = map(statistics.median, (twos, ones, pairs))
        rows.append([name, f"{one:.3g}", f"{pair:.3g}", f"{two:.3g}", f"{pair / two:.3f}", f"{2 * one / two:.2f}"])
    table("Threads", ["scene", "one thread, half the work, alone, s", "two such side by side, s",
                      "two threads, all the work, s", "two threads against two processes", "speed-up over one thread"],
          rows)


def million(bench):
    path = bench.folder / "cube-289.obj"
    if not path.exists():
        path.write_text(cube(289))
    return bench.scene("cube-289", room(walls=MESH.format(file="cube-289.obj")))


def representations(bench):
    rows = []
    names = ["intensity", "linear", "full"]
    for name, scene, samples in [
        ("unit room, a = 0.6, 9 points", bench.scene("representations", room()), 65536),
        ("unit room, a = 0, 9 points", bench.scene("diffuse", room(a=0)), 65536),
        ("office", ROOT / "scenes" / "office.toml", 1024),
    ]:
        words = ["--set", "run.compare=[]", "--samples", samples, "--representation"]
        seconds, _ = bench.compare([(scene, [*words, representation]) for representation in names])
        ratios = [f"{time_s / seconds[0]:.3f}" for time_s in seconds[1:]]
        rows.append([name, *(f"{time_s:.3g}" for time_s in seconds), *ratios])
    table("Representations, the same walks",
          ["scene", "intensity, s", "linear, s", "full, s", "linear : intensity", "full : intensity"], rows)


def large(bench):
    """The memory of a large room with many sensors."""
    million(bench)
    scene = bench.scene("large", room(counts=(100, 100), walls=MESH.format(file="cube-289.obj")))
    words = ["--samples", 64]
    rows = [[f"{bench.summary(scene, words)['triangles']:,}", "10,000", f"{bench.peak_megabytes(scene, words):.0f}"]]
    table("Memory", ["triangles", "sensor points", "peak MB"], rows)


TABLES = {f.__name__: f for f in (representations, sensors, triangles, depth, threads, large)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", metavar="TABLE", help=f"of {', '.join(TABLES)}; none: all")
    parser.add_argument("--malus", help="the program [default: target/release/malus, built first]")
    parser.add_argument("--runs", type=int, default=7, help="runs of each [default: 7]")
    options = parser.parse_args()
    unknown = [name for name in options.tables if name not in TABLES]
    if unknown:
        parser.error(f"no table is called {unknown[0]!r}; there are {', '.join(TABLES)}")
    malus = options.malus
    if malus is None:
        subprocess.run(["cargo", "build", "--release", "--locked"], cwd=ROOT, check=True)
        malus = str(ROOT / "target" / "release" / "malus")
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(str(Path(malus).resolve()), options.runs, folder)
        load = os.getloadavg()[0]
        print(f"{os.cpu_count()} cores, load {load:.1f} at the start, median of {options.runs} runs, {time.strftime('%Y-%m-%d')}")
        for name in options.tables or TABLES:
            TABLES[name](bench)


if __name__ == "__main__":
    main()
