"""What every entrant gives back, and what it can be asked for."""

import resource
import subprocess
import time
from dataclasses import dataclass, field, replace

import numpy as np


@dataclass(frozen=True)
class Solution:
    """One answer: values at the sensors, and what they cost."""

    s0: np.ndarray
    seconds: float
    """Wall time of solving alone: files read, trees built, kernels compiled."""
    cpu: float
    """CPU seconds; of the whole process for malus, of solving alone for its peers."""
    process: float
    """Wall time of a whole process that does this and nothing else."""
    s1: np.ndarray | None = None
    ds0: np.ndarray | None = None
    """Difference to the scalar model, where it was asked for."""
    se_s0: np.ndarray | None = None
    """Standard errors of S0 that the program itself reports."""


@dataclass(frozen=True)
class Setting:
    """One point of an entrant's published grid.

    `effort` is proportional to the work asked for, so the error falls about with its square root; a setting without a
    knob has none.
    """

    label: str
    options: dict = field(default_factory=dict)
    effort: float | None = None

    def at(self, effort):
        return replace(self, effort=effort)


@dataclass(frozen=True)
class Process:
    """A finished program."""

    stdout: bytes
    seconds: float
    cpu: float


class TooSlow(Exception):
    """A run that was not worth its end."""


def timed(command, stdin=b"", limit=None):
    """Runs a program to its end.

    Raises RuntimeError with what it said where it fails, TooSlow after `limit` seconds.
    """
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begun = time.perf_counter()
    child = subprocess.Popen(
        [str(word) for word in command],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    try:
        stdout, stderr = child.communicate(stdin, limit)
    except subprocess.TimeoutExpired as expired:
        child.kill()
        child.communicate()
        raise TooSlow from expired
    seconds = time.perf_counter() - begun
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if child.returncode != 0:
        said = stderr.decode(errors="replace").strip()
        raise RuntimeError(f"{' '.join(map(str, command))}: status {child.returncode}: {said}")
    cpu = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return Process(stdout, seconds, cpu)
