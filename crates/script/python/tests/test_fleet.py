"""Several robots: lockstep, failure of one, the order of movements."""

import io
import json
from typing import Any

import pytest
from driving import connected, errors, joints, model
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_parts import coppeliasim
from pydslrep_parts.coppeliasim import Body
from pydslrep_parts.errors import MovementError
from pydslrep_parts.fleet import Fleet
from pydslrep_parts.movement import Movement, movement
from pydslrep_parts.robot import Robot
from pydslrep_parts.trace_file import Trace

DRIVES = ("two-wheel", "four-wheel", "mecanum", "two-wheel")


def four_robots() -> FakeWorld:
    """Robots a to d, a metre apart."""
    return FakeWorld(
        *(
            FakeRobot(name, joints(drive), y=-float(index))
            for index, (name, drive) in enumerate(zip("abcd", DRIVES, strict=True))
        )
    )


def ways(distances: dict[str, float]) -> list[Movement]:
    """A movement straight on for each robot."""

    def way(distance: float) -> Any:
        return lambda robot: robot.move(distance)

    return [
        Movement(f"{name}_moves", name, way(distance))
        for name, distance in distances.items()
    ]


def test_movement_declares_a_function() -> None:
    @movement("m", of="r")
    def actions(robot: Robot) -> None:
        robot.move(1.0)

    assert (actions.name, actions.robot) == ("m", "r")


def test_robots_move_in_parallel_and_arrive(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = four_robots()
    distances = {"a": 1.0, "b": 0.2, "c": -0.7, "d": 0.9}
    with connected(world, monkeypatch, *DRIVES) as fleet:
        fleet.run_together(*ways(distances))
        assert world.steps * world.dt == pytest.approx(1.0 / 0.09 + 0.5, abs=0.5)
        assert [level for level in world.holders.values() if level] == [1], (
            "only one robot still steps"
        )
    for index, (name, distance) in enumerate(distances.items()):
        assert errors(world.robots[name], distance, -float(index), 0.0)[0] < 0.001


def test_no_time_passes_between_movements(monkeypatch: pytest.MonkeyPatch) -> None:
    world = four_robots()
    seen = []
    with connected(world, monkeypatch, *DRIVES) as fleet:
        for name in ("b", "a", "d"):
            fleet.run(*ways({name: 0.1}))
            seen.append(sum(level > 0 for level in world.holders.values()))
        steps = world.steps
        fleet.run_together(*ways({"c": 0.1, "d": 0.1}))
        fleet.run(*ways({"a": 0.05}))
    assert seen == [1, 1, 1]
    assert world.steps > steps


def run_traced(world: FakeWorld, monkeypatch: pytest.MonkeyPatch) -> str:
    """Runs two groups and returns the trace."""
    monkeypatch.setattr(coppeliasim, "RemoteAPIClient", world.factory())
    file = io.StringIO()
    fleet = Fleet(Trace(file))
    for robot, drive in zip(world.robots.values(), DRIVES, strict=True):
        fleet.connect(model(robot, drive), "h", 1, realtime=False)
    fleet.start()
    fleet.run_together(*ways({"a": 0.3, "b": 0.2, "c": -0.3, "d": 0.25}))
    fleet.run_together(*ways({"d": 0.1, "b": 0.2}))
    fleet.shut_down()
    return file.getvalue()


def test_every_run_writes_the_same_trace(monkeypatch: pytest.MonkeyPatch) -> None:
    first, *others = (run_traced(four_robots(), monkeypatch) for _ in range(4))
    assert all(other == first for other in others)
    rows = [json.loads(line) for line in first.splitlines()]
    assert list(rows[0]) == [
        "t",
        "robot",
        "x",
        "y",
        "theta",
        "wheels",
        "movement",
        "action",
    ]
    assert [row["t"] for row in rows] == sorted(row["t"] for row in rows)
    assert [row["robot"] for row in rows[:4]] == ["a", "b", "c", "d"]
    last = [row for row in rows if row["robot"] == "b"][-1]
    assert last["x"] == pytest.approx(0.4, abs=0.001)
    assert last["movement"] == "b_moves"
    assert last["action"] == "1: move 0.2 m"
    assert last["wheels"] == [0.0] * 4


def test_one_failure_stops_all(monkeypatch: pytest.MonkeyPatch) -> None:
    world = four_robots()
    world.running = True
    failing = world.robots["c"]
    failing.wall = 0.2
    stopped = []
    disable_stepping = Body.disable_stepping

    def watch(body: Body) -> None:
        if body.model.name == failing.name and body._is_stepping:
            stopped.append(all(joint.target == 0.0 for joint in failing.joints))
        disable_stepping(body)

    monkeypatch.setattr(Body, "disable_stepping", watch)
    with (
        pytest.raises(
            MovementError, match="robot c, movement c_moves, action 1: move 5 m"
        ),
        connected(world, monkeypatch, *DRIVES) as fleet,
    ):
        fleet.run_together(*ways({"a": 5.0, "b": 5.0, "c": 5.0, "d": 0.1}))
    assert stopped[0], "the others continued before its wheels stopped"
    assert world.robots["a"].x < 1.0
    assert all(
        joint.target == 0.0 for robot in world.robots.values() for joint in robot.joints
    )
    assert not any(world.holders.values())


def test_an_empty_movement_delays_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    world = four_robots()
    with connected(world, monkeypatch, *DRIVES) as fleet:
        fleet.run_together(Movement("nothing", "a", lambda _: None), *ways({"b": 0.2}))
    assert world.robots["b"].x == pytest.approx(0.2, abs=0.001)
