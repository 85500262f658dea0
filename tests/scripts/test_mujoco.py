"""Programs drive in MuJoCo, where wheels roll by friction alone: `run --engine mujoco`, and scripts with `--mujoco`."""

from __future__ import annotations

import importlib
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import pytest
from program_runs import Row, command_line, lines, offsets

pytest.importorskip(
    "mujoco", reason="MuJoCo's wheel is not installed: tests/requirements.txt"
)

ROOT = pathlib.Path(__file__).parents[2]
POSITION, HEADING = 0.02, 1.5  # m and degrees: the aim
WHEELS = ("lf", "lr", "rf", "rr")
RADIUS = 0.05  # m
PUSHES = (-1.0, 1.0, 1.0, -1.0)  # to the left, as a share of that ahead
TURNING = (-1.0, -1.0, 1.0, 1.0)
TRACK, WHEELBASE = 0.3, 0.25  # m

YARD = """
wheel l with radius 5
wheel r with radius 5
sensor front
robot rover type tw with port 19999 has { l r } wheels with sensors { front }
movement go of rover { move until { front } detect within 50 centimeters }
environment yard has { rover } robots with { go } moves
"""


def run(command: str, folder: pathlib.Path, *options: str) -> list[Row]:
    """Runs a program in MuJoCo with this Python; its events."""
    done = command_line(
        command,
        folder,
        *("run", "program.pyr", "--engine", "mujoco", "--python", sys.executable),
        *("--no-progress", "--events", "-", *options),
    )
    events = lines(done.stdout)
    assert done.returncode == 0, (done.stderr, events[-3:])
    return events


def plan(command: str, folder: pathlib.Path, *options: str) -> Row:
    done = command_line(command, folder, "plan", "program.pyr", "--json", *options)
    assert done.returncode == 0, done.stderr
    planned: Row = json.loads(done.stdout)[0]
    return planned


def poses(events: list[Row], robot: str) -> list[Row]:
    return [
        it for it in events if it["event"] == "action-ended" and it["robot"] == robot
    ]


@pytest.mark.parametrize(
    ("program", "scene", "actions"),
    [
        ("tests/paper/table2_two_wheels.pyr", None, 5),
        # Four robots of all three types.
        ("examples/crossing.pyr", "examples/crossing.scene.toml", 20),
    ],
)
def test_every_action_ends_within_the_aim(
    command: str,
    tmp_path: pathlib.Path,
    program: str,
    scene: str | None,
    actions: int,
) -> None:
    shutil.copy(ROOT / program, tmp_path / "program.pyr")
    if scene:
        shutil.copy(ROOT / scene, tmp_path)
    planned = plan(command, tmp_path)
    found = offsets(planned, run(command, tmp_path))
    assert len(found) == actions
    assert max(away for away, _ in found) <= POSITION, found
    assert max(turned for _, turned in found) <= HEADING, found


def write(folder: pathlib.Path, text: str, scene: str = "") -> None:
    (folder / "program.pyr").write_text(text, encoding="utf-8")
    (folder / "yard.scene.toml").write_text(scene, encoding="utf-8")


WALL = "[[wall]]\nfrom = [2, -1]\nto = [2, 1]\n"
WIDE = "[robots.rover.sensors.front]\ncone = 90\n"
CRATE = "[[box]]\nat = [1, 0.35]\nsize = [0.2, 0.2]\nheight = {height}\n"
PASSER = "[[cylinder]]\nradius = 0.1\npath = [[0, 1, 5], [4, 1, 0], [8, 1, -5]]\n"


@pytest.mark.parametrize(
    ("scene", "place"),
    [
        # The sensor is 15 cm ahead of the middle, the wall's front 5 cm before its own.
        (WALL, 1.95 - 0.15 - 0.5),
        # It looks over what is low.
        (WIDE + WALL + CRATE.format(height=0.05), 1.95 - 0.15 - 0.5),
        (WIDE + WALL + CRATE.format(height=0.2), 0.9 - 0.15 - math.sqrt(0.1875)),
    ],
)
def test_sensors_see_what_is_high_enough(
    command: str, tmp_path: pathlib.Path, scene: str, place: float
) -> None:
    write(tmp_path, YARD, scene)
    [stopped] = poses(run(command, tmp_path), "rover")
    assert stopped["x"] == pytest.approx(place, abs=0.03)


