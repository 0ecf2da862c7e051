"""Which setting of an entrant reaches a target at the least cost: its whole grid is tried, the best are refined."""

import math
import sys
from dataclasses import dataclass

from errors import Outcome, outcome
from solution import Setting, TooSlow

# Seeds of the trials, none of which is raced with.
FIRST_SEED = 1001
# Settings with a knob that are refined after the first look at all.
FINALISTS = 3
STEPS = 6
# Aimed at, so that the race's own seeds meet the target too.
AIM = 0.95
# A setting without a knob that takes so many times the best projected time is given up, but not within a second.
PATIENCE, SHORTEST = 2.0, 1.0
# The most that one step of the knob may change.
LEAP = 16.0
# An error that so many times the solve time or more leaves above this share of what it was does not come from chance: the
# setting is given up. (malus may do no more work where a little less error is asked for.)
TELLING, FLOOR = 2.0, 0.9


@dataclass(frozen=True)
class Trial:
    setting: Setting
    outcome: Outcome


def tuned(entrant, reference, target, seeds):
    """Trials that meet the target, the cheapest in CPU time first."""
    trials = []
    limit = None
    for setting in entrant.settings():
        trial = _try(entrant, setting, reference, seeds, None if setting.effort else limit)
        if trial is None:
            continue
        trials.append(trial)
        patience = max(SHORTEST, PATIENCE * trial.outcome.seconds * _shortfall(trial, target))
        limit = min(patience, limit or math.inf)
    with_knob = [trial for trial in trials if trial.setting.effort is not None]
    with_knob.sort(key=lambda trial: trial.outcome.cpu * _shortfall(trial, target))
    for trial in with_knob[:FINALISTS]:
        met = [trial.outcome.seconds for trial in trials if trial.outcome.rms <= target]
        limit = max(SHORTEST, PATIENCE * min(met)) if met else None
        trials += _refined(entrant, trial, reference, target, seeds, limit)
    met = [trial for trial in trials if trial.outcome.rms <= target]
    return sorted(met, key=lambda trial: trial.outcome.cpu)


def stronger(entrant, trial, found, target):
    """The setting after one whose race ended at the RMS error `found`."""
    return trial.setting.at(_moved(entrant, trial.setting.effort, found, target))


def _try(entrant, setting, reference, seeds, limit=None):
    solutions = []
    try:
        for seed in range(FIRST_SEED, FIRST_SEED + seeds):
            solutions.append(entrant.solve(setting, seed, limit=limit))
    except TooSlow:
        _log(f"{entrant.name}: {entrant.describe(setting)}: given up after {limit:.3g} s")
        return None
    trial = Trial(setting, outcome(solutions, reference))
    found = trial.outcome
    _log(
        f"{entrant.name}: {entrant.describe(setting)}: RMS {100 * found.rms:.3g} %, "
        f"{found.seconds:.3g} s, {found.cpu:.3g} CPU s"
    )
    return trial


def _log(line):
    print(f"  {line}", file=sys.stderr, flush=True)


def _shortfall(trial, target):
    """How many times the work it takes to the target: with a knob, the error falls with the square root of the work."""
    if trial.setting.effort is None:
        return 1.0 if trial.outcome.rms <= target else math.inf
    return (trial.outcome.rms / target) ** 2


def _refined(entrant, trial, reference, target, seeds, limit):
    trials = []
    for _ in range(STEPS):
        if AIM**2 * target <= trial.outcome.rms <= target:
            break
        effort = _moved(entrant, trial.setting.effort, trial.outcome.rms, target)
        if math.isclose(effort, trial.setting.effort, rel_tol=0.01):
            break
        before = trial.outcome
        trial = _try(entrant, trial.setting.at(effort), reference, seeds, limit)
        if trial is None:
            break
        trials.append(trial)
        telling = trial.outcome.seconds >= TELLING * before.seconds
        if telling and trial.outcome.rms > max(target, FLOOR * before.rms):
            break
    return trials


def _moved(entrant, effort, found, target):
    factor = (found / (AIM * target)) ** 2
    return max(entrant.least_effort, effort * min(LEAP, max(1 / LEAP, factor)))
