#!/usr/bin/env python3.11
"""Races malus against Mitsuba 3 and Radiance to the same actual error. See README.md beside this file."""

import argparse
import sys
from pathlib import Path

import environment

SEEDS, TRIAL_SEEDS = 21, 7
QUICK_SEEDS, QUICK_TRIAL_SEEDS = 5, 3


def main():
    environment.enter()
    # What needs the virtual environment.
    import trial
    import table
    from malus import Malus

    races = {race.name: race for race in lineup()}
    arguments = parse(races)
    environment.build_malus()
    seeds = arguments.seeds or (QUICK_SEEDS if arguments.quick else SEEDS)
    trial_seeds = QUICK_TRIAL_SEEDS if arguments.quick else TRIAL_SEEDS
    entries, agreements, raw = [], [], []
    for name in arguments.races or races:
        race = races[name]
        agreements.append(trial.agreement(race, Malus))
        found, runs = trial.run(race, Malus, seeds, trial_seeds)
        entries += found
        raw += runs
        # After every race, so that nothing is lost to an interruption.
        text = table.write(arguments.output, entries, agreements, raw, seeds)
    print(text)


def lineup():
    """All races. Against rtrace, which is one process a thread, both run on one."""
    from mitsuba3 import Mitsuba
    from radiance import Radiance
    from rooms import REFERENCE_OFFICE, UNIT_ROOMS, blender_office
    from trial import Race

    return [
        Race(UNIT_ROOMS[0], 0.01, Radiance, 1),
        Race(UNIT_ROOMS[0], 0.001, Radiance, 1),
        Race(UNIT_ROOMS[0.6], 0.01, Mitsuba, 2),
        Race(UNIT_ROOMS[0.6], 0.001, Mitsuba, 2),
        Race(UNIT_ROOMS[1], 0.01, Mitsuba, 2),
        Race(UNIT_ROOMS[1], 0.001, Mitsuba, 2),
        Race(REFERENCE_OFFICE, 0.003, Radiance, 1),
        Race(blender_office(), 0.01, Mitsuba, 2),
    ]


def parse(races):
    parser = argparse.ArgumentParser(description=__doc__)
    # A percent sign means something else to argparse.
    names = ", ".join(races).replace("%", "%%")
    parser.add_argument("races", nargs="*", metavar="RACE", help=f"one of {names} (default: all)")
    parser.add_argument("--quick", action="store_true", help=f"{QUICK_SEEDS} seeds instead of {SEEDS}")
    parser.add_argument("--seeds", type=int, help="seeds raced with")
    parser.add_argument("--output", type=Path, default=environment.WORK / "results", help="folder of the tables")
    arguments = parser.parse_args()
    for name in arguments.races:
        if name not in races:
            parser.error(f"no race is called {name}; there are {', '.join(races)}")
    return arguments


if __name__ == "__main__":
    sys.exit(main())
