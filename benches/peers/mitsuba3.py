"""Mitsuba 3, kept warm: `path` on `llvm_ad_mono_polarized`, over a published grid of ways to run it."""

import json
import os
import subprocess
import sys
import time

import numpy as np

import environment
import surfaces
from solution import Setting, Solution


class Mitsuba:
    """Effort is the number of walks from a sensor. One process a setting of the scene stays warm between solutions."""

    name = "Mitsuba 3"
    least_effort = 64.0

    def __init__(self, room, threads):
        self.room, self.threads = room, threads
        reference = room.reference()
        if room.mesh:
            exported = surfaces.of_scene(room)
        else:
            exported = surfaces.unit_room(room.share)
        self.stage = environment.WORK / f"{room.name}.json"
        environment.WORK.mkdir(parents=True, exist_ok=True)
        content = {"points": reference.points, "normals": reference.normals, "surfaces": exported}
        self.stage.write_text(json.dumps(content, default=np.ndarray.tolist))
        self.workers = {}
        self.cold = {}

    def settings(self):
        # Where nothing scatters there is nothing to share with.
        shares = (0.0,) if self.room.share == 1 else (0.0, 0.5)
        return [
            Setting(
                f"{start} start, {sampler}, rr_depth {roulette}, mirror share {mirror_share or 'by reflectance'}",
                {
                    "start": start,
                    "sampler": sampler,
                    "roulette": roulette,
                    "mirror_share": mirror_share,
                },
                1024,
            )
            for start in ("lamps", "cosine")
            for sampler in ("independent", "multijitter")
            for roulette in (2, 5)
            for mirror_share in shares
        ]

    def describe(self, setting):
        return f"{setting.label}, {round(setting.effort)} walks a sensor"

    def solve(self, setting, seed, differences=False, limit=None):
        polarised = self._ask(setting, seed, scalar=False)
        ds0 = None
        if differences:
            # The same walks in the scalar model: the difference is paired, as malus' is.
            ds0 = polarised["s0"] - self._ask(setting, seed, scalar=True)["s0"]
        return Solution(
            s0=polarised["s0"],
            s1=polarised["s1"],
            ds0=ds0,
            seconds=polarised["seconds"],
            cpu=polarised["cpu"],
            process=self.cold[self._key(setting, False)],
        )

    def close(self):
        for worker in self.workers.values():
            worker.stdin.close()
            worker.wait()
        self.workers = {}

    def _key(self, setting, scalar):
        return setting.options["mirror_share"], scalar

    def _ask(self, setting, seed, scalar):
        key = self._key(setting, scalar)
        if key not in self.workers:
            begun = time.perf_counter()
            self.workers[key] = self._start(*key)
            self._answer(key, setting, seed)
            self.cold[key] = time.perf_counter() - begun
        return self._answer(key, setting, seed)

    def _start(self, mirror_share, scalar):
        command = [sys.executable, environment.HERE / "mitsuba_worker.py", self.stage]
        command += [str(mirror_share), str(int(scalar)), str(self.threads)]
        library = {"DRJIT_LIBLLVM_PATH": environment.llvm()}
        return subprocess.Popen(
            [str(word) for word in command],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ | library,
        )

    def _answer(self, key, setting, seed):
        worker = self.workers[key]
        question = {"walks": round(setting.effort), "seed": seed}
        question |= {name: setting.options[name] for name in ("start", "sampler", "roulette")}
        worker.stdin.write(json.dumps(question) + "\n")
        worker.stdin.flush()
        line = worker.stdout.readline()
        if not line:
            raise RuntimeError(f"Mitsuba ended with status {worker.wait()}")
        answer = json.loads(line)
        return answer | {"s0": np.array(answer["s0"]), "s1": np.array(answer["s1"])}
