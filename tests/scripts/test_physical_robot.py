"""The class in docs/physical-robot.md drives a robot when put into a generated script as the page says."""

from __future__ import annotations

import ast
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import textwrap
from typing import Any

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
    """The code blocks that its steps put into a script."""
    page = (ROOT / "docs" / "physical-robot.md").read_text(encoding="utf-8")
    return [
        textwrap.dedent(code)
        for code in re.findall(r"^ *```python\n(.*?)^ *```$", page, re.M | re.S)
    ]


def ported(script: str, *, explores: bool = False) -> str:
    """The script with the page's replacements."""
    imports, body, mounts, methods = code_of_the_page()
    if explores:
        body = f"{mounts}\n\n{body}\n{textwrap.indent(methods, '    ')}"
    lines = script.splitlines(keepends=True)
    places: dict[str, tuple[int, int]] = {}
    for node in ast.parse(script).body:
        # The only `try` at the top level imports the client.
        is_client = isinstance(node, ast.Try)
        name = "client" if is_client else str(getattr(node, "name", ""))
        places[name] = (node.lineno - 1, node.end_lineno or 0)
    replaced = {
        "Body": body,
        "TimeoutSocket": "",
        "client": imports,
    }
    for name, code in sorted(replaced.items(), key=lambda item: -places[item[0]][0]):
        first, last = places[name]
        lines[first:last] = [code]
    return "".join(lines)


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


def build(
    command: str, folder: pathlib.Path, text: str, *, explores: bool
) -> pathlib.Path:
    program = folder / "program.pyr"
    program.write_text(text, encoding="utf-8")
    subprocess.run([command, "build", str(program)], check=True, capture_output=True)
    script = folder / "yard.py"
    generated = script.read_text(encoding="utf-8")
    script.write_text(ported(generated, explores=explores), encoding="utf-8")
    shutil.copy(DRIVER, folder)
    return script


@pytest.fixture(name="script")
def fixture_script(command: str, tmp_path: pathlib.Path) -> pathlib.Path:
    return build(command, tmp_path, PROGRAM, explores=False)


@pytest.fixture(name="explorer")
def fixture_explorer(command: str, tmp_path: pathlib.Path) -> pathlib.Path:
    return build(command, tmp_path, EXPLORING, explores=True)


def drive(
    script: pathlib.Path, code: int, trouble: str = "", *options: str
) -> tuple[Any, str]:
    """The robot's actual end pose, and the script's error output."""
    done = subprocess.run(
        [sys.executable, str(script), *options],
        cwd=script.parent,
        env={**os.environ, "MOTOR_DRIVER": trouble},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == code, done.stderr
    truth = json.loads((script.parent / "truth.json").read_text(encoding="utf-8"))
    assert not any(truth["wanted"])
    return truth, done.stderr


def test_the_robot_reaches_its_goal(script: pathlib.Path) -> None:
    truth, _ = drive(script, 0)
    # It turns until the sensor is free, moves 20 cm, and turns by a right angle.
    free = truth["theta"] - math.pi / 2
    assert math.radians(30) < free < math.radians(40)
    goal = (0.4 + 0.2 * math.cos(free), 0.2 * math.sin(free))
    assert math.dist((truth["x"], truth["y"]), goal) < 0.005
    assert truth["closed"]


def test_a_blocked_wheel_is_reported(script: pathlib.Path) -> None:
    _, err = drive(script, 1, "stuck")
    assert "a wheel may be blocked, or the motors have no power" in err


def test_missing_motors_are_reported(script: pathlib.Path) -> None:
    _, err = drive(script, 2, "missing")
    assert err == "error: robot rover: no motor wheelL on the bus\n"


@pytest.mark.parametrize("options", [[], ["--odometry"]])
def test_a_robot_explores_its_room(explorer: pathlib.Path, options: list[str]) -> None:
    truth, _ = drive(explorer, 0, "room", *options)
    found = json.loads((explorer.parent / "yard_map.json").read_text(encoding="utf-8"))
    nodes = [(node["x"], node["y"]) for node in found["nodes"]]
    # It starts at one end of a room of 2.2 m by 1 m.
    assert max(x for x, _ in nodes) > 0.7
    assert all(-0.25 < x < 1.45 and abs(y) < 0.25 for x, y in nodes)
    assert len(found["edges"]) >= len(nodes) - 1
    assert min(math.dist((truth["x"], truth["y"]), node) for node in nodes) < 0.05


def test_a_sensor_that_breaks_ends_the_exploration(explorer: pathlib.Path) -> None:
    _, err = drive(explorer, 1, "broken")
    assert "robot rover, movement trip, action 1: slam: no reply from sensor" in err


@pytest.mark.parametrize("kind", ["script", "explorer"])
def test_the_ported_script_passes_ruff_and_mypy(
    kind: str, request: pytest.FixtureRequest
) -> None:
    script: pathlib.Path = request.getfixturevalue(kind)
    for arguments in (
        # Unused imports are left to the reader.
        ["ruff", "check", "--ignore=F401", "--isolated", "--no-cache", script.name],
        ["mypy", "--strict", "--config-file=", "--follow-imports=silent", script.name],
    ):
        done = subprocess.run(
            [sys.executable, "-m", *arguments],
            cwd=script.parent,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stdout
