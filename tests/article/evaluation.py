"""The article's evaluation, recomputed from the figures of its tables 8 to 11."""

from __future__ import annotations

import csv
import math
import pathlib
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

# Its parts load when they are used; statistics take a second, in every process that collects tests.
import scipy
from numpy.typing import NDArray

FIGURES = pathlib.Path(__file__).with_name("evaluation.csv")
TOOLS = {"python": "Python", "pydslrep": "PyDSLRep"}

Sample = NDArray[np.float64]


class Cohort(NamedTuple):
    """The subjects of one group with one tool in one environment, who fill half of a table."""

    table: int
    environment: int
    tool: str
    group: int


class Printed(NamedTuple):
    """What the article prints of an environment and a group."""

    score: float
    critical: float


MEAN_LINES = {
    Cohort(8, 1, "python", 1): 178.9,
    Cohort(8, 1, "python", 2): 164.1,
    Cohort(9, 1, "pydslrep", 1): 22.4,
    Cohort(9, 1, "pydslrep", 2): 22.4,
    Cohort(10, 2, "python", 1): 342.0,
    Cohort(10, 2, "python", 2): 303.5,
    Cohort(11, 2, "pydslrep", 1): 107.6,
    Cohort(11, 2, "pydslrep", 2): 110.6,
}
"""As printed."""

SCORES = {
    (1, 1): Printed(5.8155, 1.7341),
    (1, 2): Printed(1.3774, 1.7341),
    (2, 1): Printed(11.3369, 1.3304),
    (2, 2): Printed(9.5928, 8.4342e-09),
}
"""As printed, by environment and group: the scores of the times."""

LINES_SAVED, TIME_SAVED = 76.40, 45.22
"""Percent, as printed."""

DEGREES = 18
"""Of freedom: two groups of ten, less two."""


READINGS: dict[str, Callable[[int, int], float]] = {
    "as they are": lambda minutes, seconds: 60 * minutes + seconds,
    "at most 59 seconds": lambda minutes, seconds: 60 * minutes + min(seconds, 59),
    "seconds modulo 60": lambda minutes, seconds: 60 * minutes + seconds % 60,
    "without seconds": lambda minutes, _: 60 * minutes,
    "seconds as hundredths": lambda minutes, seconds: 60 * minutes + 0.6 * seconds,
}
"""How times such as 00:11:69 can be read, in seconds."""


class Subjects(NamedTuple):
    """Lines, times in seconds, and whether the remote host was reached."""

    lines: Sample
    seconds: Sample
    connected: Sample


def subjects(reading: str = "as they are") -> dict[Cohort, Subjects]:
    """The rows of the four tables, with times read in that way."""
    rows: dict[Cohort, list[tuple[float, float, float]]] = {}
    with FIGURES.open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            cohort = Cohort(
                int(row["table"]),
                int(row["environment"]),
                row["tool"],
                int(row["group"]),
            )
            _, minutes, seconds = map(int, row["time_as_printed"].split(":"))
            time = READINGS[reading](minutes, seconds)
            connected = row["remote_host"] == "yes"
            rows.setdefault(cohort, []).append((int(row["loc"]), time, connected))
    return {
        cohort: Subjects(*np.array(found, dtype=np.float64).T)
        for cohort, found in rows.items()
    }


def pairs(found: dict[Cohort, Subjects]) -> dict[tuple[int, int], list[Subjects]]:
    """Python's and PyDSLRep's subjects, by environment and group."""
    return {
        key: [
            next(
                those
                for cohort, those in found.items()
                if (cohort.environment, cohort.group, cohort.tool) == (*key, tool)
            )
            for tool in TOOLS
        ]
        for key in SCORES
    }


def score(first: Sample, second: Sample) -> float:
    """Equation 7: the difference of the means over the root of the summed variances per count, of populations."""
    spread = float(first.var() / len(first) + second.var() / len(second))
    return float(first.mean() - second.mean()) / math.sqrt(spread)


def saved(first: Sample, second: Sample) -> float:
    """By how many percent the second mean is smaller."""
    return 100.0 * (1.0 - float(second.mean()) / float(first.mean()))


