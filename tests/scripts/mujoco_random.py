"""Random programs without contact, in the embedded simulator and in MuJoCo: how far apart robots end their actions.

    .venv/bin/python tests/scripts/mujoco_random.py             # 200 programs
    .venv/bin/python tests/scripts/mujoco_random.py --count 20

Prints programs of which an action ends further apart than the aim, or that take longer, and how many there are.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import pathlib
import random
import sys
import tempfile
from typing import NamedTuple

ROOT = pathlib.Path(__file__).parents[2]
sys.path += [str(ROOT / "tests" / part) for part in ("scripts", "support")]

from program_runs import Row, command_line, lines  # noqa: E402
from test_random_paths import check, program  # noqa: E402

DEBUG = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug"
COMMAND = os.environ.get("PYDSLREP", str(DEBUG / "pydslrep"))

POSITION, HEADING, LATE = 0.02, 1.5, 0.05  # m, degrees and a share of the time


class Difference(NamedTuple):
    """Between two runs of a program."""

    seed: int
    actions: int
    metres: float = 0.0
    degrees: float = 0.0
    late: float = 0.0
    """The share by which MuJoCo takes longer."""
    failure: str = ""

    @property
    def is_within_aim(self) -> bool:
        """Whether the engines agree."""
        return (
            not self.failure
            and self.metres <= POSITION
            and self.degrees <= HEADING
            and abs(self.late) <= LATE
        )

    def __str__(self) -> str:
        if self.failure:
            return f"{self.seed}: {self.failure}"
        return (
            f"{self.seed}: {self.actions} actions, {1000 * self.metres:.1f} mm, {self.degrees:.2f} deg, "
            f"{100 * self.late:+.1f} % of the time"
        )


def drive(folder: pathlib.Path, engine: str) -> list[Row]:
    """The events of a run."""
    options = ["--engine", engine, "--python", sys.executable]
    done = command_line(
        COMMAND,
        folder,
        *("run", "program.pyr", "--no-progress", "--events", "-", *options),
    )
    return lines(done.stdout)


def compare(seed: int) -> Difference:
    """Drives the program of a seed."""
    dice = random.Random(seed)
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        text, scene = program(dice)
        # A robot cannot run two movements in parallel.
        while "parallel-conflict" in check(COMMAND, folder, text):
            text, scene = program(dice)
        (folder / "e.scene.toml").write_text(scene, encoding="utf-8")
        both = [drive(folder, engine) for engine in ("embedded", "mujoco")]
    ended: list[dict[tuple[str, int], Row]] = []
    for events in both:
        failures = [it["message"] for it in events if it["event"] == "failed"]
        if failures:
            return Difference(seed, 0, failure=json.dumps(failures))
        counts: dict[str, int] = {}
        found = {}
        for event in events:
            if event["event"] == "action-ended":
                count = counts[event["robot"]] = counts.get(event["robot"], 0) + 1
                found[event["robot"], count] = event
        ended.append(found)
    embedded, other = ended
    away = [
        math.dist(*((e["x"], e["y"]) for e in (embedded[k], other[k]))) for k in other
    ]
    turned = [
        abs(math.remainder(embedded[k]["theta"] - other[k]["theta"], math.tau))
        for k in other
    ]
    ends = [max(event["t"] for event in each.values()) for each in ended]
    return Difference(
        seed, len(other), max(away), math.degrees(max(turned)), ends[1] / ends[0] - 1.0
    )


def main() -> None:
    """Compares the engines."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    options = parser.parse_args()
    found = []
    for seed in range(options.first, options.first + options.count):
        found.append(compare(seed))
        if not found[-1].is_within_aim:
            print(found[-1], flush=True)
    good = [each for each in found if not each.failure]
    print(
        f"{sum(each.is_within_aim for each in found)} of {len(found)} programs within the aim; "
        f"{sum(each.actions for each in good)} actions, at most "
        f"{1000 * max(each.metres for each in good):.1f} mm and {max(each.degrees for each in good):.2f} deg apart, "
        f"{100 * min(each.late for each in good):+.1f} to {100 * max(each.late for each in good):+.1f} % of the time"
    )


if __name__ == "__main__":
    main()
