"""Programs drive the same through V-REP's legacy remote API as through CoppeliaSim's."""

from __future__ import annotations

import itertools
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
from collections.abc import Sequence

import pytest
from length import few
from ports import free_ports
from stage import (
    HERE,
    PROGRAM,
    ROOT,
    Stage,
    assert_near,
    ends,
    finish,
    interrupt,
    onlooker,
    start,
)

TURNING = """\
[[wall]]
from = [4.6, -0.8]
to = [4.6, 1.5]
"""
ROOM = """\
[world]
size = [2.4, 1.8]

[robots.robot_1]
start = [-0.6, 0, 0]
"""

CORRIDOR = """\
[world]
size = [1.8, 1.0]
corner = [0, 0]

[robots.robot_1]
start = [0.4, 0.5]
"""

# s; with longer ones, a robot in real time may pass its goal by more than the tolerance.
LONGEST_STEP = 0.15

PAPER = ROOT / "tests" / "paper"
EXAMPLES = ROOT / "examples"


def run(
    command: str,
    program: pathlib.Path,
    trace: pathlib.Path,
    target: str = "vrep",
    options: Sequence[str] = (),
) -> None:
    done = subprocess.run(
        [command, "run", program, "--target", target, "--trace", trace, *options],
        env={**os.environ, "PYTHONPATH": str(HERE)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("program", "goal"),
    few(
        2,
        [
            (PAPER / "table4_holonomic.pyr", (0.0, -4.0, 180.0)),
            # There are no obstacles, so its sensors are free.
            (PAPER / "table6_sensors.pyr", (12.0, 0.0, 0.0)),
            (PAPER / "table2_two_wheels.pyr", (0.0, -4.0, 180.0)),
            (PAPER / "table3_four_wheels.pyr", (0.0, -4.0, 180.0)),
            (ROOT / "tests/programs/table5_with_wheels.pyr", (3.182, 1.525, 90.0)),
        ],
    ),
    ids=lambda value: value.stem if isinstance(value, pathlib.Path) else "",
)
def test_the_articles_programs(
    command: str,
    tmp_path: pathlib.Path,
    program: pathlib.Path,
    goal: tuple[float, float, float],
) -> None:
    run(command, program, tmp_path / "trace")
    assert_near(ends(tmp_path / "trace")["robot_1"], goal)


@pytest.mark.parametrize("name", few(1, ("horseshoe", "convoy")))
def test_both_targets_drive_alike(
    command: str, tmp_path: pathlib.Path, name: str
) -> None:
    """Several robots in parallel, and turning until sensors are free."""
    found = []
    for target in ("vrep", "coppeliasim"):
        run(command, EXAMPLES / f"{name}.pyr", tmp_path / target, target)
        found.append(ends(tmp_path / target))
    vrep, coppeliasim = found
    assert vrep.keys() == coppeliasim.keys()
    for robot, end in vrep.items():
        assert_near(end, coppeliasim[robot], 0.001, 0.1)


def test_walls_make_table_6_turn(command: str, tmp_path: pathlib.Path) -> None:
    """The robot reaches the wall, turns until its sensors are free, and follows the wall."""
    program = tmp_path / "table6_sensors.pyr"
    shutil.copy(PAPER / program.name, program)
    (tmp_path / "area_1.scene.toml").write_text(TURNING, encoding="utf-8")
    found = []
    for target in ("vrep", "coppeliasim"):
        run(command, program, tmp_path / target, target)
        [end] = ends(tmp_path / target).values()
        found.append(end)
    assert_near(found[0], found[1], 0.001, 0.1)
    assert abs(found[0][2]) > 10, "it turned"


def test_table_7_explores(command: str, tmp_path: pathlib.Path) -> None:
    """A small closed room gives the same map with both targets."""
    program = tmp_path / "table7_slam.pyr"
    shutil.copy(PAPER / program.name, program)
    (tmp_path / "area_1.scene.toml").write_text(ROOM, encoding="utf-8")
    found = []
    for target in ("vrep", "coppeliasim"):
        file = tmp_path / f"{target}.json"
        run(command, program, tmp_path / target, target, ["--map", str(file)])
        found.append(json.loads(file.read_text(encoding="utf-8")))
    vrep, coppeliasim = found
    assert len(vrep["nodes"]) == len(coppeliasim["nodes"]) > 4
    assert len(vrep["edges"]) == len(coppeliasim["edges"])
    for one, other in zip(vrep["nodes"], coppeliasim["nodes"], strict=True):
        assert math.dist((one["x"], one["y"]), (other["x"], other["y"])) < 0.01


@pytest.mark.parametrize("target", few(1, ("vrep", "coppeliasim")))
def test_table_7_explores_by_odometry(
    command: str, tmp_path: pathlib.Path, target: str
) -> None:
    """Where it believes that it is, from its wheels and scans, is where it is."""
    program = tmp_path / "table7_slam.pyr"
    shutil.copy(PAPER / program.name, program)
    (tmp_path / "area_1.scene.toml").write_text(CORRIDOR, encoding="utf-8")
    trace, figures = tmp_path / "trace", tmp_path / "figures.json"
    map_file = tmp_path / "map.json"
    files = ["--map", str(map_file), "--figures", str(figures)]
    options = ["--odometry", "--python", sys.executable, *files]
    run(command, program, trace, target, options)
    [robot] = json.loads(figures.read_text(encoding="utf-8"))["robots"]
    there = robot["driven"]
    real = there["x"], there["y"], math.degrees(there["theta"])
    [believed] = ends(trace).values()
    assert_near(believed, real, 0.03, 2.0)
    assert math.dist(believed[:2], real[:2]) > 1e-4, "that is the simulator's pose"
    assert len(json.loads(map_file.read_text(encoding="utf-8"))["nodes"]) == 3


def test_a_run_can_be_repeated(command: str, tmp_path: pathlib.Path) -> None:
    """Triggered steps are deterministic, even with several robots."""
    traces = []
    for trace in (tmp_path / "first", tmp_path / "second"):
        run(command, EXAMPLES / "convoy.pyr", trace)
        traces.append(trace.read_bytes())
    assert traces[0] == traces[1]
    assert traces[0].count(b"\n") > 1000


def test_robots_may_share_a_port_in_the_program(
    command: str, tmp_path: pathlib.Path
) -> None:
    program = PROGRAM.format(23000, 23000, actions="move 5 centimeters")
    program = program.replace("yard has { rover }", "yard has { rover other }")
    stage = Stage(command, tmp_path / "stage", program)
    run(command, stage.program, tmp_path / "trace", options=["--environment", "yard"])
    assert_near(ends(tmp_path / "trace")["rover"], (0.05, 0.0, 0.0))


def test_realtime(command: str, tmp_path: pathlib.Path) -> None:
    """Without triggers, commands are delayed by some milliseconds of communication, or more on a busy machine."""
    ports = free_ports(2)
    actions = "move 3 centimeters turn left 20 move 6 centimeters at 20"
    stage = Stage(command, tmp_path / "stage", PROGRAM.format(*ports, actions=actions))
    script = stage.build("vrep")
    trace = tmp_path / "trace"
    with stage.simulator():
        finish(start(script, "--realtime", "--trace", str(trace)))
    rows = [json.loads(line) for line in trace.read_text(encoding="utf-8").splitlines()]
    assert {row["action"].partition(":")[0] for row in rows} >= {"1", "2", "3"}
    # Closed-loop control runs until the goal is reached: a short delay costs time, not accuracy.
    steps = [after["t"] - before["t"] for before, after in itertools.pairwise(rows)]
    if max(steps) <= LONGEST_STEP:
        assert_near(ends(trace)["rover"], (0.0864, 0.0205, 20.0))


def test_scripts_of_both_targets_at_once(command: str, tmp_path: pathlib.Path) -> None:
    *ports, spare = free_ports(5)
    wheels = "wheel wheelL with radius 4.5 wheel wheelR with radius 4.5"
    robots = "".join(
        f"robot r{index} with port {port} has {{ wheelL wheelR }} wheels\n"
        for index, port in enumerate((*ports, spare))
    )
    all_of_them = "environment world has { r0 r1 r2 r3 r4 } robots"
    world = Stage(command, tmp_path / "world", f"{wheels}\n{robots}{all_of_them}")
    scripts = []
    for target, (first, second) in {"vrep": (0, 1), "coppeliasim": (2, 3)}.items():
        program = f"""{wheels}\n{robots}
            parallel movement a of r{first} {{ move 30 centimeters turn left 45 }}
            parallel movement b of r{second} {{ turn right 90 move 20 centimeters }}
            environment yard has {{ r{first} r{second} }} robots with {{ a b }} moves"""
        scripts.append(Stage(command, tmp_path / target, program).build(target))
    trace = tmp_path / "trace"
    with world.simulator("--trace", str(trace)) as simulator, onlooker(spare):
        running = [start(script) for script in scripts]
        for process in running:
            finish(process)
        interrupt(simulator)
        simulator.wait()
    found = ends(trace)
    for index in (0, 2):
        assert_near(found[f"r{index}"], (0.3, -index, 45.0))
        assert_near(found[f"r{index + 1}"], (0.0, -index - 1.2, -90.0))


def test_the_client_is_found_beside_the_program(
    command: str, tmp_path: pathlib.Path
) -> None:
    program = PROGRAM.format(23000, 23001, actions="move 5 centimeters")
    stage = Stage(command, tmp_path / "stage", program)
    # Its name in V-REP 3.
    shutil.copy(HERE / "sim.py", stage.folder / "vrep.py")
    done = subprocess.run(
        [command, "run", stage.program, "--environment", "yard", "--target", "vrep"],
        env={key: value for key, value in os.environ.items() if key != "PYTHONPATH"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