def critical(level: float) -> float:
    """What a score exceeds by chance with that probability."""
    return float(scipy.stats.t.isf(level, DEGREES))


def chance(value: float) -> float:
    """How probable a score of at least that is by chance."""
    return float(scipy.stats.t.sf(value, DEGREES))


def means_table() -> str:
    """The means of tables 8 to 11."""
    lines = [
        "| table | environment | tool | group | mean lines | printed | standard deviation | mean time | reached the remote host |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for cohort, those in subjects().items():
        mean, printed = float(those.lines.mean()), MEAN_LINES[cohort]
        agrees = abs(mean - printed) < 0.05
        lines.append(
            f"| {cohort.table} | {cohort.environment} | {TOOLS[cohort.tool]} | {cohort.group} | {mean:.1f} "
            f"| {printed:.1f}{'' if agrees else ' (differs)'} | {those.lines.std():.1f} "
            f"| {clock(float(those.seconds.mean()))} | {100 * those.connected.mean():.0f} % |"
        )
    return "\n".join(lines)


def savings_table() -> str:
    """What PyDSLRep saves in each environment and group, and on average."""
    lines = ["| environment | group | lines saved | time saved |", "|---|---|---|---|"]
    all_lines, all_times = [], []
    for (environment, group), (python, pydslrep) in pairs(subjects()).items():
        all_lines.append(saved(python.lines, pydslrep.lines))
        all_times.append(saved(python.seconds, pydslrep.seconds))
        lines.append(
            f"| {environment} | {group} | {all_lines[-1]:.2f} % | {all_times[-1]:.2f} % |"
        )
    lines += [
        f"| mean of the four | | **{np.mean(all_lines):.2f} %** | **{np.mean(all_times):.2f} %** |",
        f"| printed | | {LINES_SAVED:.2f} % | {TIME_SAVED:.2f} % |",
    ]
    return "\n".join(lines)


def scores_table() -> str:
    """The t-tests of the times."""
    lines = [
        "| environment | group | t, printed | t, recomputed | critical value, printed | exceeded by chance (one-sided) | Welch's t | two-sided p of Welch's test |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for key, (python, pydslrep) in pairs(subjects()).items():
        printed = SCORES[key]
        again = score(python.seconds, pydslrep.seconds)
        welch = scipy.stats.ttest_ind(python.seconds, pydslrep.seconds, equal_var=False)
        lines.append(
            f"| {key[0]} | {key[1]} | {printed.score:.4f} | {again:.4f} | {printed.critical:.5g} "
            f"| {chance(again):.1e} | {float(welch.statistic):.2f} | {float(welch.pvalue):.1e} |"
        )
    return "\n".join(lines)


def readings_table() -> str:
    """The saved time and the scores by each reading of the times."""
    lines = [
        "| reading | time saved | t: 1, group 1 | 1, group 2 | 2, group 1 | 2, group 2 |",
        "|---|---|---|---|---|---|",
    ]
    for reading in READINGS:
        both = [
            (python.seconds, pydslrep.seconds)
            for python, pydslrep in pairs(subjects(reading)).values()
        ]
        mean = np.mean([saved(*times) for times in both])
        cells = " | ".join(f"{score(*times):.4f}" for times in both)
        lines.append(f"| {reading} | {mean:.2f} % | {cells} |")
    cells = " | ".join(f"{printed.score:.4f}" for printed in SCORES.values())
    lines.append(f"| printed | {TIME_SAVED:.2f} % | {cells} |")
    return "\n".join(lines)


def critical_table() -> str:
    """Where the printed critical values come from."""
    last = SCORES[2, 2]
    return "\n".join(
        [
            "| printed | what it is | computed |",
            "|---|---|---|",
            f"| 1.7341 | exceeded by chance in 5 of 100 cases | {critical(0.05):.4f} |",
            f"| 1.3304 | exceeded by chance in 10 of 100 cases | {critical(0.10):.4f} |",
            f"| {last.critical:.4e} | the probability of the printed t = {last.score} by chance | {chance(last.score):.4e} |",
        ]
    )


def clock(seconds: float) -> str:
    """Minutes and seconds."""
    return f"{int(seconds // 60)} min {seconds % 60:02.0f} s"