def test_obstacles_move(command: str, tmp_path: pathlib.Path) -> None:
    write(tmp_path, YARD, WALL + PASSER)
    [stopped] = poses(run(command, tmp_path), "rover")
    assert 3.0 < stopped["t"] < 5.0
    assert stopped["x"] < 0.5


def test_runs_are_the_same_by_their_seed(command: str, tmp_path: pathlib.Path) -> None:
    write(
        tmp_path,
        YARD,
        "[noise]\nsensor = 0.02\n[[box]]\nat = [1.2, 0]\nsize = [0.2, 1]\n",
    )
    traces = []
    for seed in ("3", "3", "4"):
        run(command, tmp_path, "--seed", seed, "--trace", "trace")
        traces.append((tmp_path / "trace").read_text(encoding="utf-8"))
    assert traces[0] == traces[1] != traces[2]


def test_a_robot_in_front_of_a_wall_fails(command: str, tmp_path: pathlib.Path) -> None:
    write(
        tmp_path,
        YARD.replace("until { front } detect within 50 centimeters", "1 meters"),
        "[[wall]]\nfrom = [0.5, -1]\nto = [0.5, 1]\n",
    )
    done = command_line(
        command,
        tmp_path,
        *("run", "program.pyr", "--engine", "mujoco", "--no-progress"),
        *("--python", sys.executable),
    )
    assert done.returncode == 1, done.stderr
    assert "no progress for 5 s" in done.stderr


def test_a_script_that_is_started_by_hand_drives_in_a_world(
    command: str, tmp_path: pathlib.Path
) -> None:
    write(tmp_path, YARD, "[[wall]]\nfrom = [1, -1]\nto = [1, 1]\n")
    plan(command, tmp_path, "--mjcf", "world.xml")
    # It is written again, and nothing that is no world is replaced.
    plan(command, tmp_path, "--mjcf", "world.xml")
    refused = command_line(
        command, tmp_path, "plan", "program.pyr", "--mjcf", "program.pyr"
    )
    assert refused.returncode == 2, refused.stdout
    assert command_line(command, tmp_path, "build", "program.pyr").returncode == 0

    def drive(world: str, *options: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "yard.py", "--mujoco", world, *options],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
            env={"PATH": ""},
        )

    done = drive("world.xml")
    assert (done.returncode, done.stderr) == (0, "")
    assert not (tmp_path / "MUJOCO_LOG.TXT").exists()
    for world, reason in (
        ("missing.xml", "MuJoCo cannot read missing.xml"),
        ("program.pyr", "MuJoCo cannot read program.pyr"),
    ):
        done = drive(world)
        assert done.returncode == 2, done.stdout
        assert reason in done.stderr
    text = (tmp_path / "world.xml").read_text(encoding="utf-8")
    (tmp_path / "other.xml").write_text(
        text.replace("rover", "scout"), encoding="utf-8"
    )
    done = drive("other.xml")
    assert done.returncode == 2, done.stdout
    assert "robot rover: other.xml lacks it" in done.stderr
    if sys.platform.startswith("linux"):
        done = drive("world.xml", "--view")
        assert done.returncode == 2, done.stdout
        assert "there is no display" in done.stderr


def standing(
    command: str, folder: pathlib.Path, drive: str, scene: str = ""
) -> tuple[Any, Any]:
    """A world with a robot on four wheels, and the robot."""
    kind = "wheelH" if drive == "fwh" else "wheel"
    wheels = "\n".join(f"{kind} {name} with radius 5" for name in WHEELS)
    text = (
        f"{wheels}\nrobot rover type {drive} with port 1 has {{ {' '.join(WHEELS)} }} wheels\n"
        "movement go of rover { move 1 meters }\n"
        "environment yard has { rover } robots with { go } moves\n"
    )
    write(folder, text, scene)
    plan(command, folder, "--mjcf", "world.xml")
    engine = importlib.import_module("pydslrep_runtime.mujoco_engine")
    backend = importlib.import_module("pydslrep_runtime.backend")
    world = engine.MuJoCo(folder / "world.xml")
    spec = backend.RobotSpec("rover", "", 1, dict.fromkeys(WHEELS, RADIUS))
    robot = world.connect(spec)
    world.start()
    return world, robot


