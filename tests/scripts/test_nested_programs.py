"""Random nested programs: what is driven is what is planned, and scripts pass ruff and mypy however deep their blocks are.

Twelve of them run here, two hundred with `--long`.
"""

from __future__ import annotations

import functools
import itertools
import json
import os
import pathlib
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from check_scripts import check_scripts
from length import few
from program_runs import assert_near, drive, place

ROOT = pathlib.Path(__file__).parents[2]
TARGET = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
GENERATOR = os.environ.get("RANDOM_PROGRAMS", TARGET / "debug" / "random-programs")

ALL, FEW = 200, 3
LINES = 40
# Longer ones cost time and show nothing more.
ACTIONS, DURATION = 80, 150.0  # s


@dataclass(frozen=True)
class Example:
    """A program with the planned path of an environment."""

    text: str
    plan: dict[str, Any]


@functools.cache
def generated() -> list[str]:
    """Programs whose path is known."""
    words = [GENERATOR, str(20 * ALL), str(LINES), "tidy", "known"]
    done = subprocess.run(words, capture_output=True, check=True)
    return done.stdout.decode().split("\0")[:-1]


def nested(command: str) -> Iterator[Example]:
    """Those with blocks or calls that drive something, but not for long."""
    for text in generated():
        done = subprocess.run(
            [command, "plan", "-", "--json"],
            input=text.encode(),
            capture_output=True,
            check=False,
        )
        for plan in json.loads(done.stdout or b"[]"):
            poses = [pose for robot in plan["robots"] for pose in robot["poses"]]
            is_nested = any("rounds" in pose or "calls" in pose for pose in poses)
            if is_nested and len(poses) <= ACTIONS and plan["duration"] <= DURATION:
                yield Example(text, plan)
                break


class Examples:
    """Nested programs, each found when it is needed."""

    def __init__(self) -> None:
        self.found: list[Example] = []
        self.more: Iterator[Example] | None = None

    def get(self, command: str, number: int) -> Example:
        """The one with a number."""
        self.more = self.more or nested(command)
        missing = number + 1 - len(self.found)
        self.found += itertools.islice(self.more, max(missing, 0))
        return self.found[number]


EXAMPLES = Examples()


@pytest.mark.parametrize("number", few(FEW, range(ALL)))
def test_what_is_driven_is_planned(
    command: str, tmp_path: pathlib.Path, number: int
) -> None:
    example = EXAMPLES.get(command, number)
    (tmp_path / "program.pyr").write_text(example.text, encoding="utf-8")
    name = example.plan["environment"]
    events, _ = drive(command, tmp_path, tmp_path / "trace", "program", name)
    for robot in example.plan["robots"]:
        ended = [
            event
            for event in events
            if event["event"] == "action-ended" and event["robot"] == robot["name"]
        ]
        assert [place(each) for each in ended] == [
            place(each) for each in robot["poses"]
        ]
        for each, action in zip(ended, robot["poses"], strict=True):
            assert_near(each, action)


def test_scripts_pass_ruff_and_mypy(
    command: str, tmp_path: pathlib.Path, long: bool
) -> None:
    scripts = tmp_path / "scripts"
    for number in range(ALL if long else FEW):
        folder = tmp_path / f"program_{number}"
        folder.mkdir()
        example = EXAMPLES.get(command, number)
        (folder / "program.pyr").write_text(example.text, encoding="utf-8")
        build = [command, "build", "program.pyr", "-o", "out"]
        subprocess.run(build, cwd=folder, check=True, capture_output=True)
        # In one folder, names must be different.
        scripts.mkdir(exist_ok=True)
        for file in (folder / "out").glob("*.py"):
            shutil.copy(file, scripts / f"script_{number}_{file.name}")
    check_scripts(scripts)
    for script in scripts.iterdir():
        # Python has a limit that the tools do not know.
        compile(script.read_text(encoding="utf-8"), script.name, "exec")


INNERMOST = 15

# Of each statement one; `{inner}` is the next block.
BLOCK = """
move 1 meters
move 2 meters at 20 until {{ front }} detect
turn left 30 with radius 1.5 meters in reverse until {{ front side }} detect within 0.4 meters
turn left until {{ front }}
wait 2 seconds until {{ side }} clear within 1 meters
do other
if {{ front }} detect {{ wait 1 seconds }}
else if {{ front side }} clear within 0.25 meters {{ wait 2 seconds }}
else if {{ front }} clear {{ wait 3 seconds }}
else {{ wait 4 seconds }}
repeat until {{ front }} clear {{ wait 2 seconds }}
repeat until {{ side }} clear within 1.5 meters {{ wait 2 seconds }}
repeat {count} times {{ {inner} }}
"""

DEEP = """
wheel a with radius 4.5
wheel b with radius 4.5
sensor front
sensor side
robot {robot} type tw with port 23000 has {{ a b }} wheels with sensors {{ front side }}
movement other of {robot} {{ wait 1 seconds }}
movement deep of {robot} {{ {block} }}
environment {robot}_yard has {{ {robot} }} robots with {{ deep }} moves
"""


def test_deep_blocks_are_formatted(command: str, tmp_path: pathlib.Path) -> None:
    """Names of all lengths move what does not fit on a line."""
    for length in range(1, 41):
        block = "wait 1 seconds"
        for depth in range(INNERMOST):
            # One count of up to five digits: more of them would take more than 30 days.
            many = 10 ** (length % 5) if depth == length % INNERMOST else 1
            block = BLOCK.format(count=many, inner=block)
        file = tmp_path / f"{length}.pyr"
        text = DEEP.format(robot="r" * length, block=block)
        file.write_text(text, encoding="utf-8")
        build = [command, "build", str(file), "-o", str(tmp_path / "out")]
        done = subprocess.run(build, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    scripts = tmp_path / "scripts"
    scripts.mkdir()
    for script in (tmp_path / "out").glob("*.py"):
        script.rename(scripts / script.name)
    assert len(list(scripts.iterdir())) == 40
    check_scripts(scripts)
