"""One race: entrants tuned, then run in alternation until every one's actual error meets the target."""

import sys
import time
from dataclasses import dataclass

import numpy as np

import tuning
from errors import Outcome, deviations, outcome
from rooms import Room

# A race whose entrant misses the target is run again with a stronger setting, so often.
ROUNDS = 4
# Runs for the difference to the scalar model, outside of all timing.
DIFFERENCE_SEEDS = 5
# Seconds between two runs: the threads of who ran before go on looking for work for a while.
REST = 0.2
# malus' own check against the reference is run to this share of the target.
CHECKED_SHARE = 0.5


@dataclass(frozen=True)
class Race:
    room: Room
    target: float
    """RMS error over the sensors, as a share of S0."""
    peer: type
    threads: int

    @property
    def name(self):
        return f"{self.room.name}-{100 * self.target:g}%"


@dataclass(frozen=True)
class Entry:
    race: str
    room: str
    target: float
    threads: int
    entrant: str
    setting: str
    met: bool
    outcome: Outcome


@dataclass(frozen=True)
class Agreement:
    """malus against a reference, in standard errors of both together."""

    room: str
    points: int
    root_mean_square: float
    largest: float
    mean_difference: float
    """Of S0, as a share."""


def run(race, malus, seeds, trial_seeds):
    """The entries of a race, malus first, and the raw figures of every run."""
    reference = race.room.reference()
    entrants = [malus(race.room, race.threads), race.peer(race.room, race.threads)]
    try:
        queues = [_queue(entrant, reference, race, trial_seeds) for entrant in entrants]
        for _ in range(ROUNDS):
            settings = [queue[0].setting for queue in queues]
            runs = _alternated(entrants, settings, seeds)
            outcomes = [outcome(solutions, reference) for solutions in runs]
            missed = [found.rms > race.target for found in outcomes]
            if not any(missed):
                break
            for place, entrant in enumerate(entrants):
                if missed[place]:
                    _strengthen(queues[place], entrant, outcomes[place].rms, race.target)
        entries = [
            _entry(race, entrant, setting, solutions, reference)
            for entrant, setting, solutions in zip(entrants, settings, runs)
        ]
        return entries, _raw(race, entrants, runs, reference)
    finally:
        for entrant in entrants:
            entrant.close()


def agreement(race, malus):
    """How one accurate run of malus agrees with the room's reference."""
    reference = race.room.reference()
    entrant = malus(race.room, race.threads)
    asked = CHECKED_SHARE * race.target
    solution = entrant.solve(entrant.settings()[0].at(1 / asked**2), 1)
    apart = deviations(solution, reference)
    shares = solution.s0 / reference.values["s0"] - 1.0
    return Agreement(
        room=race.room.title,
        points=len(apart),
        root_mean_square=float(np.sqrt((apart**2).mean())),
        largest=float(np.abs(apart).max()),
        mean_difference=float(shares.mean()),
    )


def _queue(entrant, reference, race, seeds):
    print(f"{race.name}: {entrant.name}", file=sys.stderr, flush=True)
    queue = tuning.tuned(entrant, reference, race.target, seeds)
    if not queue:
        raise RuntimeError(f"{race.name}: no setting of {entrant.name} meets the target")
    return queue


def _alternated(entrants, settings, seeds):
    """The solutions of each entrant; who goes first changes from seed to seed."""
    runs = [[] for _ in entrants]
    for seed in range(1, seeds + 1):
        order = range(len(entrants)) if seed % 2 else reversed(range(len(entrants)))
        for place in order:
            time.sleep(REST)
            runs[place].append(entrants[place].solve(settings[place], seed))
    return runs


def _strengthen(queue, entrant, found, target):
    if queue[0].setting.effort is not None:
        queue[0] = tuning.Trial(tuning.stronger(entrant, queue[0], found, target), queue[0].outcome)
    elif len(queue) > 1:
        queue.pop(0)


def _entry(race, entrant, setting, solutions, reference):
    found = outcome(solutions, reference)
    if "ds0" in reference.values and solutions[0].s1 is not None and race.room.share != 0:
        seeds = range(1, min(DIFFERENCE_SEEDS, len(solutions)) + 1)
        paired = [entrant.solve(setting, seed, differences=True) for seed in seeds]
        found = found.with_difference(outcome(paired, reference).ds0)
    return Entry(
        race=race.name,
        room=race.room.title,
        target=race.target,
        threads=race.threads,
        entrant=entrant.name,
        setting=entrant.describe(setting),
        met=found.rms <= race.target,
        outcome=found,
    )


def _raw(race, entrants, runs, reference):
    rows = []
    for entrant, solutions in zip(entrants, runs):
        for seed, solution in enumerate(solutions, start=1):
            rms = outcome([solution], reference).rms
            row = (race.name, entrant.name, seed, solution.seconds, solution.cpu, solution.process, rms)
            rows.append(row)
    return rows
