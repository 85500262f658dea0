"""Whole scripts, from the command line to the exit code, with the fake simulator."""

import json
import math
import signal
import subprocess
import sys
import types
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from driving import errors, joints
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_runtime import interrupts
from pydslrep_runtime.settings import CLIENT_TIMEOUT
from pydslrep_runtime.version import __version__

PACKAGE = Path(__file__).parents[1]

THREE_SIDES = '''
"""Drives environment area_1."""

from pydslrep_runtime import TwoWheelRobot, movement, run

robot_1 = TwoWheelRobot(
    "robot_1", port=19999, left=("wheelL", 0.045), right=("wheelR", 0.045)
)


@movement(name="around the corner")
async def mov_1() -> None:
    await robot_1.move(4.0)
    await robot_1.turn(-90)
    await robot_1.move(4.0)
    await robot_1.turn(-90)
    await robot_1.move(4.0)


async def area_1() -> None:
    await mov_1()


if __name__ == "__main__":
    run(area_1, robots=[robot_1], host="127.0.0.1")
'''

TWO_ROBOTS = """
from pydslrep_runtime import MecanumRobot, TwoWheelRobot, run

wheels = {"left": ("wheelL", 0.045), "right": ("wheelR", 0.045)}
first = TwoWheelRobot("first", port=19997, **wheels)
second = TwoWheelRobot("second", port=19998, **wheels)


async def main() -> None:
    await first.move(0.1)
    await second.move(0.1)


if __name__ == "__main__":
    run(main, robots=[first, second], name="a yard")
"""

Run = Callable[..., int]


@pytest.fixture
def handlers() -> Iterator[None]:
    """Puts back what handled signals before: a run that has ended ignores them."""
    before = {number: signal.getsignal(number) for number in interrupts.SIGNALS}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.fixture(name="run")
def fixture_run(monkeypatch: pytest.MonkeyPatch, handlers: None) -> Run:
    """Runs a script in a world; returns its exit code."""

    def run(script: str, world: FakeWorld, *arguments: str) -> int:
        world.serve(monkeypatch)
        monkeypatch.setattr(sys, "argv", ["script.py", *arguments])
        module = types.ModuleType("__main__")
        with pytest.raises(SystemExit) as end:
            exec(compile(script, "script.py", "exec"), module.__dict__)
        assert isinstance(end.value.code, int)
        return end.value.code

    return run


def one_robot(**options: float) -> FakeWorld:
    """The world of `THREE_SIDES`."""
    return FakeWorld(FakeRobot("robot_1", joints("two-wheel"), **options))  # type: ignore[arg-type]


