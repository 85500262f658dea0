"""Runs generated scripts unchanged in the fake simulator, from command line to exit code."""

import json
import math
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest
from driving import errors, joints
from fake_simulator import FakeRobot, FakeWorld

SNAPSHOTS = Path(__file__).parents[2] / "snapshots"


def patched(text: str, diff: str) -> str:
    """A text with a unified diff applied."""
    lines, result, at = text.splitlines(keepends=True), "", 0
    for line in diff.splitlines(keepends=True):
        if hunk := re.match(r"@@ -(\d+)", line):
            start = int(hunk[1]) - 1
            result += "".join(lines[at:start])
            at = start
        elif line.startswith("+"):
            result += line[1:]
        else:
            assert lines[at] == line[1:], "the diff is of another text"
            result += lines[at] if line.startswith(" ") else ""
            at += 1
    return result + "".join(lines[at:])


def load(name: str) -> ModuleType:
    """The script of that name as a module: whole, or as changes of the whole one."""
    file = SNAPSHOTS / f"{name}.py"
    if file.exists():
        text = file.read_text(encoding="utf-8")
    else:
        changes = file.with_suffix(".diff").read_text(encoding="utf-8")
        text = patched((SNAPSHOTS / "area_1.py").read_text(encoding="utf-8"), changes)
    module = ModuleType(f"generated_{name}")
    sys.modules[module.__name__] = module
    exec(compile(text, file.name, "exec"), module.__dict__)
    return module


