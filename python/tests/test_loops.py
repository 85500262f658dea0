"""Loops: their rounds, their limits, and rounds in which no time passes."""

import asyncio
from collections.abc import AsyncIterator, Callable, Coroutine
from typing import Any

import pytest
from driving import drive_all, drive_alone, joints
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_runtime import MovementError, Robot, clear, detects, movement, parallel
from pydslrep_runtime import motion as motion_module


def world_with(see: Callable[[FakeRobot], bool]) -> FakeWorld:
    return FakeWorld(FakeRobot("r", joints("two-wheel"), sensors={"f": see}))


def test_a_number_of_rounds(monkeypatch: pytest.MonkeyPatch) -> None:
    rounds: list[int] = []

    async def actions(robot: Robot) -> None:
        rounds.extend(robot.repeat(3))
        rounds.extend(robot.repeat(0))

    drive_alone(world_with(lambda _: False), monkeypatch, "two-wheel", actions)
    assert rounds == [1, 2, 3]


def test_rounds_until_a_condition_holds(monkeypatch: pytest.MonkeyPatch) -> None:
    world = world_with(lambda robot: robot.x > 0.25)
    rounds: list[int] = []

    async def actions(robot: Robot) -> None:
        async for number in robot.repeat_until(detects("f")):
            rounds.append(number)
            await robot.move(0.1)

    drive_alone(world, monkeypatch, "two-wheel", actions)
    assert rounds == [1, 2, 3]
    assert world.robots["r"].x == pytest.approx(0.3, abs=0.001)


