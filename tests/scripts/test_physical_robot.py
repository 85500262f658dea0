"""The classes in docs/physical-robot.md drive a robot as the page says, and so does its script by hand."""

from __future__ import annotations

import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import textwrap
from collections.abc import Callable
from typing import Any

import mypy_cache
import pytest

ROOT = pathlib.Path(__file__).parents[2]
DRIVER = pathlib.Path(__file__).with_name("motor_driver.py")

PROGRAM = """
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor eye
robot rover with port 23000 has { wheelL wheelR } wheels with sensors { eye }
movement trip of rover { move 40 centimeters turn left until { eye } move 20 centimeters turn left 90 }
environment yard has { rover } robots with { trip } moves
"""


def code_of_the_page() -> list[str]:
    """Its blocks of code: a robot, one that explores, and a script by hand."""
    page = (ROOT / "docs" / "physical-robot.md").read_text(encoding="utf-8")
    return [
        textwrap.dedent(code)
        for code in re.findall(r"^ *```python\n(.*?)^ *```$", page, re.M | re.S)
    ]


EXPLORING = """
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor front
sensor front_left
sensor front_right
sensor side_left
sensor side_right
robot rover with port 23000 has { wheelL wheelR } wheels with sensors { front front_left front_right side_left side_right }
movement trip of rover { slam }
environment yard has { rover } robots with { trip } moves
"""


@pytest.fixture(name="build")
def fixture_build(
    command: str, tmp_path: pathlib.Path
) -> Callable[[str], pathlib.Path]:
    """Builds a program next to the page's module and its driver; returns the folder."""

    def build(text: str) -> pathlib.Path:
        program = tmp_path / "program.pyr"
        program.write_text(text, encoding="utf-8")
        subprocess.run([command, "build", program], check=True, capture_output=True)
        robot, explorer, *_ = code_of_the_page()
        (tmp_path / "my_robot.py").write_text(f"{robot}\n{explorer}", encoding="utf-8")
        shutil.copy(DRIVER, tmp_path)
        return tmp_path

    return build


def drive(
    folder: pathlib.Path, code: int, trouble: str, *options: str
) -> tuple[Any, str]:
    """The robot's actual end pose, and the script's error output."""
    done = subprocess.run(
        [sys.executable, "yard.py", *options],
        cwd=folder,
        env={**os.environ, "MOTOR_DRIVER": trouble},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == code, done.stderr
    truth = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
    assert not any(truth["wanted"])
    return truth, done.stderr


ROVER = "--robot=my_robot:Rover"
EXPLORER = "--robot=rover=my_robot:Explorer"


def test_the_robot_reaches_its_goal(build: Callable[[str], pathlib.Path]) -> None:
    truth, _ = drive(build(PROGRAM), 0, "", ROVER)
    # It turns until the sensor is free, moves 20 cm, and turns by a right angle.
    free = truth["theta"] - math.pi / 2
    assert math.radians(30) < free < math.radians(40)
    goal = (0.4 + 0.2 * math.cos(free), 0.2 * math.sin(free))
    assert math.dist((truth["x"], truth["y"]), goal) < 0.005
    assert truth["closed"]


def test_a_blocked_wheel_is_reported(build: Callable[[str], pathlib.Path]) -> None:
    _, err = drive(build(PROGRAM), 1, "stuck", ROVER)
    assert "a wheel may be blocked, or the motors have no power" in err


def test_missing_motors_are_reported(build: Callable[[str], pathlib.Path]) -> None:
    _, err = drive(build(PROGRAM), 2, "missing", ROVER)
    assert err == "error: robot rover: no motor wheelL on the bus\n"


@pytest.mark.parametrize("options", [[], ["--odometry"]])
def test_a_robot_explores_its_room(
    build: Callable[[str], pathlib.Path], options: list[str]
) -> None:
    folder = build(EXPLORING)
    truth, _ = drive(folder, 0, "room", EXPLORER, *options)
    found = json.loads((folder / "yard_map.json").read_text(encoding="utf-8"))
    nodes = [(node["x"], node["y"]) for node in found["nodes"]]
    # It starts at one end of a room of 2.2 m by 1 m.
    assert max(x for x, _ in nodes) > 0.7
    assert all(-0.25 < x < 1.45 and abs(y) < 0.25 for x, y in nodes)
    assert len(found["edges"]) >= len(nodes) - 1
    assert min(math.dist((truth["x"], truth["y"]), node) for node in nodes) < 0.05


def test_a_sensor_that_breaks_ends_the_exploration(
    build: Callable[[str], pathlib.Path],
) -> None:
    _, err = drive(build(EXPLORING), 1, "broken", EXPLORER)
    assert "robot rover, movement trip, action 1: slam: no reply from sensor" in err


@pytest.mark.parametrize(
    ("choice", "message"),
    [
        ("nothing_here:Rover", "there is no Python module nothing_here; "),
        ("my_robot:Nobody", "module my_robot has no class Nobody\n"),
        ("math:sqrt", "must be real number"),
        ("builtins:str", "builtins:str lacks clock, wheel_mounts, pose, "),
        ("my_robot", "'my_robot' is not of the form MODULE:CLASS\n"),
        ("other=my_robot:Rover", "no robot other; the robots are rover\n"),
    ],
)
def test_a_wrong_class_is_reported(
    build: Callable[[str], pathlib.Path], choice: str, message: str
) -> None:
    done = subprocess.run(
        [sys.executable, "yard.py", f"--robot={choice}"],
        cwd=build(PROGRAM),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode != 0
    assert message in done.stderr


def test_the_module_passes_ruff_and_mypy(
    build: Callable[[str], pathlib.Path],
) -> None:
    folder = build(PROGRAM)
    for arguments in (
        # The second block of the page imports where it begins.
        ["ruff", "check", "--ignore=E402", "--isolated", "--no-cache", "my_robot.py"],
        ["mypy", "--strict", "--config-file=", mypy_cache.option(), "my_robot.py"],
    ):
        done = subprocess.run(
            [sys.executable, "-m", *arguments],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stdout


def test_ten_lines_by_hand_drive_a_robot(
    build: Callable[[str], pathlib.Path],
) -> None:
    folder = build(PROGRAM)
    _, _, by_hand, _ = code_of_the_page()
    (folder / "yard.py").write_text(by_hand, encoding="utf-8")
    truth, _ = drive(folder, 0, "", ROVER)
    assert math.hypot(truth["x"], truth["y"]) < 0.01
    assert truth["theta"] == pytest.approx(math.tau, abs=0.02)


def test_a_script_by_hand_reacts(build: Callable[[str], pathlib.Path]) -> None:
    folder = build(PROGRAM)
    *_, reacting = code_of_the_page()
    (folder / "yard.py").write_text(reacting, encoding="utf-8")
    truth, _ = drive(folder, 0, "room", EXPLORER)
    # The body keeps away from the walls of the room, wherever it has been led.
    assert -0.35 < truth["x"] < 1.55
    assert abs(truth["y"]) < 0.35
    assert abs(truth["theta"]) > math.radians(80.0)
    _, err = drive(folder, 1, "broken", EXPLORER)
    assert re.match(
        r"error: robot rover, movement patrol, action \d.*: no reply from sensor front$",
        err.strip(),
    )
