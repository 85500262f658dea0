"""What scripts say about scenes of a physics engine: falls, crawling robots, runs that go on, other programs."""

import json
from pathlib import Path

import pytest
from driving import declared, drive_all, drive_alone, joints
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_runtime import MovementError, Robot, SetupError, coppeliasim, movement
from pydslrep_runtime.coppeliasim import CoppeliaSim
from pydslrep_runtime.errors import SimulatorError


async def move_a_metre(robot: Robot) -> None:
    await robot.move(1.0)


def two_wheels(**options: float) -> FakeRobot:
    return FakeRobot("r", joints("two-wheel"), **options)  # type: ignore[arg-type]


def drive(world: FakeWorld, monkeypatch: pytest.MonkeyPatch, *arguments: str) -> None:
    """Moves the robot by a metre."""

    @movement(name="m")
    async def main(robots: dict[str, Robot]) -> None:
        await move_a_metre(robots["r"])

    drive_all(world, monkeypatch, ("two-wheel",), main, *arguments)


def test_a_robot_that_falls_off_its_floor_says_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = FakeWorld(two_wheels(edge=0.5))
    with pytest.raises(MovementError) as error:
        drive_alone(world, monkeypatch, "two-wheel", move_a_metre)
    assert str(error.value).startswith(
        "robot r, movement m, action 1: move 1 m: it has fallen off its floor: /r is 0."
    )
    assert "`pydslrep scene push` builds one" in str(error.value)
    assert world.robots["r"].height > -1.0, "it is noticed while it falls"


def test_a_robot_may_drive_down_a_ramp(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = two_wheels()
    world = FakeWorld(fake)

    def descend() -> None:
        fake.height = 0.1 - 0.8 * fake.x

    world.before_step = descend
    drive_alone(world, monkeypatch, "two-wheel", move_a_metre)
    assert fake.height < -0.6


def test_a_robot_that_has_fallen_over_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = two_wheels(wall=0.4)
    world = FakeWorld(fake)

    def tip_over() -> None:
        fake.tilt = 1.5 if fake.x > 0.3 else 0.0

    world.before_step = tip_over
    with pytest.raises(MovementError, match="it has fallen over: its body is 86°"):
        drive_alone(world, monkeypatch, "two-wheel", move_a_metre)


def test_a_robot_that_crawls_says_so_once(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    drive_alone(
        FakeWorld(two_wheels(mean_slip=0.9)), monkeypatch, "two-wheel", move_a_metre
    )
    assert capsys.readouterr().err == (
        "note: robot r, movement m, action 1: move 1 m: takes more than twice as long as planned; something may brake "
        "it; `pydslrep doctor` checks the scene\n"
    )


def test_a_robot_that_drives_says_nothing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    drive_alone(FakeWorld(two_wheels()), monkeypatch, "two-wheel", move_a_metre)
    assert capsys.readouterr().err == ""


def test_a_run_in_a_running_simulation_says_where_it_starts(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    fake = two_wheels()
    world = FakeWorld(fake)
    world.running, fake.x, fake.theta = True, 1.25, 0.5
    drive(world, monkeypatch)
    said = capsys.readouterr().err
    assert (
        "the simulation is running already, at 0.00 s, and goes on: r at x 1.25 m"
        in said
    )
    assert "29 deg" in said
    assert "--restart" in said
    assert world.running, "it goes on"


def test_a_restart_puts_everything_back(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    fake = two_wheels()
    world = FakeWorld(fake)
    world.running, fake.x, fake.theta = True, 1.25, 0.5
    world.puts_back = True
    places: list[float] = []
    world.before_step = lambda: places.append(fake.x)
    drive(world, monkeypatch, "--restart")
    assert places[0] == 0.0
    assert places[-1] == pytest.approx(1.0, abs=0.01)
    assert capsys.readouterr().err == ""
    assert not world.running


def test_two_programs_on_one_robot_are_noticed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    fake = two_wheels()
    world = FakeWorld(fake)

    def disturb() -> None:
        if 0.3 < fake.x < 0.5:
            fake.joints[1].target = 1.9

    world.before_step = disturb
    drive_alone(world, monkeypatch, "two-wheel", move_a_metre)
    said = capsys.readouterr().err
    assert said.count("another program drives robot r, too") == 1
    assert "its wheel wheelR to 1.90 rad/s" in said


def test_a_trace_begins_where_the_robot_stood(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The plan of a run starts there: in a physics engine, the first step moves a robot."""
    fake = two_wheels()
    world = FakeWorld(fake)

    def turn_a_little() -> None:
        if world.steps == 0:
            fake.theta += 0.007

    world.before_step = turn_a_little
    trace = tmp_path / "trace.jsonl"
    drive(world, monkeypatch, "--trace", str(trace))
    rows = [json.loads(line) for line in trace.read_text().splitlines()]
    assert (rows[0]["t"], rows[0]["theta"], rows[0]["wheels"]) == (0.0, 0.0, [0, 0])
    assert rows[1]["theta"] > 0.006
    assert len([row for row in rows if row["t"] == 0.0]) == 1


@pytest.mark.parametrize("listens", [True, False])
def test_a_simulator_that_is_paused_is_named(
    monkeypatch: pytest.MonkeyPatch, *, listens: bool
) -> None:
    """CoppeliaSim 4.6 accepts connections while it is paused, and answers nothing."""

    def refuse(_host: str, _port: int) -> None:
        raise SimulatorError("no reply from 127.0.0.1:23000 for 5 s")

    monkeypatch.setattr(coppeliasim, "Connection", refuse)
    monkeypatch.setattr(coppeliasim, "accepts_connections", lambda _address: listens)
    spec = declared(two_wheels(), "two-wheel").spec("127.0.0.1", 23000)
    words = "If the simulation is paused" if listens else "Is CoppeliaSim running there"
    with pytest.raises(SetupError, match="(?i)" + words):
        CoppeliaSim("127.0.0.1", realtime=False).connect(spec)
