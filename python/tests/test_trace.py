"""What a trace says of a run."""

import io
import itertools
import json
from typing import Any

from pydslrep_runtime import Robot, SimulatorError, clear, detects
from pydslrep_runtime.trace import Trace
from stand_in import StandIn, drive

WALL = 0.5  # m ahead


def traced(robot: StandIn, actions: Any, *bumpers: str) -> list[dict[str, Any]]:
    """The lines of a run."""
    file = io.StringIO()
    drive(robot, actions, Trace(file), bumpers)
    return [json.loads(line) for line in file.getvalue().splitlines()]


def before_wall() -> StandIn:
    """A robot with a sensor that sees a wall."""
    robot = StandIn("two-wheel")
    robot.sensors["front"] = lambda: WALL - robot.here.x
    robot.sensors["rear"] = lambda: None
    return robot


def test_readings_are_those_since_the_line_before() -> None:
    async def actions(robot: Robot) -> None:
        await robot.move(1.0, until=detects("front", within=0.3))
        await robot.turn(5.0)

    lines = traced(before_wall(), actions)
    read = [line for line in lines if "readings" in line]
    assert len(read) > 20
    for before, line in itertools.pairwise(lines):
        for distance in line.get("readings", {}).values():
            assert abs(distance - (WALL - before["x"])) < 1e-5
    # Nobody asks its sensors while it turns.
    assert "readings" not in lines[-1]


def test_what_is_only_detected_has_its_distance_too() -> None:
    async def actions(robot: Robot) -> None:
        await robot.move(0.1, until=clear("front", "rear"))

    lines = traced(before_wall(), actions)
    readings = [line["readings"] for line in lines if "readings" in line]
    assert len(readings) > 20
    assert all(0.39 < reading["front"] < 0.51 for reading in readings)


def test_nothing_and_bumpers() -> None:
    robot = before_wall()
    robot.sensors["skirt"] = lambda: 0.004

    async def actions(robot: Robot) -> None:
        await robot.move(0.1, until=detects("rear", "skirt"))
        await robot.turn(5.0)

    lines = traced(robot, actions, "skirt")
    assert {"rear": None, "skirt": 0.0} in [line.get("readings") for line in lines]


def test_a_robot_that_measures_no_distances_can_be_traced() -> None:
    class Blunt(StandIn):
        def detects(self, sensor: str) -> bool:
            return sensor == "front"

        def distance(self, sensor: str) -> float | None:
            raise SimulatorError(f"{sensor} measures nothing")

    robot = Blunt("two-wheel")
    robot.sensors["front"] = lambda: None

    async def actions(robot: Robot) -> None:
        await robot.move(0.1, until=clear("front"))

    lines = traced(robot, actions)
    assert lines
    assert not any("readings" in line for line in lines)
