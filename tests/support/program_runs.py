"""Runs of programs by the command, as tests see them: their events, traces, and how far from the plan they end."""

from __future__ import annotations

import json
import math
import os
import pathlib
import subprocess
from typing import Any

VREP_CLIENT = pathlib.Path(__file__).parents[1] / "vrep"

POSITION, HEADING = 0.005, 0.5  # m and degrees that an action ends beside its plan

Row = dict[str, Any]
"""An action of a plan, an event or a line of a trace."""


def command_line(
    command: str, folder: pathlib.Path, *words: str, target: str = "coppeliasim"
) -> subprocess.CompletedProcess[str]:
    """Runs the command in a folder, where scripts find V-REP's client if they need it."""
    client = {"PYTHONPATH": str(VREP_CLIENT)} if target == "vrep" else {}
    return subprocess.run(
        [command, *words],
        cwd=folder,
        env={**os.environ, **client},
        capture_output=True,
        encoding="utf-8",
        check=False,
        timeout=600,
    )


def lines(text: str) -> list[Row]:
    return [json.loads(line) for line in text.splitlines()]


def drive(
    command: str,
    folder: pathlib.Path,
    trace: pathlib.Path,
    program: str,
    environment: str,
    target: str = "coppeliasim",
    *options: str,
) -> tuple[list[Row], list[Row]]:
    """Drives a program; returns the events and the lines of the trace."""
    done = command_line(
        command,
        folder,
        *("run", f"{program}.pyr", "--environment", environment, "--no-progress"),
        *("--target", target, "--events", "-", "--trace", str(trace), *options),
        target=target,
    )
    events = lines(done.stdout)
    assert done.returncode == 0, (done.stderr, events[-3:])
    return events, lines(trace.read_text(encoding="utf-8"))


def place(row: Row) -> Row:
    """Where an action is in its program."""
    parts = ("movement", "action", "line", "rounds", "calls")
    return {part: row[part] for part in parts if part in row}


def assert_near(
    row: Row, goal: Row, metres: float = POSITION, degrees: float = HEADING
) -> None:
    off = math.hypot(row["x"] - goal["x"], row["y"] - goal["y"])
    turned = math.degrees(math.remainder(row["theta"] - goal["theta"], math.tau))
    assert off <= metres, f"{row}: {1000.0 * off:.1f} mm off"
    assert abs(turned) <= degrees, f"{row}: {turned:.2f} deg off"


def offsets(plan: Row, events: list[Row]) -> list[tuple[float, float]]:
    """How far each action that has ended is from its plan, in metres and degrees, robot by robot."""
    found = []
    for robot in plan["robots"]:
        ended = [
            event
            for event in events
            if event["event"] == "action-ended" and event["robot"] == robot["name"]
        ]
        for goal, end in zip(robot["poses"], ended, strict=False):
            away = math.hypot(end["x"] - goal["x"], end["y"] - goal["y"])
            turned = math.remainder(end["theta"] - goal["theta"], math.tau)
            found.append((away, abs(math.degrees(turned))))
    return found
