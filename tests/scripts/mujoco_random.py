"""Random programs without contact, in the embedded simulator and in MuJoCo: how far apart robots end their actions.

    .venv/bin/python tests/scripts/mujoco_random.py             # 200 programs
    .venv/bin/python tests/scripts/mujoco_random.py --count 20

Prints programs that miss the target, and a table: how far apart the actions of each type of robot end, and how much longer programs
take in MuJoCo. Four plain wheels scrub in turns, so programs with such robots may take 15 % longer instead of 5 %.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import pathlib
import random
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from statistics import median
from typing import NamedTuple

ROOT = pathlib.Path(__file__).parents[2]
sys.path += [str(ROOT / "tests" / part) for part in ("scripts", "support")]

from program_runs import Row, command_line, lines  # noqa: E402
from test_random_paths import WHEELS, check, program  # noqa: E402

DEBUG = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug"
COMMAND = os.environ.get("PYDSLREP", str(DEBUG / "pydslrep"))

POSITION, HEADING = 0.02, 1.5  # m and degrees
LATE, LATE_SCRUBBING = (
    0.05,
    0.15,
)  # shares of the time, without and with four plain wheels


class Apart(NamedTuple):
    """How far an action of a robot ends from where it ends in the other engine."""

    drive: str
    metres: float
    degrees: float

    @property
    def meets_target(self) -> bool:
        """Whether it may be so far."""
        return self.metres <= POSITION and self.degrees <= HEADING


class Difference(NamedTuple):
    """Between two runs of a program."""

    seed: int
    scrubs: bool
    """Whether a robot has four plain wheels."""
    actions: tuple[Apart, ...] = ()
    late: float = 0.0
    """The share by which MuJoCo takes longer."""
    failure: str = ""

    @property
    def meets_target(self) -> bool:
        """Whether the engines agree."""
        most = LATE_SCRUBBING if self.scrubs else LATE
        return (
            not self.failure
            and all(each.meets_target for each in self.actions)
            and abs(self.late) <= most
        )

    def __str__(self) -> str:
        if self.failure:
            return f"{self.seed}: {self.failure}"
        metres = max(each.metres for each in self.actions)
        degrees = max(each.degrees for each in self.actions)
        return (
            f"{self.seed}: {len(self.actions)} actions, {1000 * metres:.1f} mm, {degrees:.2f} deg, "
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
    drives = dict(re.findall(r"robot (\w+) type (\w+)", text))
    scrubs = "fw" in drives.values()
    failed = [
        each["message"] for run in both for each in run if each["event"] == "failed"
    ]
    if failed:
        return Difference(seed, scrubs, failure=json.dumps(failed))
    embedded, other = (ends_of(run) for run in both)
    if embedded.keys() != other.keys():
        return Difference(seed, scrubs, failure="other actions have ended")
    actions = (apart(drives[key[0]], embedded[key], other[key]) for key in embedded)
    ends = [max(event["t"] for event in each.values()) for each in (embedded, other)]
    return Difference(seed, scrubs, tuple(actions), ends[1] / ends[0] - 1.0)


def ends_of(events: list[Row]) -> dict[tuple[str, int], Row]:
    """The events of actions that have ended, by robot and number."""
    counts: Counter[str] = Counter()
    found = {}
    for event in events:
        if event["event"] == "action-ended":
            counts[event["robot"]] += 1
            found[event["robot"], counts[event["robot"]]] = event
    return found


def apart(drive: str, one: Row, other: Row) -> Apart:
    """How far two ends are apart."""
    turned = abs(math.remainder(one["theta"] - other["theta"], math.tau))
    metres = math.dist((one["x"], one["y"]), (other["x"], other["y"]))
    return Apart(drive, metres, math.degrees(turned))


def table(found: list[Difference]) -> Iterator[str]:
    """The lines of the table."""
    actions = [action for each in found for action in each.actions]
    for drive in WHEELS:
        own = [action for action in actions if action.drive == drive]
        if own:
            metres = [1000 * action.metres for action in own]
            degrees = [action.degrees for action in own]
            yield (
                f"{drive}: {len(own)} actions, median {median(metres):.1f} mm and {median(degrees):.2f} deg, "
                f"largest {max(metres):.1f} mm and {max(degrees):.2f} deg"
            )
    for scrubs, words in ((False, "without"), (True, "with")):
        late = [
            100 * each.late
            for each in found
            if each.scrubs == scrubs and not each.failure
        ]
        if late:
            yield (
                f"{words} four plain wheels: {len(late)} programs, median {median(late):+.1f} % of the time, "
                f"{min(late):+.1f} to {max(late):+.1f} %"
            )
    yield f"{sum(each.meets_target for each in found)} of {len(found)} programs meet the target"


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
        if not found[-1].meets_target:
            print(found[-1], flush=True)
    for line in table(found):
        print(line)


if __name__ == "__main__":
    main()