@pytest.fixture(name="run")
def fixture_run(monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    """Runs a script in a world; returns its exit code."""

    def run(name: str, world: FakeWorld, *arguments: str) -> int:
        script = load(name)
        monkeypatch.setattr(script, "RemoteAPIClient", world.factory())
        monkeypatch.setattr(sys, "argv", [f"{name}.py", *arguments])
        code = script.main(script.__doc__, script.HOST, script.ROBOTS, script.drive)
        assert isinstance(code, int)
        return code

    return run


def factory() -> FakeWorld:
    """The robots of `factory.py`, a metre apart."""
    drives = ["two-wheel", "four-wheel", "mecanum", "two-wheel"]
    return FakeWorld(
        *(
            FakeRobot(f"robot_{i + 1}", joints(drive), y=-float(i))
            for i, drive in enumerate(drives)
        )
    )


def test_three_sides_of_a_square(
    run: Callable[..., int], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    fake = FakeRobot("robot_1", joints("two-wheel"))
    trace = tmp_path / "trace.jsonl"
    assert run("area_1", FakeWorld(fake), "--trace", str(trace)) == 0
    distance, angle = errors(fake, 0.0, -4.0, math.pi)
    assert distance < 0.001
    assert angle < 0.1
    rows = [json.loads(line) for line in trace.read_text(encoding="utf-8").splitlines()]
    assert [row["t"] for row in rows] == pytest.approx(
        [0.05 * (i + 1) for i in range(len(rows))]
    )
    actions = list(dict.fromkeys(row["action"] for row in rows))
    assert actions == [
        "1: move 4 m",
        "2: turn right 90 deg",
        "3: move 4 m",
        "4: turn right 90 deg",
        "5: move 4 m",
    ]
    out = capsys.readouterr().out.splitlines()
    assert out[0].endswith("robot_1  mov_1  1: move 4 m  at x 4.00 m, y 0.00 m, 0 deg")
    # at 9 cm/s, with a ramp at either end
    assert float(out[0].split()[0]) == pytest.approx(4.0 / 0.09 + 0.2, abs=0.3)
    assert len(out) == 5


def test_four_robots_at_once(run: Callable[..., int]) -> None:
    world = factory()
    assert run("factory", world) == 0
    root = math.sqrt(0.5)
    thirty = math.radians(-30.5)
    ends = {
        "robot_1": (1.0, 0.0, math.radians(-90.0)),
        "robot_2": (0.7 * root, -1.0 + 0.7 * root, math.radians(45.0)),
        "robot_3": (-0.95, -2.0 - 0.15 * math.sqrt(3.0), math.radians(-120.0)),
        "robot_4": (0.6 * math.cos(thirty), -3.0 + 0.6 * math.sin(thirty), thirty),
    }
    for name, end in ends.items():
        distance, angle = errors(world.robots[name], *end)
        assert distance < 0.001, name
        assert angle < 0.1, name


def test_turning_until_the_way_is_free(run: Callable[..., int]) -> None:
    def wall_ahead(robot: FakeRobot) -> bool:
        return robot.x > 3.0 and math.cos(robot.theta) > 0.5

    sensors = {"fSensor": wall_ahead, "rSensor": lambda _: False}
    fake = FakeRobot("robot_1", joints("two-wheel"), sensors=sensors)
    assert run("sensors", FakeWorld(fake)) == 0
    assert -67.0 < math.degrees(fake.theta) < -60.0


def test_a_blocked_robot_is_exit_code_1(
    run: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    fake = FakeRobot("robot_1", joints("two-wheel"), wall=1.0)
    assert run("area_1", FakeWorld(fake)) == 1
    error = capsys.readouterr().err
    assert error.startswith(
        "error: robot robot_1, movement mov_1, action 1: move 4 m: no progress"
    )


def test_a_missing_robot_is_exit_code_2(
    run: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    world = FakeWorld(FakeRobot("robot_7", joints("two-wheel")))
    assert run("area_1", world, "--host", "10.0.0.1", "--port", "23000") == 2
    error = capsys.readouterr().err
    assert "the scene at 10.0.0.1:23000 has no robot /robot_1, " in error
    assert "/robot_1/wheelL or /wheelL_robot_1" in error
    assert not world.running


def test_interruption_is_exit_code_130(run: Callable[..., int]) -> None:
    world = FakeWorld(FakeRobot("robot_1", joints("two-wheel")))

    def interrupt() -> None:
        if world.steps == 10:
            raise KeyboardInterrupt

    world.before_step = interrupt
    assert run("area_1", world) == 130
    assert not world.running
    assert all(joint.target == 0.0 for joint in world.robots["robot_1"].joints)


def bare(name: str, version: str = "") -> tuple[int, str]:
    """The exit code and output of a script on a Python without packages, optionally an older one."""
    old = f"sys.version_info = {version}; " if version else ""
    path = str(SNAPSHOTS / f"{name}.py")
    done = subprocess.run(
        [
            sys.executable,
            "-I",
            "-S",
            "-c",
            f"import runpy, sys; {old}runpy.run_path({path!r})",
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    return done.returncode, done.stdout + done.stderr


def test_a_missing_library_is_reported() -> None:
    assert bare("area_1") == (
        2,
        "error: Python module zmq is missing; install it with "
        "`python3 -m pip install coppeliasim-zmqremoteapi-client cbor2`\n",
    )


@pytest.mark.parametrize("name", ["area_1", "area_1_vrep"])
def test_an_old_python_is_reported_first(name: str) -> None:
    expected = (2, "error: this script needs Python 3.11 or later\n")
    assert bare(name, version="(3, 9, 2)") == expected


def test_an_unwritable_trace_is_exit_code_2(
    run: Callable[..., int], tmp_path: Path
) -> None:
    world = FakeWorld(FakeRobot("robot_1", joints("two-wheel")))
    assert run("area_1", world, "--trace", str(tmp_path / "no" / "trace")) == 2


@pytest.mark.parametrize(
    ("port", "message"),
    [
        ("0", "'0' is not a port"),
        ("65536", "'65536' is not a port"),
        ("x", "'x' is not a port"),
        ("-1", "'-1' is not a port"),
        ("1.5", "'1.5' is not a port"),
        ("\u00b2", "is not a port"),
        ("robot_1=", "'' is not a port"),
        ("robot_9=5", "no robot robot_9; the robots are robot_1"),
    ],
)
def test_impossible_ports_are_usage_errors(
    run: Callable[..., int],
    port: str,
    message: str,
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(SystemExit) as stop:
        run("area_1", FakeWorld(), f"--port={port}")
    assert stop.value.code == 2
    assert message in capsys.readouterr().err


def test_ports_of_all_and_of_one(monkeypatch: pytest.MonkeyPatch) -> None:
    script = load("factory")
    monkeypatch.setattr(sys, "argv", ["factory.py", "--port=robot_2=5", "--port=23000"])
    options = script.parse_arguments(None, script.HOST, script.ROBOTS)
    assert options.ports == {
        "robot_1": 23000,
        "robot_2": 5,
        "robot_3": 23000,
        "robot_4": 23000,
    }
    assert options.host == "127.0.0.1"


def test_help_names_the_options(
    run: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as stop:
        run("area_1", FakeWorld(), "--help")
    assert stop.value.code == 0
    text = capsys.readouterr().out
    for option in (
        "--host",
        "--port",
        "--trace",
        "--realtime",
        "Drives environment area_1",
    ):
        assert option in text


def test_realtime_waits_for_the_clock(
    run: Callable[..., int], monkeypatch: pytest.MonkeyPatch
) -> None:
    slept: list[float] = []
    now = [0.0]

    def sleep(seconds: float) -> None:
        slept.append(seconds)
        now[0] += seconds

    monkeypatch.setattr("time.sleep", sleep)
    monkeypatch.setattr("time.monotonic", lambda: now[0])
    world = FakeWorld(FakeRobot("robot_1", joints("two-wheel")))
    assert run("area_1", world, "--realtime") == 0
    assert sum(slept) == pytest.approx(world.steps * world.dt)
