"""Radiance: `rtrace -I`, with and without its ambient cache, over a published grid."""

import os
from pathlib import Path

import numpy as np

import environment
from solution import Setting, Solution, timed


class Radiance:
    """Effort is the number of ambient divisions where there is no cache; settings with a cache have no knob."""

    name = "rtrace"
    least_effort = 4.0

    def __init__(self, room, threads):
        import pyradiance

        home = Path(pyradiance.__file__).parent
        os.environ["RAYPATH"] = f".:{home / 'lib'}"
        os.environ["PATH"] = f"{home / 'bin'}:{os.environ['PATH']}"
        self.room, self.threads = room, threads
        reference = room.reference()
        self.sensors = np.hstack([reference.points, reference.normals])
        environment.WORK.mkdir(parents=True, exist_ok=True)
        self.octree = environment.WORK / f"{room.radiance.stem}.oct"
        self.octree.write_bytes(timed(["oconv", room.radiance]).stdout)

    def settings(self):
        """Direct light is sampled alike in all: finely where `-ds` says so, every lamp, no threshold."""
        grid = []
        for substructure in self.room.substructuring:
            for limit in LIMITS:
                line = f"-ds {substructure} -dj 0 -dt 0 -dc 1 -aa 0 -as 0 -ab 12 -lr -12"
                label = f"no cache, -ds {substructure}, -lw {limit} / -ad"
                grid.append(Setting(label, {"line": line, "limit": limit}, 256))
        finest = self.room.substructuring[-1]
        for accuracy in (0.3, 0.2, 0.1, 0.05):
            for divisions, super_samples in ((512, 0), (1024, 512), (4096, 1024)):
                for bounces in (5, 12):
                    line = f"-ds {finest} -dj 0 -dt 0 -dc 1 -aa {accuracy} -ar 256 -ad {divisions}"
                    line += f" -as {super_samples} -ab {bounces} -lr {bounces} -lw 1e-5"
                    label = f"cache -aa {accuracy} -ad {divisions} -as {super_samples} -ab {bounces}"
                    grid.append(Setting(label, {"line": line}))
        for label, line in PRESETS.items():
            grid.append(Setting(label, {"line": line}))
        return grid

    def describe(self, setting):
        return self._line(setting)

    def solve(self, setting, seed, differences=False, limit=None):
        """rtrace has no seed: the order of the points is shuffled, which moves every sequence it draws from."""
        order = np.random.default_rng(seed).permutation(len(self.sensors))
        lines = "".join(
            " ".join(f"{value:.9g}" for value in row) + "\n" for row in self.sensors[order]
        )
        command = ["rtrace", "-h", "-I", "-n", self.threads, *self._line(setting).split(), self.octree]
        loading = timed(command)
        process = timed(command, lines.encode(), limit)
        values = np.array([float(line.split()[0]) for line in process.stdout.decode().splitlines()])
        s0 = np.empty(len(order))
        s0[order] = values
        return Solution(
            s0=s0,
            seconds=max(0.0, process.seconds - loading.seconds),
            cpu=max(0.0, process.cpu - loading.cpu),
            process=process.seconds,
        )

    def close(self):
        pass

    def _line(self, setting):
        line = setting.options["line"]
        if setting.effort is not None:
            divisions = max(4, round(setting.effort))
            line += f" -ad {divisions} -lw {setting.options['limit'] / divisions:.3g}"
        return line


# Weight below which Russian roulette begins, times the divisions: it must fall as they grow, or noise stays.
LIMITS = (0.1, 0.8, 4)

# The three qualities that Honeybee, the usual front end, offers.
PRESETS = {
    "Honeybee low": "-ab 2 -ad 512 -as 128 -ar 16 -aa 0.25 -dj 0 -ds 0.5 -dt 0.5 -dc 0.25 -dr 0 -lr 4 -lw 0.05",
    "Honeybee medium": "-ab 3 -ad 2048 -as 2048 -ar 64 -aa 0.2 -dj 0.5 -ds 0.25 -dt 0.25 -dc 0.5 -dr 1 -lr 6 -lw 0.01",
    "Honeybee high": "-ab 6 -ad 4096 -as 4096 -ar 128 -aa 0.1 -dj 1 -ds 0.05 -dt 0.15 -dc 0.75 -dr 3 -lr 8 -lw 0.005",
}