def test_three_sides_of_a_square(
    run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    world = one_robot()
    trace = tmp_path / "trace.jsonl"
    assert run(THREE_SIDES, world, "--trace", str(trace)) == 0
    distance, angle = errors(world.robots["robot_1"], 0.0, -4.0, math.pi)
    assert distance < 0.001
    assert angle < 0.1
    rows = [json.loads(line) for line in trace.read_text(encoding="utf-8").splitlines()]
    assert [row["t"] for row in rows] == pytest.approx(
        [0.05 * i for i in range(len(rows))]
    )
    assert (rows[0]["x"], rows[0]["wheels"]) == (0.0, [0.0, 0.0]), "before any step"
    assert {row["movement"] for row in rows} == {"around the corner"}
    actions = list(dict.fromkeys(row["action"] for row in rows))
    assert actions == [
        "1: move 4 m",
        "2: turn right 90 deg",
        "3: move 4 m",
        "4: turn right 90 deg",
        "5: move 4 m",
    ]
    out = capsys.readouterr().out.splitlines()
    assert out[0].endswith(
        "robot_1  around the corner  1: move 4 m  at x 4.00 m, y 0.00 m, 0 deg"
    )
    # at 9 cm/s, with a ramp at either end
    assert float(out[0].split()[0]) == pytest.approx(4.0 / 0.09 + 0.2, abs=0.3)
    assert len(out) == 5


def test_a_trace_does_not_replace_other_files(
    run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program = tmp_path / "square.pyr"
    program.write_text("wheel a with radius 4\n", encoding="utf-8")
    world = one_robot()
    assert run(THREE_SIDES, world, "--trace", str(program)) == 2
    assert "square.pyr exists and is not a trace" in capsys.readouterr().err
    assert program.read_text(encoding="utf-8") == "wheel a with radius 4\n"
    assert world.robots["robot_1"].x == 0.0, "nothing was driven"


def test_actions_outside_of_a_movement_have_the_name_of_the_environment(
    run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    world = FakeWorld(*(FakeRobot(n, joints("two-wheel")) for n in ("first", "second")))
    assert run(TWO_ROBOTS, world) == 0
    assert "first  a yard  1: move 0.1 m" in capsys.readouterr().out


def test_a_blocked_robot_is_exit_code_1(
    run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(THREE_SIDES, one_robot(wall=1.0)) == 1
    assert capsys.readouterr().err.startswith(
        "error: robot robot_1, movement around the corner, action 1: move 4 m: no progress"
    )


def test_a_missing_robot_is_exit_code_2(
    run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    world = FakeWorld(FakeRobot("robot_7", joints("two-wheel")))
    assert run(THREE_SIDES, world, "--host", "10.0.0.1", "--port", "23000") == 2
    error = capsys.readouterr().err
    assert "the scene at 10.0.0.1:23000 has no robot /robot_1; " in error
    assert "wheelL" not in error, "it would be there if the robot were"
    assert not world.running


def test_interruption_is_exit_code_130(run: Run) -> None:
    world = one_robot()

    def interrupt() -> None:
        if world.steps == 10:
            raise KeyboardInterrupt

    world.before_step = interrupt
    assert run(THREE_SIDES, world) == 130
    assert not world.running
    assert all(joint.target == 0.0 for joint in world.robots["robot_1"].joints)


TURNS_WHEELS = THREE_SIDES.replace(
    "    await mov_1()\n", "    await robot_1.step([2.0, 2.0])\n    {then}\n"
)


@pytest.mark.parametrize(
    ("then", "code"),
    [
        ("return", 0),
        ("raise OSError('no')", 2),
        ("raise KeyboardInterrupt", 130),
        ("1 / 0", None),
    ],
)
def test_wheels_that_turn_outside_of_actions_stop_at_the_end(
    run: Run, then: str, code: int | None
) -> None:
    world = one_robot()
    script = TURNS_WHEELS.replace("{then}", then)
    if code is None:
        with pytest.raises(ZeroDivisionError):
            run(script, world)
    else:
        assert run(script, world) == code
    wheels = world.robots["robot_1"].joints
    assert [wheel.rate for wheel in wheels] == pytest.approx([2.0, 2.0])
    assert [wheel.target for wheel in wheels] == [0.0, 0.0]


def test_wheels_that_another_client_left_turning_stop_before_the_first_step(
    run: Run,
) -> None:
    world = one_robot()
    for wheel in world.robots["robot_1"].joints:
        wheel.target = 3.0
    script = THREE_SIDES.replace(
        "    await mov_1()\n", "    await asyncio.sleep(1.0)\n"
    )
    assert run(f"import asyncio\n{script}", world) == 0
    assert world.steps >= 20
    assert world.robots["robot_1"].x == 0.0


def test_time_is_held_once_by_a_client_that_is_not_forgotten(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After a step that took long it asks again; the fake simulator refuses a second level of stepping mode."""
    world, now = one_robot(), [0.0]
    monkeypatch.setattr("time.monotonic", lambda: now[0])

    def before_step() -> None:
        if world.steps == 10:
            now[0] += CLIENT_TIMEOUT
        assert [*world.holders.values()] == [1]

    world.before_step = before_step
    assert run(THREE_SIDES, world) == 0
    assert world.steps > 100
    assert [*world.holders.values()] == [0]


def test_an_unwritable_trace_is_exit_code_2(run: Run, tmp_path: Path) -> None:
    assert run(THREE_SIDES, one_robot(), "--trace", str(tmp_path / "no" / "trace")) == 2


@pytest.mark.usefixtures("handlers")
def test_an_error_in_the_script_itself_has_its_traceback(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = one_robot()
    world.serve(monkeypatch)
    monkeypatch.setattr(sys, "argv", ["script.py"])
    script = THREE_SIDES.replace("    await robot_1.turn(-90)\n", "    1 / 0\n", 1)
    with pytest.raises(ZeroDivisionError):
        exec(script, types.ModuleType("__main__").__dict__)
    assert not world.running
    assert all(joint.target == 0.0 for joint in world.robots["robot_1"].joints)


def bare(*arguments: str, version: str = "") -> tuple[int, str]:
    """The exit code and output of a script on a Python without packages, optionally an older one."""
    old = f"sys.version_info = {version}; " if version else ""
    path = f"sys.path.insert(0, {str(PACKAGE)!r}); "
    program = f"import sys; {path}{old}exec({THREE_SIDES!r})"
    done = subprocess.run(
        [sys.executable, "-I", "-S", "-c", program, *arguments],
        capture_output=True,
        text=True,
        check=False,
    )
    return done.returncode, done.stdout + done.stderr


def test_a_missing_library_is_reported() -> None:
    assert bare() == (
        2,
        "error: Python module zmq is missing; install it with "
        "`python3 -m pip install coppeliasim-zmqremoteapi-client cbor2`\n",
    )


def test_an_old_python_is_reported_first() -> None:
    expected = (2, "error: pydslrep_runtime needs Python 3.11 or later\n")
    assert bare(version="(3, 9, 2)") == expected


@pytest.mark.parametrize("version", [__version__, "0.0.1", None])
def test_a_script_for_another_version_says_so(
    run: Run, capsys: pytest.CaptureFixture[str], version: str | None
) -> None:
    script = THREE_SIDES.replace('host="127.0.0.1"', f"version={version!r}")
    assert run(script, one_robot()) == 0
    warning = (
        f"warning: this script was generated for pydslrep_runtime 0.0.1, but runs with "
        f"{__version__}: generate it again with `pydslrep build`\n"
    )
    assert capsys.readouterr().err == (warning if version == "0.0.1" else "")


def test_the_package_says_its_version() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "pydslrep_runtime", "--version"],
        cwd=PACKAGE,
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == f"pydslrep_runtime {__version__}\n"


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ("--port=0", "'0' is not a port"),
        ("--port=65536", "'65536' is not a port"),
        ("--port=x", "'x' is not a port"),
        ("--port=-1", "'-1' is not a port"),
        ("--port=1.5", "'1.5' is not a port"),
        ("--port=\u00b2", "is not a port"),
        ("--port=robot_1=", "'' is not a port"),
        ("--port=robot_9=5", "no robot robot_9; the robots are robot_1"),
        ("--robot=my_robot", "'my_robot' is not of the form MODULE:CLASS"),
        ("--robot=my_robot:", "'my_robot:' is not of the form MODULE:CLASS"),
        ("--robot=other=a:B", "no robot other; the robots are robot_1"),
    ],
)
def test_impossible_options_are_usage_errors(
    run: Run, option: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(THREE_SIDES, FakeWorld(), option) == 2
    assert message in capsys.readouterr().err


def test_ports_of_all_and_of_one(run: Run) -> None:
    world = FakeWorld(*(FakeRobot(n, joints("two-wheel")) for n in ("first", "second")))
    assert run(TWO_ROBOTS, world, "--port=second=5", "--port=23000") == 0
    assert [client.uuid for client in world.clients()] == [
        "127.0.0.1:23000/0",
        "127.0.0.1:5/1",
    ]
    assert world.calls["step"] == world.steps


def test_help_names_the_options(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(THREE_SIDES, FakeWorld(), "--help") == 0
    text = capsys.readouterr().out
    for word in (
        "--host",
        "--port",
        "--robot",
        "--trace",
        "--events",
        "--realtime",
        "area_1_map.json",
    ):
        assert word in text
    assert "Drives environment area_1." in text


def test_realtime_waits_for_the_clock(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    slept: list[float] = []
    now = [0.0]

    def sleep(seconds: float) -> None:
        slept.append(seconds)
        now[0] += seconds

    monkeypatch.setattr("time.sleep", sleep)
    monkeypatch.setattr("time.monotonic", lambda: now[0])
    world = one_robot()
    assert run(THREE_SIDES, world, "--realtime") == 0
    assert sum(slept) == pytest.approx(world.steps * world.dt)


def test_a_robot_acts_within_run_only() -> None:
    from pydslrep_runtime import TwoWheelRobot

    rover = TwoWheelRobot("rover", port=1, left=("a", 0.1), right=("b", 0.1))
    with pytest.raises(
        RuntimeError, match=r"robot rover acts within pydslrep_runtime\.run"
    ):
        rover.pose()
    with pytest.raises(ValueError, match="robot rover lists a wheel twice"):
        TwoWheelRobot("rover", port=1, left=("a", 0.1), right=("a", 0.1))
