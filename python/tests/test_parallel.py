"""Several robots: lockstep, failure of one, the order of movements, random interleavings."""

import asyncio
import json
import math
from collections.abc import Coroutine
from pathlib import Path
from typing import Any

import pytest
from driving import drive_all, errors, joints
from fake_simulator import FakeRobot, FakeWorld
from hypothesis import given, settings
from hypothesis import strategies as st
from pydslrep_runtime import MovementError, Robot, movement, parallel

DRIVES = ("two-wheel", "four-wheel", "mecanum", "two-wheel")
Robots = dict[str, Robot]


def four_robots() -> FakeWorld:
    """Robots a to d, a metre apart."""
    return FakeWorld(
        *(
            FakeRobot(name, joints(drive), y=-float(index))
            for index, (name, drive) in enumerate(zip("abcd", DRIVES, strict=True))
        )
    )


def move(robot: Robot, distance: float) -> Coroutine[Any, Any, None]:
    """A movement straight on."""
    return movement(name=f"{robot.name}_moves")(robot.move)(distance)


def together(robots: Robots, distances: dict[str, float]) -> Coroutine[Any, Any, None]:
    """Parallel movements straight on."""
    return parallel(*(move(robots[name], d) for name, d in distances.items()))


def test_robots_move_in_parallel_and_arrive(monkeypatch: pytest.MonkeyPatch) -> None:
    world = four_robots()
    distances = {"a": 1.0, "b": 0.2, "c": -0.7, "d": 0.9}
    drive_all(world, monkeypatch, DRIVES, lambda robots: together(robots, distances))
    assert world.steps * world.dt == pytest.approx(1.0 / 0.09 + 0.5, abs=0.5)
    for index, (name, distance) in enumerate(distances.items()):
        assert errors(world.robots[name], distance, -float(index), 0.0)[0] < 0.001


