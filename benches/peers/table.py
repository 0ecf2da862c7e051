"""Results as CSV and as one Markdown table."""

import csv
import os
import platform
import subprocess
from datetime import date
from importlib.metadata import version
from pathlib import Path

import environment

RAW = ("race", "entrant", "seed", "seconds", "cpu_seconds", "process_seconds", "rms")
ENTRIES = ("race", "target", "threads", "entrant", "setting", "met", "rms", "worst", "mean", "s1", "ds0")
TIMES = ("seconds", "seconds_q1", "seconds_q3", "cpu_seconds", "process_seconds")


def write(folder, entries, agreements, raw, seeds):
    """Writes `runs.csv`, `races.csv` and `races.md`; returns the Markdown."""
    folder.mkdir(parents=True, exist_ok=True)
    _csv(folder / "runs.csv", RAW, raw)
    rows = [_row(entry) for entry in entries]
    _csv(folder / "races.csv", ENTRIES + TIMES, rows)
    text = "\n".join([_machine(seeds), "", *_races(entries), "", *_settings(entries), "", *_agreements(agreements)])
    (folder / "races.md").write_text(text + "\n")
    return text


def _csv(file, header, rows):
    with open(file, "w", newline="") as lines:
        table = csv.writer(lines, lineterminator="\n")
        table.writerow(header)
        table.writerows(rows)


def _row(entry):
    found = entry.outcome
    errors = [found.rms, found.worst, found.mean, found.s1, found.ds0]
    times = [found.seconds, *found.quartiles, found.cpu, found.process]
    numbers = ["" if value is None else f"{value:.6g}" for value in errors + times]
    return [entry.race, entry.target, entry.threads, entry.entrant, entry.setting, entry.met, *numbers]


def _races(entries):
    titles = ["race", "target", "threads", "entrant", "RMS", "worst sensor", "mean", "S1", "ds0"]
    titles += ["solve, s (quartiles)", "CPU, s", "process, s", "times malus, wall", "CPU"]
    yield f"| {' | '.join(titles)} |"
    yield "|---" * len(titles) + "|"
    for entry in entries:
        found = entry.outcome
        rival = next(other for other in entries if other.race == entry.race and other.entrant == "malus")
        ratios = ["", ""]
        if entry is not rival:
            own = rival.outcome
            ratios = [f"{found.seconds / own.seconds:.3g}", f"{found.cpu / own.cpu:.3g}"]
        low, high = found.quartiles
        cells = [
            entry.room,
            _percent(entry.target),
            str(entry.threads),
            entry.entrant if entry.met else f"{entry.entrant} (missed)",
            _percent(found.rms),
            _percent(found.worst),
            f"{100 * found.mean:+.2g} %",
            _percent(found.s1),
            _percent(found.ds0),
            f"{found.seconds:.3g} ({low:.3g} to {high:.3g})",
            f"{found.cpu:.3g}",
            f"{found.process:.3g}",
            *ratios,
        ]
        yield f"| {' | '.join(cells)} |"


def _settings(entries):
    yield "| race | target | entrant | setting |"
    yield "|---|---|---|---|"
    for entry in entries:
        yield f"| {entry.room} | {_percent(entry.target)} | {entry.entrant} | `{entry.setting}` |"


def _agreements(agreements):
    yield "| malus against the reference | points | RMS deviation, standard errors | largest | mean difference of S0 |"
    yield "|---|---|---|---|---|"
    for found in agreements:
        yield (
            f"| {found.room} | {found.points} | {found.root_mean_square:.2f} | {found.largest:.2f} "
            f"| {100 * found.mean_difference:+.3f} % |"
        )


def _percent(share):
    return "" if share is None else f"{100 * share:.2g} %"


def _machine(seeds):
    """Date, machine, load and versions, in one line."""
    model = next(
        (
            line.split(":", 1)[1].strip()
            for line in Path("/proc/cpuinfo").read_text().splitlines()
            if line.startswith("model name")
        ),
        platform.machine(),
    )
    programs = ", ".join(f"{name} {version(name)}" for name in ("mitsuba", "pyradiance"))
    malus = subprocess.run([environment.MALUS, "--version"], capture_output=True, text=True)
    load = os.getloadavg()[2]
    return (
        f"{date.today()}, {model}, {os.cpu_count()} cores, load {load:.1f}; {malus.stdout.strip()}, "
        f"{programs}, {Path(environment.llvm()).name}; {seeds} seeds."
    )