def test_the_condition_is_read_before_each_round_only(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = world_with(lambda robot: 0.04 < robot.x < 0.06)

    async def actions(robot: Robot) -> None:
        async for number in robot.repeat_until(detects("f")):
            await robot.move(0.1 if number == 1 else -0.05)

    drive_alone(world, monkeypatch, "two-wheel", actions)
    assert world.robots["r"].x == pytest.approx(0.05, abs=0.001)


def test_a_loop_whose_condition_holds_has_no_round(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = world_with(lambda _: False)

    async def actions(robot: Robot) -> None:
        async for _ in robot.repeat_until(clear("f")):
            raise AssertionError

    drive_alone(world, monkeypatch, "two-wheel", actions)
    assert world.steps == 1, "the first condition of a run waits for one step"


def test_rounds_without_time_take_a_step_each(monkeypatch: pytest.MonkeyPatch) -> None:
    world = world_with(lambda _: world.steps >= 20)
    rounds: list[int] = []

    async def actions(robot: Robot) -> None:
        async for number in robot.repeat_until(detects("f")):
            rounds.append(number)  # noqa: PERF401

    drive_alone(world, monkeypatch, "two-wheel", actions)
    assert rounds == [*range(1, 20)]
    assert world.steps == 20


def test_a_loop_fails_after_its_last_round(monkeypatch: pytest.MonkeyPatch) -> None:
    world = world_with(lambda _: True)
    rounds: list[int] = []

    async def actions(robot: Robot) -> None:
        async for number in robot.repeat_until(clear("f", within=0.5)):
            rounds.append(number)  # noqa: PERF401

    world.robots["r"].sensors["f"] = lambda _: 0.3
    # It would take long.
    monkeypatch.setattr(FakeRobot, "advance", lambda robot, dt, noise: None)
    with pytest.raises(MovementError) as error:
        drive_alone(world, monkeypatch, "two-wheel", actions)
    assert str(error.value) == (
        "robot r, movement m, action 1: repeat until f detects nothing within 0.5 m: "
        "after 10000 rounds f still detects something within 0.5 m"
    )
    assert (len(rounds), error.value.rounds) == (10_000, ())


def test_a_condition_that_holds_after_the_last_round_is_enough(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = world_with(lambda _: world.steps >= 6)
    monkeypatch.setattr("pydslrep_runtime.robots.MAX_ROUNDS", 5)

    async def actions(robot: Robot) -> None:
        async for _ in robot.repeat_until(detects("f")):
            pass

    drive_alone(world, monkeypatch, "two-wheel", actions)
    assert world.steps == 6


def test_nested_loops_of_conditions_let_others_drive(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Conditions take no time; but very many of them must not hold up the other robots."""
    monkeypatch.setattr(motion_module, "MAX_IDLE_ACTIONS", 10)
    world = FakeWorld(
        FakeRobot("a", joints("two-wheel"), sensors={"f": lambda _: False}),
        FakeRobot("b", joints("two-wheel"), y=1.0),
    )
    checks: list[float] = []

    async def look(robot: Robot) -> None:
        for _ in robot.repeat(20):
            for _ in robot.repeat(20):
                checks.append(robot.time)
                assert not await robot.check(detects("f"))

    async def main(robots: dict[str, Robot]) -> None:
        await parallel(
            movement(look)(robots["a"]), movement(name="go")(robots["b"].move)(0.1)
        )

    drive_all(world, monkeypatch, ("two-wheel", "two-wheel"), main)
    assert len(checks) == 400
    assert checks[-1] == pytest.approx(400 / 11 * world.dt, abs=2 * world.dt)


@pytest.mark.parametrize(
    "act",
    [
        lambda robot: robot.wait(0.0),
        lambda robot: robot.move(0.0),
        lambda robot: robot.turn(0.0),
    ],
)
def test_loops_of_actions_that_take_no_time_let_others_drive(
    act: Callable[[Robot], Coroutine[Any, Any, None]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(motion_module, "MAX_IDLE_ACTIONS", 10)
    world = FakeWorld(
        FakeRobot("a", joints("two-wheel")), FakeRobot("b", joints("two-wheel"), y=1.0)
    )
    driven: list[float] = []

    async def idle(robot: Robot) -> None:
        for _ in robot.repeat(1000):
            await act(robot)
        driven.append(world.robots["b"].x)

    async def main(robots: dict[str, Robot]) -> None:
        await parallel(
            movement(idle)(robots["a"]), movement(name="go")(robots["b"].move)(0.1)
        )

    drive_all(world, monkeypatch, ("two-wheel", "two-wheel"), main)
    assert driven == [pytest.approx(0.1, abs=0.001)]


def test_very_many_empty_rounds_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(motion_module, "MAX_IDLE_ROUNDS", 100)

    async def actions(robot: Robot) -> None:
        for _ in robot.repeat(100):
            await robot.wait(0.05)
        for _ in robot.repeat(10):
            for _ in robot.repeat(50):
                pass

    with pytest.raises(MovementError) as error:
        drive_alone(world_with(lambda _: False), monkeypatch, "two-wheel", actions)
    assert "in round 2: repeat 50 times: no time has passed in" in str(error.value)


def test_what_a_loop_is_left_by_does_not_matter(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A loop that has been left has no rounds: neither after `break` nor after an error."""
    places: list[tuple[int, ...]] = []

    async def actions(robot: Robot) -> None:
        def note() -> None:
            places.append(robot._connected().place.rounds)

        for _ in robot.repeat(3):
            break
        try:
            for _ in robot.repeat(3):
                raise ZeroDivisionError
        except ZeroDivisionError:
            pass
        async for _ in robot.repeat_until(detects("f")):
            break
        kept: AsyncIterator[int] = robot.repeat_until(clear("f"))
        async for _ in kept:
            pass
        for _ in robot.repeat(2):
            async for _ in robot.repeat_until(detects("f")):
                await robot.wait(0.05)
                note()
                break
            await robot.wait(0.05)
            note()
        await robot.wait(0.05)
        note()

    drive_alone(world_with(lambda _: False), monkeypatch, "two-wheel", actions)
    assert places == [(1, 1), (1,), (2, 1), (2,), ()]


def test_loops_need_a_run() -> None:
    from driving import declared

    robot = declared(FakeRobot("r", joints("two-wheel")), "two-wheel")
    for begin in (
        lambda: robot.repeat(2),
        lambda: robot.repeat_until(detects("f")),
        lambda: asyncio.run(robot.check(detects("f"))),
    ):
        with pytest.raises(RuntimeError, match="acts within"):
            begin()