def test_one_connection_steps_the_simulator_for_all(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = four_robots()
    levels = set()
    world.before_step = lambda: levels.add(sum(world.holders.values()))
    drive_all(
        world,
        monkeypatch,
        DRIVES,
        lambda robots: together(robots, dict.fromkeys("abcd", 0.3)),
    )
    assert len(world.clients()) == 1, "robots on the same port share a connection"
    assert levels == {1}
    assert world.calls["step"] == world.steps
    assert not any(world.holders.values())


def test_no_time_passes_between_movements(monkeypatch: pytest.MonkeyPatch) -> None:
    world = four_robots()
    ends: list[int] = []

    async def main(robots: Robots) -> None:
        for name in ("b", "a", "d"):
            await move(robots[name], 0.1)
            ends.append(world.steps)

    drive_all(world, monkeypatch, DRIVES, main)
    first = ends[0]
    assert ends == pytest.approx([first, 2 * first, 3 * first], abs=6)
    rests = [row[0] for row in world.robots["c"].rate_history]
    assert not any(rests), "an idle robot stays where it is"


def traced(monkeypatch: pytest.MonkeyPatch, file: Path) -> str:
    """Runs two groups and returns the trace."""

    async def main(robots: Robots) -> None:
        await together(robots, {"a": 0.3, "b": 0.2, "c": -0.3, "d": 0.25})
        await together(robots, {"d": 0.1, "b": 0.2})

    drive_all(four_robots(), monkeypatch, DRIVES, main, "--trace", str(file))
    return file.read_text(encoding="utf-8")


def test_every_run_writes_the_same_trace(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    first, *others = (traced(monkeypatch, tmp_path / str(n)) for n in range(4))
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
    in_order = [
        row["robot"] for row in rows if row["movement"] in ("d_moves", "b_moves")
    ]
    assert in_order[:2] == ["b", "d"], "robots act in the order of their declaration"
    last = [row for row in rows if row["robot"] == "b"][-1]
    assert last["x"] == pytest.approx(0.4, abs=0.001)
    assert last["movement"] == "b_moves"
    assert last["action"] == "1: move 0.2 m"
    assert last["wheels"] == [0.0] * 4


def test_one_failure_stops_all(monkeypatch: pytest.MonkeyPatch) -> None:
    world = four_robots()
    world.running = True
    world.robots["c"].wall = 0.2
    with pytest.raises(
        MovementError, match="robot c, movement c_moves, action 1: move 5 m"
    ):
        drive_all(
            world,
            monkeypatch,
            DRIVES,
            lambda robots: together(robots, {"a": 5.0, "b": 5.0, "c": 5.0, "d": 0.1}),
        )
    assert world.robots["a"].x < 1.0
    assert all_at_rest(world)
    assert not any(world.holders.values())


def test_a_program_can_go_on_after_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    world = four_robots()
    world.robots["c"].wall = 0.2

    async def main(robots: Robots) -> None:
        with pytest.raises(MovementError):
            await together(robots, {"a": 5.0, "c": 5.0})
        assert all_at_rest(world), "the wheels stop before anything else happens"
        await move(robots["c"], -0.1)
        await move(robots["a"], 0.1)

    drive_all(world, monkeypatch, DRIVES, main)
    assert world.robots["c"].x == pytest.approx(0.1, abs=0.01)


def test_an_empty_movement_delays_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    world = four_robots()

    @movement
    async def nothing() -> None:
        pass

    drive_all(
        world,
        monkeypatch,
        DRIVES,
        lambda robots: parallel(nothing(), move(robots["b"], 0.2)),
    )
    assert world.robots["b"].x == pytest.approx(0.2, abs=0.001)


def test_sleeping_takes_simulation_time(monkeypatch: pytest.MonkeyPatch) -> None:
    world = four_robots()

    async def main(robots: Robots) -> None:
        await asyncio.sleep(100.0)
        assert robots["a"].time == pytest.approx(100.0, abs=0.06)
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(3.0):
                await robots["a"].move(10.0)
        assert robots["a"].time == pytest.approx(103.0, abs=0.11)

    drive_all(world, monkeypatch, DRIVES, main)
    assert all_at_rest(world)


def test_one_robot_does_one_action_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    world = four_robots()
    with pytest.raises(
        MovementError,
        match=r"robot a, movement m, action 1: move 1 m: cannot begin to turn left 90 deg",
    ):
        drive_all(
            world,
            monkeypatch,
            DRIVES,
            lambda robots: parallel(robots["a"].move(1.0), robots["a"].turn(90.0)),
        )
    assert all_at_rest(world)


def all_at_rest(world: FakeWorld) -> bool:
    """Whether no wheel is to turn."""
    return all(
        joint.target == 0.0 for robot in world.robots.values() for joint in robot.joints
    )


ACTIONS = st.one_of(
    st.tuples(st.just("move"), st.floats(-0.2, 0.3)),
    st.tuples(st.just("turn"), st.floats(-60.0, 60.0)),
    st.tuples(st.just("sleep"), st.floats(0.0, 2.0)),
    st.tuples(st.just("blocked"), st.just(0.0)),
    st.tuples(st.just("error"), st.just(0.0)),
    st.tuples(st.just("time limit"), st.floats(0.01, 2.0)),
)


class OwnError(Exception):
    """An error in a person's own code."""


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.lists(st.lists(ACTIONS, max_size=3), min_size=4, max_size=4))
def test_any_interleaving_stops_all_wheels_and_reports_the_first_failure(
    plans: list[list[tuple[str, float]]],
) -> None:
    world = four_robots()
    failures: list[BaseException] = []

    async def act(robot: Robot, plan: list[tuple[str, float]]) -> None:
        fake = world.robots[robot.name]
        for what, value in plan:
            match what:
                case "move":
                    await robot.move(value)
                case "turn":
                    await robot.turn(value)
                case "sleep":
                    await asyncio.sleep(value)
                case "blocked":
                    fake.wall = -math.inf
                    await robot.move(1.0)
                case "error":
                    raise OwnError(robot.name)
                case "time limit":
                    async with asyncio.timeout(value):
                        await robot.turn(360.0)

    async def watched(robot: Robot, plan: list[tuple[str, float]]) -> None:
        try:
            await act(robot, plan)
        except (MovementError, OwnError, TimeoutError) as error:
            failures.append(error)
            fake = world.robots[robot.name]
            assert all(joint.target == 0.0 for joint in fake.joints)
            raise

    async def main(robots: Robots) -> None:
        reported: list[BaseException] = []
        try:
            await parallel(
                *(
                    movement(name=robot.name)(watched)(robot, plan)
                    for robot, plan in zip(robots.values(), plans, strict=True)
                )
            )
        except (MovementError, OwnError, TimeoutError) as error:
            reported.append(error)
        assert reported == failures[:1], "the first failure is the one that is reported"
        assert all_at_rest(world)

    with pytest.MonkeyPatch.context() as monkeypatch:
        drive_all(world, monkeypatch, DRIVES, main)
    assert not world.running
    assert not any(world.holders.values())