def test_the_whole_planned_path_is_in_view(
    command: str, tmp_path: pathlib.Path
) -> None:
    condition = "until { front } detect within 50 centimeters"
    write(tmp_path, YARD.replace(condition, "5 meters"))
    plan(command, tmp_path, "--mjcf", "world.xml")
    engine = importlib.import_module("pydslrep_runtime.mujoco_engine")
    view = engine.MuJoCo(tmp_path / "world.xml").model.stat
    assert list(view.center) == pytest.approx([2.5, 0.0, 0.0], abs=0.01)
    assert view.extent > 5.0


def roll(
    world: Any, robot: Any, speed: float, shares: tuple[float, ...], seconds: float
) -> None:
    """Open loop: control would make up for what is wrong."""
    for _ in range(round(seconds / world.time_step)):
        robot.set_wheel_rates([share * speed / RADIUS for share in shares])
        world.advance()


def test_rollers_carry_a_robot_to_its_side(
    command: str, tmp_path: pathlib.Path
) -> None:
    world, robot = standing(command, tmp_path, "fwh")
    start, seconds, speed = robot.pose(), 2.0, 0.2
    # Rollers of one wheel must not touch each other: each wheel stands on one or two.
    assert len(WHEELS) <= world.data.ncon <= 2 * len(WHEELS)
    roll(world, robot, speed, PUSHES, seconds)
    moved = robot.pose().relative_to(start)
    ramp = 0.2  # s
    assert moved.y == pytest.approx(speed * (seconds - ramp / 2.0), rel=0.06)
    assert abs(moved.x) < 0.02
    assert abs(math.degrees(moved.theta)) < 2.0


@pytest.mark.parametrize("friction", [0.3, 0.8])
@pytest.mark.parametrize("speed", [0.05, 0.2, 0.5])
def test_wheels_scrub_as_plans_have_it(
    command: str, tmp_path: pathlib.Path, friction: float, speed: float
) -> None:
    """Sideways sliding must not make a robot hop; then friction and geometry decide how much it turns."""
    scene = f"[world]\nfriction = {friction}\n"
    world, robot = standing(command, tmp_path, "fw", scene)
    roll(world, robot, speed, TURNING, 1.0)
    before, seconds = robot.pose(), 1.0
    roll(world, robot, speed, TURNING, seconds)
    turned = math.remainder(robot.pose().theta - before.theta, math.tau) / seconds
    rims = sum(abs(float(rate)) for rate in world.data.qvel[6:10]) / 4.0 * RADIUS
    factor = 1.0 + (WHEELBASE / TRACK) ** 2
    assert turned == pytest.approx(2.0 * rims / TRACK / factor, rel=0.03)


@pytest.fixture
def display(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A screen in memory, drawn on by the processor."""
    server = shutil.which("Xvfb")
    if server is None:
        pytest.skip("Xvfb is not installed")
    reader, writer = os.pipe()
    with subprocess.Popen(
        [server, "-displayfd", str(writer), "-screen", "0", "640x480x24"],
        pass_fds=[writer],
        stderr=subprocess.DEVNULL,
    ) as running:
        os.close(writer)
        with os.fdopen(reader, encoding="ascii") as number:
            monkeypatch.setenv("DISPLAY", f":{number.readline().strip()}")
        monkeypatch.setenv("LIBGL_ALWAYS_SOFTWARE", "1")
        yield
        running.terminate()


@pytest.mark.usefixtures("display")
def test_a_window_closes_when_robots_have_arrived(
    command: str, tmp_path: pathlib.Path
) -> None:
    """Several times: MuJoCo's thread that draws must have ended before Python ends."""
    write(
        tmp_path,
        YARD.replace("until { front } detect within 50 centimeters", "10 centimeters"),
    )
    for _ in range(4):
        events = run(command, tmp_path, "--view", "--speed", "20")
        assert poses(events, "rover")[0]["x"] == pytest.approx(0.1, abs=0.001)


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (("--view",), "--view is for --engine mujoco"),
        (("--engine", "mujoco", "--target", "vrep"), "leave one of them out"),
        (("--engine", "mujoco", "--host", "localhost"), "cannot be used with"),
    ],
)
def test_options_that_contradict_each_other_are_refused(
    command: str, tmp_path: pathlib.Path, options: tuple[str, ...], reason: str
) -> None:
    write(tmp_path, YARD)
    done = command_line(command, tmp_path, "run", "program.pyr", *options)
    assert done.returncode == 2, done.stdout
    assert reason in done.stderr
