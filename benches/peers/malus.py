"""malus, untuned: estimator `auto` stopped by `--relative-error`, as a user would run it."""

import csv
import json
import math
import tempfile
from pathlib import Path

import numpy as np

import environment
from solution import Setting, Solution, timed


class Malus:
    """`malus run` on a room's scene file; its effort is one over the square of the relative error asked for."""

    name = "malus"
    least_effort = 4.0

    def __init__(self, room, threads):
        self.room, self.threads = room, threads
        self.points = room.reference().points

    def settings(self):
        return [Setting("auto", {}, 1 / 0.02**2)]

    def describe(self, setting):
        return f"--relative-error {self._asked(setting)}"

    def solve(self, setting, seed, differences=False, limit=None):
        compare = '["scalar"]' if differences else "[]"
        with tempfile.TemporaryDirectory() as folder:
            command = [environment.MALUS, "run", self.room.scene, "-o", folder]
            command += ["--quiet", "--no-pictures", "--threads", self.threads, "--seed", seed]
            command += ["--relative-error", self._asked(setting), "--set", f"run.compare={compare}"]
            for override in self.room.overrides:
                command += ["--set", override]
            process = timed(command, limit=limit)
            summary = json.loads((Path(folder) / "summary.json").read_text())
            values = self._values(Path(folder) / "sensors.csv")
        return Solution(
            s0=values["s0"],
            se_s0=values["se0"],
            s1=values["s1"],
            ds0=values["ds0"] if differences else None,
            seconds=summary["seconds"],
            cpu=process.cpu,
            process=process.seconds,
        )

    def close(self):
        pass

    def _asked(self, setting):
        return f"{1 / math.sqrt(setting.effort):.3g}"

    def _values(self, file):
        rows = _free_points(file, self.room.sensor)
        places = np.array([[float(row[f"{axis}_m"]) for axis in "xyz"] for row in rows])
        if places.shape != self.points.shape or not np.allclose(places, self.points, atol=1e-4):
            raise ValueError(f"{self.room.scene}: the free points are not those of the reference")
        columns = ("s0", "se0", "s1", "ds0")
        return {name: np.array([float(row[name] or "nan") for row in rows]) for name in columns}


def layout(room):
    """Points and normals of a room's sensor that are not inside furniture."""
    with tempfile.TemporaryDirectory() as folder:
        command = [environment.MALUS, "run", room.scene, "-o", folder, "--samples", 1]
        for override in room.overrides:
            command += ["--set", override]
        timed([*command, "--quiet", "--no-pictures"])
        rows = _free_points(Path(folder) / "sensors.csv", room.sensor)
    places = np.array([[float(row[f"{axis}_m"]) for axis in "xyz"] for row in rows])
    normals = np.array([[float(row[f"n{axis}"]) for axis in "xyz"] for row in rows])
    return places, normals


def _free_points(file, sensor):
    with open(file, newline="") as rows:
        return [
            row for row in csv.DictReader(rows) if row["sensor"] == sensor and row["status"] == "ok"
        ]
