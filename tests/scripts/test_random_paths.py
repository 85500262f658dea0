"""In random programs, robots end every action where planned: in an ideal world, with noise, and with worn wheels.

One to six robots of all types drive in the embedded simulator, in any order and in parallel, turn by any angle and move
at any speed. A few of these programs run without `--long`.
"""

from __future__ import annotations

import itertools
import json
import math
import pathlib
import random
import subprocess
from dataclasses import dataclass

import pytest
from length import few
from pydslrep_runtime.facts import ROBOT_TYPES

ALL, FEW = 100, 4

# The beginning of a scene, by what is not as it should be.
WORLDS = {
    "ideal": "",
    "noise": "[noise]\n",
    "wear": "[noise]\ntrack-error = 3\nradius-error = -3\n",
}

WHEELS = {
    name: ("wheelH" if kind.mecanum else "wheel", len(kind.wheels))
    for name, kind in ROBOT_TYPES.items()
}


@dataclass(frozen=True)
class Tolerance:
    """The largest error at the end of an action."""

    metres: float
    degrees: float


CLEAN = Tolerance(0.005, 0.5)
NOISY = Tolerance(0.02, 1.5)


def number(value: float) -> str:
    return f"{value:.3f}"


def action(dice: random.Random) -> str:
    if dice.random() < 0.5:
        side = dice.choice(["left", "right"])
        angle = dice.choice([dice.uniform(0.5, 360.0), dice.choice([45, 90, 180, 360])])
        return f"turn {side} {number(angle)}"
    distance = dice.choice([-1.0, 1.0]) * dice.uniform(0.01, 1.5)
    if dice.random() < 0.5:
        length = f"{number(distance)} meters"
    else:
        length = f"{number(100.0 * distance)} centimeters"
    speed = dice.choice(["", f" at {number(dice.uniform(5.0, 100.0))}"])
    return f"move {length}{speed}"


def program(dice: random.Random) -> tuple[str, str]:
    """A program and its scene."""
    lines, scene, movements = [], ["[world]", "collisions = false"], []
    robots = [f"r{index}" for index in range(dice.randint(1, 6))]
    for index, robot in enumerate(robots):
        drive = dice.choice(list(WHEELS))
        word, count = WHEELS[drive]
        wheels = [f"w{index}_{place}" for place in range(count)]
        radius = number(dice.uniform(2.0, 10.0))
        lines += [f"{word} {wheel} with radius {radius}" for wheel in wheels]
        listed = " ".join(wheels)
        lines.append(
            f"robot {robot} type {drive} with port {20000 + index} has {{ {listed} }} wheels"
        )
        scene += [
            f"[robots.{robot}]",
            f"start = [{number(dice.uniform(-5, 5))}, {number(dice.uniform(-5, 5))}, {number(dice.uniform(-180, 180))}]",
            f"track = {number(dice.uniform(0.2, 0.5))}",
            f"wheelbase = {number(dice.uniform(0.15, 0.4))}",
        ]
        for run in range(dice.randint(1, 2)):
            actions = " ".join(action(dice) for _ in range(dice.randint(1, 4)))
            parallel = dice.choice(["", "parallel "])
            name = f"m{index}_{run}"
            lines.append(f"{parallel}movement {name} of {robot} {{ {actions} }}")
            movements.append(name)
    dice.shuffle(movements)
    lines.append(
        f"environment e has {{ {' '.join(robots)} }} robots with {{ {' '.join(movements)} }} moves"
    )
    return "\n".join(lines), "\n".join(scene)


def ends(trace: pathlib.Path) -> dict[str, list[dict[str, float]]]:
    """The last pose of each action of each robot, in order."""
    rows = [json.loads(line) for line in trace.read_text(encoding="utf-8").splitlines()]
    found: dict[str, list[dict[str, float]]] = {}
    for robot in {row["robot"] for row in rows}:
        own = (row for row in rows if row["robot"] == robot)
        actions = itertools.groupby(own, lambda row: (row["movement"], row["action"]))
        found[robot] = [list(group)[-1] for _, group in actions]
    return found


def compare(
    plan: dict[str, list[dict[str, float]]],
    driven: dict[str, list[dict[str, float]]],
    near: Tolerance,
) -> None:
    for robot, poses in plan.items():
        ended = driven.get(robot, [])
        assert len(ended) == len(poses), robot
        for goal, end in zip(poses, ended, strict=True):
            off = math.hypot(end["x"] - goal["x"], end["y"] - goal["y"])
            turned = abs(math.remainder(end["theta"] - goal["theta"], math.tau))
            place = f"{robot}, {end['action']}"
            assert off <= near.metres, f"{place}: {1000 * off:.1f} mm off"
            assert math.degrees(turned) <= near.degrees, (
                f"{place}: {math.degrees(turned):.2f} deg off"
            )


def drive(command: str, folder: pathlib.Path, seed: int, world: str) -> None:
    dice = random.Random(seed)
    text, scene = program(dice)
    # A robot cannot run two movements in parallel.
    while "parallel-conflict" in check(command, folder, text):
        text, scene = program(dice)
    (folder / "e.scene.toml").write_text(WORLDS[world] + scene, encoding="utf-8")
    plan = run(command, folder, "plan", "--json")
    [planned] = json.loads(plan.stdout)
    options = ["--no-progress", "--seed", str(seed)]
    done = run(command, folder, "run", *options, "--trace", "trace")
    assert done.returncode == 0, done.stderr
    poses = {robot["name"]: robot["poses"] for robot in planned["robots"]}
    compare(poses, ends(folder / "trace"), CLEAN if world == "ideal" else NOISY)


def check(command: str, folder: pathlib.Path, text: str) -> str:
    (folder / "program.pyr").write_text(text, encoding="utf-8")
    return run(command, folder, "check").stdout


def run(
    command: str, folder: pathlib.Path, word: str, *options: str
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [command, word, "program.pyr", *options],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )


@pytest.mark.parametrize("seed", few(FEW, range(ALL)))
def test_every_action_ends_where_it_is_planned(
    command: str, tmp_path: pathlib.Path, seed: int
) -> None:
    drive(command, tmp_path, seed, tuple(WORLDS)[seed % len(WORLDS)])
