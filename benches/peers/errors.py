"""Actual errors against a reference, and what repeated runs cost."""

import math
from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class Outcome:
    """What one setting did over all seeds. Errors are shares of S0; the reference's own variance is taken off."""

    rms: float
    worst: float
    """RMS over the seeds at the worst sensor."""
    mean: float
    """Signed error, over sensors and seeds."""
    s1: float | None
    ds0: float | None
    seconds: float
    """Medians over the seeds."""
    cpu: float
    process: float
    quartiles: tuple
    """Lower and upper quartile of `seconds`."""

    def with_difference(self, ds0):
        return replace(self, ds0=ds0)


def outcome(solutions, reference):
    s0 = reference.values["s0"]
    squares = _squares(solutions, reference, "s0")
    seconds = [solution.seconds for solution in solutions]
    return Outcome(
        rms=_root(squares.mean()),
        worst=_root(squares.max()),
        mean=float(np.mean([solution.s0 / s0 - 1.0 for solution in solutions])),
        s1=_rms(solutions, reference, "s1"),
        ds0=_rms(solutions, reference, "ds0"),
        seconds=float(np.median(seconds)),
        cpu=float(np.median([solution.cpu for solution in solutions])),
        process=float(np.median([solution.process for solution in solutions])),
        quartiles=tuple(np.quantile(seconds, (0.25, 0.75))),
    )


def deviations(solution, reference):
    """Deviations of S0 in standard errors, the reference's and the program's own together."""
    combined = np.hypot(solution.se_s0, reference.errors["s0"])
    return (solution.s0 - reference.values["s0"]) / combined


def _rms(solutions, reference, quantity):
    solved = all(getattr(solution, quantity) is not None for solution in solutions)
    if not solved or quantity not in reference.values:
        return None
    return _root(_squares(solutions, reference, quantity).mean())


def _squares(solutions, reference, quantity):
    """Mean square of the error at each sensor, as a share of S0."""
    found = np.array([getattr(solution, quantity) for solution in solutions])
    errors = (found - reference.values[quantity]) / reference.values["s0"]
    own = reference.errors[quantity] / reference.values["s0"]
    return (errors**2).mean(axis=0) - own**2


def _root(square):
    return math.sqrt(max(0.0, square))
